use rayon::prelude::*;

use super::node::{LEAF, Part, WIDTH};
use super::slab::padded;
use super::tree::{BLOCK, Bvh};
use crate::math::Aabb;

impl Bvh {
    /// Fits all boxes to primitives that have moved; which primitives lie below which node stays.
    ///
    /// `blocks` is what the caller keeps for the blocks, as [`Self::map_blocks`] made it. `renew`
    /// makes a block of the moved primitives and returns their boxes, [`Aabb::EMPTY`] of those that
    /// nothing can hit. Returns the expected cost of a ray, as in [`Self::expected_visits`] nodes and
    /// blocks together: when it has grown much, a new tree pays.
    ///
    /// # Panics
    /// If there are fewer blocks than in the tree.
    pub fn refit<B: Send>(
        &mut self,
        blocks: &mut [B],
        renew: &(impl Fn(&mut B) -> [Aabb; BLOCK] + Sync),
    ) -> f64 {
        assert_eq!(blocks.len(), self.block_count());
        let boxes: Vec<_> = blocks.par_iter_mut().map(renew).collect();
        let boxes = boxes.as_flattened();
        self.nodes_mut().par_iter_mut().for_each(|node| {
            for slot in 0..WIDTH {
                let reference = node.children[slot];
                if reference & LEAF == 0 {
                    continue;
                }
                let boxes = boxes[node.places(slot as Part)].iter();
                let bounds = boxes.fold(Aabb::EMPTY, |all, b| all.union(*b));
                let is_hit = !bounds.is_empty();
                node.set_bounds(slot, if is_hit { padded(bounds) } else { bounds });
            }
        });
        // Children come after their parents.
        let mut bounds = vec![Aabb::EMPTY; self.nodes().len()];
        for (index, node) in self.nodes_mut().iter_mut().enumerate().rev() {
            let mut all = Aabb::EMPTY;
            for slot in 0..WIDTH {
                let reference = node.children[slot];
                if reference == 0 {
                    continue;
                }
                if reference & LEAF == 0 {
                    node.set_bounds(slot, bounds[reference as usize]);
                }
                all = all.union(node.bounds(slot as Part));
            }
            bounds[index] = all;
        }
        let (nodes, blocks) = self.expected_visits();
        nodes + blocks
    }
}
