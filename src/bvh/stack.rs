use super::node::WIDTH;
use super::octant::FAR_TO_NEAR;
use super::simd::NodeTest;
use super::tree::Bvh;

/// Reference at the bottom of a stack: nothing is left. No leaf begins there.
pub(super) const DONE: u32 = u32::MAX;

/// Places that a stack needs for `bvh`: one node leaves all but one of its children behind when the
/// ray goes deeper; below them lies [`DONE`], above them eight are written at once.
pub(super) fn stack_size(bvh: &Bvh) -> usize {
    (WIDTH - 1) * bvh.wide_depth() + 1 + WIDTH
}

/// What one ray has still to visit, and from which ray parameter on; the nearest last.
#[derive(Debug)]
pub(super) struct Stack<'a> {
    references: &'a mut [u32],
    near: &'a mut [f32],
}

impl<'a> Stack<'a> {
    /// A stack in memory of [`stack_size`] places each.
    #[inline(always)]
    pub(super) fn new(references: &'a mut [u32], near: &'a mut [f32]) -> Self {
        Self { references, near }
    }

    /// Empties the stack; returns its height.
    #[inline(always)]
    pub(super) fn clear(&mut self) -> usize {
        self.references[0] = DONE;
        self.near[0] = f32::NEG_INFINITY;
        1
    }

    /// Puts the children of a node in the slots `meets` on a stack of height `open`; returns its
    /// new height. `ANY`: without the parameters, which only matter when a limit moves.
    #[inline(always)]
    pub(super) fn push<N: NodeTest, const ANY: bool>(
        &mut self,
        open: usize,
        octant: usize,
        (near, meets): (N::PerSlot, u32),
        children: &[u32; WIDTH],
    ) -> usize {
        let order = FAR_TO_NEAR[octant % 8][meets as usize % (1 << WIDTH)];
        let room = &mut self.references[open..];
        N::arrange(order, children, room.first_chunk_mut().expect("stack_size"));
        if !ANY {
            let room = &mut self.near[open..];
            N::arrange_near(order, near, room.first_chunk_mut().expect("stack_size"));
        }
        open + meets.count_ones() as usize
    }

    /// Takes the nearest entry that begins at or before `limit` off a stack of height `open`;
    /// returns it and the new height. At the bottom there is [`DONE`].
    #[inline(always)]
    pub(super) fn pop<const ANY: bool>(&self, open: usize, limit: f32) -> (u32, usize) {
        let mut open = open - 1;
        // Equality stays in: a hit at the same parameter may have the smaller id.
        while !ANY && self.near[open] > limit {
            open -= 1;
        }
        (self.references[open], open)
    }
}
