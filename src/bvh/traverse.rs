use std::ops::Range;

use super::build::MAX_DEPTH;
use super::slab::SlabRay;
use super::tree::Bvh;
use super::wide::WIDTH;

/// What a caller does with the leaves that a ray reaches.
pub trait Leaf {
    /// Tests the primitives in `slots` of [`Bvh::order`].
    ///
    /// Returns the ray parameter beyond which nothing matters any more: the closest hit so far, or
    /// negative infinity to stop at once.
    fn visit(&mut self, slots: Range<usize>) -> f32;
}

/// Nodes still to visit; made once for many rays.
#[derive(Debug)]
pub struct Stack([Entry; STACK]);

/// A wide node leaves at most all but one of its children behind when the ray goes deeper, and the
/// wide tree is no deeper than the binary one.
const STACK: usize = (WIDTH - 1) * MAX_DEPTH + WIDTH;

impl Stack {
    /// An empty stack.
    pub fn new() -> Self {
        Self([Entry::default(); STACK])
    }

    /// Puts `entry` among the entries `begin..end`, which are sorted, nearest last.
    #[inline(always)]
    fn insert(&mut self, begin: usize, end: usize, entry: Entry) {
        let mut i = end;
        while i > begin && self.0[i - 1].near < entry.near {
            self.0[i] = self.0[i - 1];
            i -= 1;
        }
        self.0[i] = entry;
    }
}

impl Default for Stack {
    fn default() -> Self {
        Self::new()
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Entry {
    near: f32,
    first: u32,
    count: u32,
}

/// Work done for one ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Boxes tested; a node counts as four, whether or not it is full.
    pub boxes: u32,
    /// Primitives tested.
    pub primitives: u32,
}

impl Bvh {
    /// Leads `ray` through the tree, near boxes first, and shows `leaf` every leaf that it meets.
    #[inline]
    pub fn traverse(&self, ray: &SlabRay, stack: &mut Stack, leaf: &mut impl Leaf) -> Work {
        let mut work = Work::default();
        let mut limit = ray.t_max();
        let mut open = 0;
        let mut at = Entry::default();
        loop {
            if at.count == 0 {
                let node = &self.wide()[at.first as usize];
                work.boxes += WIDTH as u32;
                let (near, mut meets) = ray.enter_four(node, limit);
                let near = near.to_array();
                let begin = open;
                while meets != 0 {
                    let lane = meets.trailing_zeros() as usize % WIDTH;
                    meets &= meets - 1;
                    let entry = Entry {
                        near: near[lane],
                        first: node.first[lane],
                        count: node.count[lane],
                    };
                    stack.insert(begin, open, entry);
                    open += 1;
                }
            } else {
                work.primitives += at.count;
                let first = at.first as usize;
                limit = leaf.visit(first..first + at.count as usize);
            }
            loop {
                if open == 0 {
                    return work;
                }
                open -= 1;
                at = stack.0[open];
                // Equality stays in: a hit at the same parameter may have the smaller id.
                if at.near <= limit {
                    break;
                }
            }
        }
    }
}
