use std::hint::black_box;

use super::leaves::Leaves;
use super::node::{LEAF, WideNode};
use super::simd::prefetch;
use super::tree::Bvh;

/// Where nodes and leaves lie in memory.
#[derive(Clone, Copy, Debug)]
pub(super) struct Memory {
    /// Of nodes and of blocks; the latter moved such that the whole reference of a leaf is its index.
    starts: [*const u8; 2],
    sizes: [usize; 2],
}

impl Memory {
    pub(super) fn new<L: Leaves>(bvh: &Bvh, leaves: &L) -> Self {
        let sizes = [size_of::<WideNode>(), size_of::<L::Block>()];
        let blocks: *const u8 = leaves.blocks().as_ptr().cast();
        // Looked up in a table; the compiler would choose between what it knows, which takes longer.
        black_box(Self {
            starts: [
                bvh.nodes().as_ptr().cast(),
                blocks.wrapping_sub(LEAF as usize * sizes[1]),
            ],
            sizes,
        })
    }

    /// Asks for the node or leaf `at`, which will be visited soon. No branch: what comes next is hard
    /// to predict.
    #[inline(always)]
    pub(super) fn fetch(&self, at: u32) {
        let is_leaf = (at >> LEAF.trailing_zeros()) as usize;
        let start = self.starts[is_leaf];
        prefetch(start.wrapping_add(at as usize * self.sizes[is_leaf]), 4);
    }
}
