use super::leaves::Leaves;
use super::memory::Memory;
use super::node::{LEAF, WideNode};
use super::simd::NodeTest;
use super::slab::SlabRay;
use super::stack::{BOTTOM, DONE, Stack};
use crate::math::{Ray, take_lowest};

/// Rays in flight. Of 8, 16, 32 and 64 the fastest.
const LANES: usize = 32;

/// A bit for each lane: bit 2 n for lane n, so that two sets fit into one number.
pub(super) type LaneSet = u64;

/// All lanes.
pub(super) const ALL: LaneSet = LaneSet::MAX / 3;

/// A ray in flight.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Lane<Q> {
    pub(super) slab: SlabRay,
    pub(super) limit: f32,
    /// What is visited next.
    pub(super) at: u32,
    /// Top of the stack.
    pub(super) top: u32,
    /// Number of the ray.
    pub(super) ray: u32,
    pub(super) query: Q,
}

/// What lanes come to: the upper two bits of each reference, which tell nodes, leaves and
/// [`DONE`] apart.
#[derive(Default)]
pub(super) struct Arrivals(u64);

/// Lanes by what they have come to.
#[derive(Default)]
pub(super) struct Sets {
    pub(super) at_node: LaneSet,
    pub(super) at_leaf: LaneSet,
    pub(super) done: LaneSet,
}

/// Rays that take a step each in turn.
pub(super) struct Flight<Q, const STACK: usize> {
    lanes: [Lane<Q>; LANES],
    stacks: [Stack<STACK>; LANES],
}

/// Takes a lane out of a set.
#[inline(always)]
pub(super) fn take_lane(set: &mut LaneSet) -> usize {
    take_lowest(set) / 2 % LANES
}

impl Arrivals {
    /// Notes that `lane`, which has not come to anything yet, comes to `at`; returns the lane.
    #[inline(always)]
    pub(super) fn put(&mut self, lane: usize, at: u32) -> LaneSet {
        self.0 |= u64::from(at >> 30) << (2 * lane);
        1 << (2 * lane)
    }
}

impl Sets {
    /// Adds the lanes in `moved`, which were in none of the sets.
    #[inline(always)]
    pub(super) fn sort(&mut self, moved: LaneSet, arrivals: &Arrivals) {
        let (not_at_node, done) = ((arrivals.0 >> 1) & ALL, arrivals.0 & ALL);
        self.at_node |= moved & !not_at_node;
        self.at_leaf |= not_at_node & !done;
        self.done |= done;
    }
}

impl<Q> Lane<Q> {
    /// Takes the step at a node, and finds what is visited next. No branch depends on the ray: what comes
    /// next is hard to predict.
    #[inline(always)]
    pub(super) fn step_at_node<N: NodeTest, const ANY: bool, const STACK: usize>(
        &mut self,
        stack: &mut Stack<STACK>,
        nodes: &[WideNode],
    ) {
        let node = &nodes[self.at as usize];
        let met = N::enter(node, &self.slab, self.limit);
        let (top, octant) = (self.top as usize, self.slab.octant as usize);
        let top = stack.push::<N, ANY>(top, octant, met, &node.children);
        let (at, top) = stack.pop(top);
        (self.at, self.top) = (at, top as u32);
    }

    /// Takes the step at a leaf, and finds what is visited next. Adds the number of blocks to `blocks`.
    #[inline(always)]
    pub(super) fn step_at_leaf<N: NodeTest, const ANY: bool, const STACK: usize>(
        &mut self,
        stack: &mut Stack<STACK>,
        (leaves, rays): (&impl Leaves<Query = Q>, &[Ray]),
        blocks: &mut u64,
    ) {
        let ray = (&rays[self.ray as usize], &self.slab);
        let limit = leaves.visit::<N::Eight, ANY>(self.at & !LEAF, ray, &mut self.query, blocks);
        let mut top = self.top as usize;
        if !ANY && limit < self.limit {
            top = stack.cull::<N>(top, limit);
            self.limit = limit;
        }
        let (at, top) = if ANY && limit == f32::NEG_INFINITY {
            (DONE, BOTTOM)
        } else {
            stack.pop(top)
        };
        (self.at, self.top) = (at, top as u32);
    }
}

impl<Q: Copy, const STACK: usize> Flight<Q, STACK> {
    /// With `lane` in all lanes.
    #[inline(always)]
    pub(super) fn new(lane: Lane<Q>) -> Self {
        Self {
            lanes: [lane; LANES],
            stacks: [Stack::EMPTY; LANES],
        }
    }

    /// A lane and its stack.
    #[inline(always)]
    pub(super) fn lane(&mut self, number: usize) -> (&mut Lane<Q>, &mut Stack<STACK>) {
        (&mut self.lanes[number], &mut self.stacks[number])
    }

    /// Lets the lanes in `moved` take their steps at nodes.
    #[inline(always)]
    pub(super) fn pass_nodes<N: NodeTest, const ANY: bool>(
        &mut self,
        mut moved: LaneSet,
        nodes: &[WideNode],
        memory: &Memory,
    ) -> Arrivals {
        let mut arrivals = Arrivals::default();
        while moved != 0 {
            let number = take_lane(&mut moved);
            let (lane, stack) = self.lane(number);
            lane.step_at_node::<N, ANY, STACK>(stack, nodes);
            memory.fetch(lane.at);
            arrivals.put(number, lane.at);
        }
        arrivals
    }

    /// Lets the lanes in `moved` take their steps at leaves. Adds the number of blocks to `blocks`.
    #[inline(always)]
    pub(super) fn pass_leaves<N: NodeTest, const ANY: bool, L: Leaves<Query = Q>>(
        &mut self,
        mut moved: LaneSet,
        (leaves, rays): (&L, &[Ray]),
        memory: &Memory,
        blocks: &mut u64,
    ) -> Arrivals {
        let mut arrivals = Arrivals::default();
        while moved != 0 {
            let number = take_lane(&mut moved);
            let (lane, stack) = self.lane(number);
            lane.step_at_leaf::<N, ANY, STACK>(stack, (leaves, rays), blocks);
            memory.fetch(lane.at);
            arrivals.put(number, lane.at);
        }
        arrivals
    }
}
