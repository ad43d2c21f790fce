use super::super::flight::Lane;
use super::super::leaves::{Leaves, Work};
use super::super::memory::Memory;
use super::super::node::LEAF;
use super::super::simd::NodeTest;
use super::super::stack::{BOTTOM, DONE, Stack};
use super::super::tree::Bvh;
use crate::math::{Ray, take_lowest};

/// Rays that go by themselves at the same time.
pub(super) const POOL: usize = 64;

/// Rays that have left their packets, a step each in turn.
pub(super) struct Pool<Q, const STACK: usize> {
    lanes: Vec<Lane<Q>>,
    stacks: Vec<Stack<STACK>>,
    /// Lanes that wait for a node, for a leaf, and for a ray: a bit each.
    nodes: u64,
    leaves: u64,
    free: u64,
}

impl<Q: Copy, const STACK: usize> Pool<Q, STACK> {
    /// Nobody.
    pub(super) fn new() -> Self {
        Self {
            lanes: Vec::with_capacity(POOL),
            stacks: vec![Stack::EMPTY; POOL],
            nodes: 0,
            leaves: 0,
            free: u64::MAX,
        }
    }

    /// Lanes without a ray.
    #[inline(always)]
    pub(super) fn free(&self) -> u32 {
        self.free.count_ones()
    }

    /// Lanes with a ray, a bit each.
    #[inline(always)]
    pub(super) fn taken(&self) -> u64 {
        !self.free
    }

    /// Takes in a ray if there is a free lane; returns its number. `stack` puts what it has still to
    /// visit after `lane.at` on the stack with the given top, and returns the new one.
    #[inline(always)]
    pub(super) fn add(
        &mut self,
        mut lane: Lane<Q>,
        stack: impl FnOnce(&mut Stack<STACK>, usize) -> usize,
    ) -> usize {
        let number = take_lowest(&mut self.free);
        lane.top = stack(&mut self.stacks[number], BOTTOM) as u32;
        if lane.at & LEAF == 0 {
            self.nodes |= 1 << number;
        } else {
            self.leaves |= 1 << number;
        }
        if number == self.lanes.len() {
            self.lanes.push(lane);
        } else {
            self.lanes[number] = lane;
        }
        number
    }

    /// Gives the lane back; returns what was in it.
    #[inline(always)]
    pub(super) fn remove(&mut self, number: usize) -> &Lane<Q> {
        self.free |= 1 << number;
        &self.lanes[number]
    }

    /// Leads the rays in the lanes of `set` on until at most `keep` of them have something left to
    /// visit; returns the others.
    #[inline(always)]
    pub(super) fn run<N: NodeTest, L: Leaves<Query = Q>>(
        &mut self,
        (set, keep): (u64, u32),
        (bvh, leaves, memory): (&Bvh, &L, &Memory),
        rays: &[Ray],
        work: &mut Work,
    ) -> u64 {
        loop {
            let open = set & (self.nodes | self.leaves);
            if open.count_ones() <= keep {
                return set & !open;
            }
            let mut now = set & self.nodes;
            self.nodes &= !set;
            work.nodes += u64::from(now.count_ones());
            while now != 0 {
                let number = take_lowest(&mut now);
                let (lane, stack) = (&mut self.lanes[number], &mut self.stacks[number]);
                lane.step_at_node::<N, false, STACK>(stack, bvh.nodes());
                let at = lane.at;
                self.arrive(number, at, memory);
            }
            let mut now = set & self.leaves;
            self.leaves &= !set;
            while now != 0 {
                let number = take_lowest(&mut now);
                let (lane, stack) = (&mut self.lanes[number], &mut self.stacks[number]);
                lane.step_at_leaf::<N, false, STACK>(stack, (leaves, rays), &mut work.blocks);
                let at = lane.at;
                self.arrive(number, at, memory);
            }
        }
    }

    /// Notes that lane `number` comes to `at`, and asks for the memory of that step.
    #[inline(always)]
    fn arrive(&mut self, number: usize, at: u32, memory: &Memory) {
        let is_leaf = at & LEAF != 0;
        self.nodes |= u64::from(!is_leaf) << number;
        self.leaves |= u64::from(is_leaf & (at != DONE)) << number;
        memory.fetch(at);
    }
}
