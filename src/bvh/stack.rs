use super::node::WIDTH;
use super::octant::FAR_TO_NEAR;
use super::simd::NodeTest;
use super::tree::Bvh;

/// Reference at the bottom of a stack: nothing is left. No leaf begins there.
pub(super) const DONE: u32 = u32::MAX;

/// What rays have still to visit, and from which ray parameter on: stacks of equal size one after
/// the other, the nearest entry of each last.
#[derive(Debug)]
pub(super) struct Stacks {
    references: Vec<u32>,
    near: Vec<f32>,
    size: usize,
}

impl Stacks {
    /// `count` empty stacks for the rays of `bvh`.
    pub(super) fn new(bvh: &Bvh, count: usize) -> Self {
        // One node leaves all but one of its children behind when the ray goes deeper; below them
        // lies DONE, above them eight are written at once.
        let size = (WIDTH - 1) * bvh.wide_depth() + 1 + WIDTH;
        let mut stacks = Self {
            references: vec![0; size * count],
            near: vec![0.0; size * count],
            size,
        };
        for i in 0..count {
            stacks.references[i * size] = DONE;
            stacks.near[i * size] = f32::NEG_INFINITY;
        }
        stacks
    }

    /// The top of stack `number` when it is empty.
    #[inline(always)]
    pub(super) fn bottom(&self, number: usize) -> usize {
        number * self.size + 1
    }

    /// Puts the children of a node in the slots `meets` on the stack with this `top`; returns its
    /// new top. `ANY`: without the parameters, which only matter when a limit moves.
    #[inline(always)]
    pub(super) fn push<N: NodeTest, const ANY: bool>(
        &mut self,
        top: usize,
        octant: usize,
        (near, meets): (N::PerSlot, u32),
        children: &[u32; WIDTH],
    ) -> usize {
        let order = FAR_TO_NEAR[octant % 8][meets as usize % (1 << WIDTH)];
        N::arrange(order, children, eight(&mut self.references, top));
        if !ANY {
            N::arrange_near(order, near, eight(&mut self.near, top));
        }
        top + meets.count_ones() as usize
    }

    /// Puts one entry on the stack with this `top` if it begins at or before `limit`; returns the new
    /// top.
    #[inline(always)]
    pub(super) fn put(&mut self, top: usize, (reference, near): (u32, f32), limit: f32) -> usize {
        self.references[top] = reference;
        self.near[top] = near;
        top + usize::from(near <= limit)
    }

    /// Takes the nearest entry that begins at or before `limit` off the stack with this `top`;
    /// returns it and the new top. At the bottom there is [`DONE`].
    #[inline(always)]
    pub(super) fn pop<const ANY: bool>(&self, top: usize, limit: f32) -> (u32, usize) {
        let mut top = top - 1;
        // Equality stays in: a hit at the same parameter may have the smaller id.
        while !ANY && self.near[top] > limit {
            top -= 1;
        }
        (self.references[top], top)
    }
}

#[inline(always)]
fn eight<T>(values: &mut [T], at: usize) -> &mut [T; WIDTH] {
    (&mut values[at..at + WIDTH])
        .try_into()
        .expect("eight of them")
}
