use glam::Vec4;

use super::primitive::{Bounds, NORMAL, PrimitiveRef};
use super::range::{Depth, Plan, Range, Rule};
use super::watch::Watch;

/// Ranges up to this size are built by one thread.
pub(super) const SERIAL: usize = 4096;

/// In the place of a leaf's right child.
const NONE: u32 = u32::MAX;

/// A node of a binary tree whose leaves hold one primitive each; links stand in the fourth lanes.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct BinaryNode {
    min: Vec4,
    max: Vec4,
}

impl BinaryNode {
    pub(super) const EMPTY: Self = Self {
        min: Vec4::INFINITY,
        max: Vec4::NEG_INFINITY,
    };

    pub(super) fn leaf(primitive: &PrimitiveRef) -> Self {
        let Bounds { min, max } = primitive.bounds();
        Self::new(min, max, [primitive.id(), NONE])
    }

    pub(super) fn inner(bounds: &Bounds, children: [u32; 2]) -> Self {
        Self::new(bounds.min, bounds.max, children)
    }

    fn new(min: Vec4, max: Vec4, links: [u32; 2]) -> Self {
        let [left, right] = links.map(|link| f32::from_bits(link ^ NORMAL));
        Self {
            min: min.truncate().extend(left),
            max: max.truncate().extend(right),
        }
    }

    fn links(&self) -> [u32; 2] {
        [self.min.w, self.max.w].map(|link| link.to_bits() ^ NORMAL)
    }

    /// Indices of left and right, `None` of a leaf.
    #[inline(always)]
    pub(super) fn children(&self) -> Option<[u32; 2]> {
        let links = self.links();
        (links[1] != NONE).then_some(links)
    }

    /// The primitive of a leaf.
    pub(super) fn primitive(&self) -> u32 {
        self.links()[0]
    }

    #[inline(always)]
    pub(super) fn bounds(&self) -> Bounds {
        Bounds {
            min: self.min,
            max: self.max,
        }
    }
}

/// Builds the tree over `range` into `nodes`, which holds it exactly, and whose first element is
/// number `first` of all nodes: depth first, the left child behind its parent. Advances `watch` by
/// the primitives if there are more than [`SERIAL`]; `None` when it says so.
pub(super) fn build(
    mut range: Range<'_>,
    nodes: &mut [BinaryNode],
    first: u32,
    (rule, depth): (&Rule<'_>, usize),
    watch: &Watch<'_>,
) -> Option<()> {
    let count = range.len();
    let (node, below) = nodes.split_first_mut().expect("a range is not empty");
    if count == 1 {
        *node = BinaryNode::leaf(&range.refs[0]);
        return Some(());
    }
    let bounds = range.extents.bounds;
    let at = Depth {
        binary: depth,
        wide: 0,
    };
    let right = match rule.plan(&range, at) {
        Plan::Sides(split) => range.part(&split),
        Plan::Leaf | Plan::Halves => range.halve(),
    };
    let left_nodes = 2 * range.len() - 1;
    let second = first + 1 + left_nodes as u32;
    *node = BinaryNode::inner(&bounds, [first + 1, second]);
    let (left_nodes, right_nodes) = below.split_at_mut(left_nodes);
    let with = (rule, depth + 1);
    if count <= SERIAL {
        build(range, left_nodes, first + 1, with, watch)?;
        return build(right, right_nodes, second, with, watch);
    }
    let small = [range.len(), right.len()].map(|n| if n <= SERIAL { n } else { 0 });
    let (left, right) = rayon::join(
        || build(range, left_nodes, first + 1, with, watch),
        || build(right, right_nodes, second, with, watch),
    );
    watch.advance(small[0] + small[1])?;
    left.and(right)
}
