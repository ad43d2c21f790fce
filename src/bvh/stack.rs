use super::node::WIDTH;
use super::octant::FAR_TO_NEAR;
use super::simd::NodeTest;

/// Reference at the bottom of a stack: nothing is left. No leaf begins there.
pub(super) const DONE: u32 = u32::MAX;

/// Size of the stacks for trees of usual depth.
pub(super) const SHALLOW: usize = 128 + WIDTH;

/// Size of the stacks for the deepest trees that the build makes.
pub(super) const DEEP: usize = 1024 + WIDTH;

/// What a ray has still to visit, and from which ray parameter on; the nearest last.
///
/// `SIZE` is [`WIDTH`] more than a power of two, so that positions are kept in bounds by a mask
/// instead of a comparison.
#[derive(Clone, Debug)]
pub(super) struct Stack<const SIZE: usize> {
    references: [u32; SIZE],
    near: [f32; SIZE],
}

/// The top of an empty stack.
pub(super) const BOTTOM: usize = 1;

/// True if the rays of a tree of `wide_depth` nodes one below the other find room on stacks of
/// `size`: one node leaves all but one of its children behind when the ray goes deeper; below them
/// lies [`DONE`], and above them eight are written at once.
pub(super) const fn is_enough(size: usize, wide_depth: usize) -> bool {
    (WIDTH - 1) * wide_depth + BOTTOM + WIDTH <= size
}

impl<const SIZE: usize> Stack<SIZE> {
    const MASK: usize = {
        assert!((SIZE - WIDTH).is_power_of_two());
        SIZE - WIDTH - 1
    };

    /// An empty stack.
    pub(super) const EMPTY: Self = Self {
        references: [DONE; SIZE],
        near: [f32::NEG_INFINITY; SIZE],
    };

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
        if !ANY {
            let at = top & Self::MASK;
            N::arrange_near(order(octant, meets), near, eight(&mut self.near, at));
        }
        self.push_all::<N>(top, octant, meets, children)
    }

    /// The same without the parameters.
    #[inline(always)]
    pub(super) fn push_all<N: NodeTest>(
        &mut self,
        top: usize,
        octant: usize,
        meets: u32,
        children: &[u32; WIDTH],
    ) -> usize {
        let at = top & Self::MASK;
        N::arrange(
            order(octant, meets),
            children,
            eight(&mut self.references, at),
        );
        top + meets.count_ones() as usize
    }

    /// Puts one entry on the stack with this `top` if it begins at or before `limit`; returns the new
    /// top.
    #[inline(always)]
    pub(super) fn put(&mut self, top: usize, (reference, near): (u32, f32), limit: f32) -> usize {
        self.references[top & Self::MASK] = reference;
        self.near[top & Self::MASK] = near;
        top + usize::from(near <= limit)
    }

    /// Drops the entries that begin beyond `limit` from the stack with this `top`; returns the new top.
    ///
    /// To be done where the limit moves: there it is one loop after a branch that is hard to predict
    /// anyway, and [`Self::pop`] needs no branch.
    #[inline(always)]
    pub(super) fn cull<N: NodeTest>(&mut self, top: usize, limit: f32) -> usize {
        if top == BOTTOM {
            return top;
        }
        let (mut from, mut to) = (0, 0);
        while from < top {
            let at = from & Self::MASK;
            // Equality stays in: a hit at the same parameter may have the smaller id.
            let (near, kept) = N::at_most(eight(&mut self.near, at), limit);
            let kept = kept & (u32::MAX >> 24 >> (WIDTH - (top - from).min(WIDTH)));
            let references = *eight(&mut self.references, at);
            let order = FAR_TO_NEAR[7][kept as usize % (1 << WIDTH)];
            let place = to & Self::MASK;
            N::arrange_near(order, near, eight(&mut self.near, place));
            N::arrange(order, &references, eight(&mut self.references, place));
            from += WIDTH;
            to += kept.count_ones() as usize;
        }
        to
    }

    /// Takes the nearest entry off the stack with this `top`; returns it and the new top. At the bottom
    /// there is [`DONE`].
    #[inline(always)]
    pub(super) fn pop(&self, top: usize) -> (u32, usize) {
        (self.references[(top - 1) & Self::MASK], top - 1)
    }
}

#[inline(always)]
fn order(octant: usize, meets: u32) -> u64 {
    FAR_TO_NEAR[octant % 8][meets as usize % (1 << WIDTH)]
}

#[inline(always)]
fn eight<T>(values: &mut [T], at: usize) -> &mut [T; WIDTH] {
    (&mut values[at..at + WIDTH])
        .try_into()
        .expect("eight of them")
}

#[cfg(test)]
mod tests {
    use super::super::simd::{Kernel, dispatch};
    use super::*;
    use crate::math::Isa;

    type Shallow = Stack<SHALLOW>;

    /// Puts `entries` on a stack, drops those beyond `limit`, and takes off what is left.
    struct Cull<'a> {
        entries: &'a [(u32, f32)],
        limit: f32,
    }

    impl Kernel for Cull<'_> {
        type Answer = Vec<u32>;

        fn run<N: NodeTest>(self) -> Vec<u32> {
            let mut stack = Shallow::EMPTY;
            let put = |top, &entry: &(u32, f32)| stack.put(top, entry, f32::INFINITY);
            let top = self.entries.iter().fold(BOTTOM, put);
            let top = stack.cull::<N>(top, self.limit);
            let mut next = stack.pop(top);
            let mut left = Vec::new();
            while next.0 != DONE {
                left.push(next.0);
                next = stack.pop(next.1);
            }
            assert_eq!(next.1, 0, "the bottom is at 0");
            left
        }
    }

    #[test]
    fn a_cull_leaves_what_begins_at_or_before_the_limit_in_its_order() {
        for isa in Isa::available() {
            for count in 0..100 {
                let near = |i: u32| (i * 37 % 11) as f32;
                let entries: Vec<_> = (0..count).map(|i| (i, near(i))).collect();
                for limit in [-1.0, 0.0, 4.0, 4.5, 10.0] {
                    let kept = entries.iter().rev().filter(|(_, near)| *near <= limit);
                    let kept: Vec<_> = kept.map(|&(reference, _)| reference).collect();
                    let entries = &entries[..];
                    assert_eq!(
                        dispatch(isa, Cull { entries, limit }),
                        kept,
                        "{isa} {count}"
                    );
                }
            }
        }
    }
}
