use rayon::prelude::*;

use super::node::{LEAF, Part, WIDTH, WideNode};
use super::tree::{BLOCK, Bvh, LeafBlocks};

impl Bvh {
    /// Makes of each block what the caller keeps in its place, on all threads of the current pool.
    /// `make` takes the block's primitives, and whether its leaf goes on in the next block.
    pub fn map_blocks<B: Send>(
        &self,
        ids: &LeafBlocks,
        make: impl Fn(&[u32; BLOCK], bool) -> B + Sync,
    ) -> Vec<B> {
        let long: Vec<_> = self.nodes().par_iter().flat_map_iter(long_leaves).collect();
        if long.is_empty() {
            return ids.par_iter().map(|ids| make(ids, false)).collect();
        }
        let mut more = vec![false; ids.len()];
        for (first, count) in long {
            more[first..first + count.div_ceil(BLOCK) - 1].fill(true);
        }
        let blocks = ids.par_iter().zip(more);
        blocks.map(|(ids, more)| make(ids, more)).collect()
    }
}

/// First block and number of primitives of the leaves below a node that are longer than a block.
fn long_leaves(node: &WideNode) -> impl Iterator<Item = (usize, usize)> + '_ {
    (0..WIDTH).filter_map(|slot| {
        let reference = node.children[slot];
        let count = node.leaf_primitives(slot as Part);
        let is_long = reference & LEAF != 0 && count > BLOCK;
        is_long.then_some(((reference & !LEAF) as usize, count))
    })
}
