use super::binary::BinaryNode;
use super::bins::blocks;
use super::primitive::Bounds;
use super::watch::Watch;
use crate::bvh::node::WIDTH;
use crate::bvh::tree::BLOCK;

/// Subtrees with more primitives are worked on in parallel.
pub(super) const SERIAL: usize = 8192;

/// Nodes put in order between two looks at the watch.
const LOOK: usize = 1 << 18;

/// Cost of a wide node, in units of testing a block.
const NODE_COST: f32 = 1.5;

/// What a block without primitives would cost more than a full one. More (0.7 and 1) saves memory and
/// is slower.
const EMPTY_COST: f32 = 0.3;

/// What the area of a flat leaf counts: of the rays of a scene that cross a wall, floor or face, half
/// start on it, and those do not come to its box ([`crate::bvh::padded`]).
const FLAT_AREA: f32 = 0.5;

/// Cost of testing a leaf, in units of testing a full block: rays do not feel empty places, but the
/// memory that they pass through does.
fn leaf_cost(primitives: u32) -> f32 {
    let blocks = blocks(primitives, BLOCK.ilog2());
    let empty = blocks - primitives as f32 / BLOCK as f32;
    blocks + EMPTY_COST * empty
}

/// Half the area that is counted for a leaf of these bounds.
fn leaf_area(bounds: &Bounds) -> f32 {
    let area = bounds.half_area();
    if bounds.is_flat() {
        FLAT_AREA * area
    } else {
        area
    }
}

/// A binary tree depth first: the left child stands behind its parent, the right one behind all
/// that is below the left.
#[derive(Debug)]
pub(super) struct DepthFirst {
    pub(super) nodes: Vec<BinaryNode>,
    /// Primitives below each node.
    pub(super) counts: Vec<u32>,
    /// Nodes above the deepest leaf.
    pub(super) depth: usize,
}

impl DepthFirst {
    /// Takes a tree with its root first and the others anywhere. `None` when `watch` says so.
    pub(super) fn new(tree: &[BinaryNode], watch: &Watch<'_>) -> Option<Self> {
        let mut nodes = Vec::with_capacity(tree.len());
        let mut depth = 0;
        let mut open = vec![(0, 0)];
        while let Some((index, above)) = open.pop() {
            let node = tree[index as usize];
            nodes.push(node);
            if nodes.len() % LOOK == 0 {
                watch.advance(0)?;
            }
            depth = depth.max(above);
            if let Some([left, right]) = node.children() {
                open.extend([(right, above + 1), (left, above + 1)]);
            }
        }
        // Backwards, children come before their parents.
        let mut counts = vec![1; nodes.len()];
        for i in (0..nodes.len()).rev() {
            if nodes[i].children().is_some() {
                let left = counts[i + 1];
                counts[i] = left + counts[i + 2 * left as usize];
            }
        }
        Some(Self {
            nodes,
            counts,
            depth,
        })
    }
}

/// What becomes of a node, for each number of places that it is given in a wide node above.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Choice {
    /// Places that the left child gets of i + 2 places; 0: the node takes one place less.
    left: [u8; WIDTH - 1],
    /// Alone in its place: a leaf, not a wide node.
    pub(super) is_leaf: bool,
}

impl Choice {
    /// How many the left child gets of how many of `places`; `None` if the node takes one for
    /// itself.
    pub(super) fn left(&self, mut places: usize) -> Option<(usize, usize)> {
        places = places.min(WIDTH - 1);
        while places > 1 {
            match self.left[places - 2] {
                0 => places -= 1,
                left => return Some((left.into(), places)),
            }
        }
        None
    }

    /// How many of the eight places of its own wide node the left child gets.
    pub(super) fn left_of_all(&self) -> usize {
        self.left[WIDTH - 2].into()
    }
}

/// Costs of a subtree that is given 1, 2, … 7 places in a wide node above.
type Costs = [f32; WIDTH - 1];

/// Chooses for each node what makes the expected cost of the tree least.
///
/// Ylitie, Karras, Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
/// BVHs", section 3.1.
pub(super) struct Chooser<'a> {
    /// Most primitives in a leaf.
    pub(super) leaf_size: u32,
    /// When this says so, the choices mean nothing.
    pub(super) watch: &'a Watch<'a>,
}

impl Chooser<'_> {
    /// Fills `choices` for the subtree in `nodes`, with `counts` primitives below each.
    pub(super) fn choose(
        &self,
        nodes: &[BinaryNode],
        counts: &[u32],
        choices: &mut [Choice],
    ) -> Costs {
        let (count, bounds) = (counts[0], nodes[0].bounds());
        let area = bounds.half_area();
        let as_leaf = if count <= self.leaf_size {
            leaf_area(&bounds) * leaf_cost(count)
        } else {
            f32::INFINITY
        };
        let (choice, below) = choices.split_first_mut().expect("a subtree is not empty");
        if count == 1 {
            choice.is_leaf = true;
            return [as_leaf; WIDTH - 1];
        }
        let left_nodes = 2 * counts[1] as usize - 1;
        let (left_nodes, right_nodes) = nodes[1..].split_at(left_nodes);
        let (left_counts, right_counts) = counts[1..].split_at(left_nodes.len());
        let (left_choices, right_choices) = below.split_at_mut(left_nodes.len());
        let mut left = || self.choose(left_nodes, left_counts, left_choices);
        let mut right = || self.choose(right_nodes, right_counts, right_choices);
        let (left, right) = if count as usize <= SERIAL {
            (left(), right())
        } else if self.watch.advance(0).is_some() {
            rayon::join(left, right)
        } else {
            return [0.0; WIDTH - 1];
        };
        let (all, to_left) = cheapest(&left, &right, WIDTH);
        choice.left[WIDTH - 2] = to_left;
        let as_node = all + area * NODE_COST;
        choice.is_leaf = as_leaf <= as_node;
        let mut costs = [as_leaf.min(as_node); WIDTH - 1];
        for places in 2..WIDTH {
            let (cost, to_left) = cheapest(&left, &right, places);
            costs[places - 1] = costs[places - 2];
            if cost < costs[places - 2] {
                costs[places - 1] = cost;
                choice.left[places - 2] = to_left;
            }
        }
        costs
    }
}

/// The least cost of two subtrees in `places`, and how many the left one gets.
fn cheapest(left: &Costs, right: &Costs, places: usize) -> (f32, u8) {
    let mut best = (f32::INFINITY, 1);
    for to_left in 1..places {
        let cost = left[to_left - 1] + right[places - to_left - 1];
        if cost < best.0 {
            best = (cost, to_left as u8);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use glam::Vec3;

    use super::super::primitive::PrimitiveRef;
    use super::*;
    use crate::math::Aabb;

    /// A balanced tree of 2^`levels` unit boxes at distance 10 in a row, depth first.
    fn row(levels: u32, first: u32, nodes: &mut Vec<BinaryNode>) {
        let bounds = |from: u32, to: u32| {
            let at = |i: u32| Vec3::X * (10 * i) as f32;
            Aabb::from_points([at(from), at(to) + Vec3::ONE])
        };
        let index = nodes.len() as u32;
        let last = first + (1 << levels) - 1;
        let all = PrimitiveRef::new(first, &bounds(first, last));
        nodes.push(BinaryNode::leaf(&all));
        if levels > 0 {
            row(levels - 1, first, nodes);
            let right = nodes.len() as u32;
            row(levels - 1, first + (1 << (levels - 1)), nodes);
            nodes[index as usize] = BinaryNode::inner(&all.bounds(), [index + 1, right]);
        }
    }

    #[test]
    fn eight_boxes_far_apart_get_a_place_each_and_close_ones_share_a_leaf() {
        let mut nodes = Vec::new();
        row(3, 0, &mut nodes);
        let go = |_| ControlFlow::Continue(());
        let watch = Watch::new(1, &go);
        let tree = DepthFirst::new(&nodes, &watch).expect("not stopped");
        assert_eq!((tree.depth, tree.counts[0], tree.counts[1]), (3, 8, 4));
        let mut choices = vec![Choice::default(); nodes.len()];
        let leaf_size = 4;
        let chooser = Chooser {
            leaf_size,
            watch: &watch,
        };
        let costs = chooser.choose(&tree.nodes, &tree.counts, &mut choices);
        // Half areas: 143 for the row, 3 for each box.
        let expected = 143.0 * NODE_COST + 8.0 * 3.0 * leaf_cost(1);
        assert!((costs[0] - expected).abs() < 1e-3);
        assert_eq!(choices[0].left_of_all(), 4);
        assert_eq!(choices[1].left(4), Some((2, 4)));
        assert!(choices[1].is_leaf, "four primitives alone make one block");
        assert_eq!(choices[1].left(1), None);
    }
}
