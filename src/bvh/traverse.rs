use std::ops::Range;

use super::build::MAX_DEPTH;
use super::slab::SlabRay;
use super::tree::Bvh;

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
pub struct Stack([Entry; MAX_DEPTH]);

impl Stack {
    /// An empty stack.
    pub fn new() -> Self {
        Self([Entry::default(); MAX_DEPTH])
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
    /// Boxes tested.
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
        let mut depth = 0;
        // The pair above the root: the root and nothing.
        let mut node = Entry::default();
        loop {
            if node.count == 0 {
                let pair = &self.pairs()[node.first as usize];
                work.boxes += 2;
                let (near, meets) = ray.enter_pair(pair, limit);
                let entry = |side: usize| Entry {
                    near: near[side],
                    first: pair.first[side],
                    count: pair.count[side],
                };
                match meets {
                    [true, true] => {
                        let right_first = near[1] < near[0];
                        // An inner node at depth d has pushed at most d entries before it.
                        stack.0[depth] = entry(usize::from(!right_first));
                        depth += 1;
                        node = entry(usize::from(right_first));
                        continue;
                    }
                    [true, false] => {
                        node = entry(0);
                        continue;
                    }
                    [false, true] => {
                        node = entry(1);
                        continue;
                    }
                    [false, false] => {}
                }
            } else {
                work.primitives += node.count;
                let first = node.first as usize;
                limit = leaf.visit(first..first + node.count as usize);
            }
            loop {
                if depth == 0 {
                    return work;
                }
                depth -= 1;
                node = stack.0[depth];
                // Equality stays in: a hit at the same parameter may have the smaller id.
                if node.near <= limit {
                    break;
                }
            }
        }
    }
}
