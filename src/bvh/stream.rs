use super::entrance::Entrance;
use super::leaves::{Leaves, Work};
use super::memory::Memory;
use super::node::LEAF;
use super::simd::{Kernel, NodeTest};
use super::slab::SlabRay;
use super::stack::{BOTTOM, DONE, Stack};
use super::tree::Bvh;
use crate::math::Ray;

/// Rays in flight. Of 8, 16, 32 and 64 the fastest.
const LANES: usize = 32;

/// Many rays at once, a step each in turn, so that the memory that one ray waits for arrives while
/// the others work.
#[derive(Debug)]
pub(super) struct Stream<'a, L, F, const ANY: bool, const STACK: usize> {
    pub(super) bvh: &'a Bvh,
    pub(super) leaves: &'a L,
    pub(super) rays: &'a [Ray],
    /// Takes the number of a ray and its answer; `None` if the ray can meet nothing.
    pub(super) answer: F,
}

/// A ray in flight.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Lane<Q> {
    slab: SlabRay,
    limit: f32,
    /// What is visited next.
    at: u32,
    /// Top of the stack.
    top: u32,
    /// Number of the ray.
    ray: u32,
    query: Q,
}

/// A bit for each lane: bit 2 n for lane n, so that two sets fit into one number.
type LaneSet = u64;

/// All lanes.
const ALL: LaneSet = LaneSet::MAX / 3;

/// Where lanes come to in one pass.
struct Arrivals {
    /// The upper two bits of what each lane comes to.
    kinds: u64,
    memory: Memory,
}

/// Lanes by what they have come to.
struct Sorted {
    at_node: LaneSet,
    at_leaf: LaneSet,
    done: LaneSet,
}

impl Arrivals {
    /// Notes that `lane` comes to `at`, and asks for the memory of that step.
    #[inline(always)]
    fn put(&mut self, lane: usize, at: u32) {
        self.kinds |= u64::from(at >> 30) << (2 * lane);
        self.memory.fetch(at);
    }

    /// The lanes in `moved` by what they have come to since this was last asked.
    #[inline(always)]
    fn take(&mut self, moved: LaneSet) -> Sorted {
        let kinds = std::mem::take(&mut self.kinds);
        let (not_at_node, done) = ((kinds >> 1) & ALL, kinds & ALL);
        Sorted {
            at_node: moved & !not_at_node,
            at_leaf: not_at_node & !done,
            done,
        }
    }
}

/// Rays that have not started yet.
#[derive(Debug, Default)]
struct Queue {
    /// The first that nobody has looked at.
    next: usize,
    /// The rays from `first` on have been looked at together.
    first: usize,
    entrance: Entrance,
    /// A bit for each of them that goes on below the root.
    waiting: u32,
}

/// Takes the number of the lowest bit out of a set.
#[inline(always)]
fn take(set: &mut u32) -> usize {
    let lowest = set.trailing_zeros();
    *set &= *set - 1;
    lowest as usize
}

/// Takes a lane out of a set.
#[inline(always)]
fn take_lane(set: &mut LaneSet) -> usize {
    let lowest = set.trailing_zeros();
    *set &= *set - 1;
    (lowest / 2) as usize % LANES
}

impl<L: Leaves, F: FnMut(usize, Option<&L::Query>), const ANY: bool, const STACK: usize>
    Stream<'_, L, F, ANY, STACK>
{
    /// The number of the next ray that can meet anything, and if `ANY` what it meets of the root;
    /// answers those before it.
    #[inline(always)]
    fn next<N: NodeTest>(&mut self, queue: &mut Queue, work: &mut Work) -> Option<(usize, u32)> {
        if ANY {
            return self.next_below_root::<N>(queue, work);
        }
        while let Some(ray) = self.rays.get(queue.next) {
            let number = queue.next;
            queue.next += 1;
            if SlabRay::can_meet(ray) {
                return Some((number, 0));
            }
            (self.answer)(number, None);
        }
        None
    }

    #[inline(always)]
    fn next_below_root<N: NodeTest>(
        &mut self,
        queue: &mut Queue,
        work: &mut Work,
    ) -> Option<(usize, u32)> {
        while queue.waiting == 0 {
            let first = queue.next;
            let rest = self.rays.get(first..).filter(|rest| !rest.is_empty())?;
            let entrance = Entrance::new::<N::Rays>(&self.bvh.nodes()[0], rest);
            work.nodes += u64::from(entrance.valid().count_ones());
            queue.next += entrance.count();
            (queue.first, queue.waiting) = (first, entrance.go_on());
            let mut others = entrance.all() & !queue.waiting;
            while others != 0 {
                (self.answer)(first + take(&mut others), None);
            }
            queue.entrance = entrance;
        }
        let lane = take(&mut queue.waiting);
        Some((queue.first + lane, queue.entrance.meets(lane)))
    }

    /// Lets a ray start in `lane`: at the root, or if `ANY` at the first that it `meets` below.
    #[inline(always)]
    fn start<N: NodeTest>(
        &self,
        lane: &mut Lane<L::Query>,
        stack: &mut Stack<STACK>,
        (ray, meets): (usize, u32),
    ) {
        self.renew(lane, ray);
        if ANY {
            let octant = lane.slab.octant as usize;
            let children = &self.bvh.nodes()[0].children;
            let top = stack.push_all::<N>(BOTTOM, octant, meets, children);
            let (at, top) = stack.pop(top);
            (lane.at, lane.top) = (at, top as u32);
        }
    }

    /// Ray `number` at the root.
    #[inline(always)]
    fn lane(&self, number: usize) -> Lane<L::Query> {
        let ray = &self.rays[number];
        let slab = SlabRay::prepare(ray);
        Lane {
            slab,
            limit: slab.t_max(),
            at: 0,
            top: BOTTOM as u32,
            ray: number as u32,
            query: self.leaves.query(ray, &slab),
        }
    }

    /// Puts ray `number` at the root. Field by field: what was written in pieces and is read as a
    /// whole at once makes the processor wait.
    #[inline(always)]
    fn renew(&self, lane: &mut Lane<L::Query>, number: usize) {
        let ray = &self.rays[number];
        lane.slab = SlabRay::prepare(ray);
        lane.limit = lane.slab.t_max();
        lane.at = 0;
        lane.top = BOTTOM as u32;
        lane.ray = number as u32;
        lane.query = self.leaves.query(ray, &lane.slab);
    }
}

impl<L: Leaves, F: FnMut(usize, Option<&L::Query>), const ANY: bool, const STACK: usize> Kernel
    for Stream<'_, L, F, ANY, STACK>
{
    type Answer = Work;

    #[inline(always)]
    fn run<N: NodeTest>(mut self) -> Work {
        let (bvh, leaves) = (self.bvh, self.leaves);
        let mut work = Work::default();
        let mut queue = Queue::default();
        let Some(first) = self.next::<N>(&mut queue, &mut work) else {
            return work;
        };
        let mut lanes = [self.lane(first.0); LANES];
        let mut stacks = [Stack::<STACK>::EMPTY; LANES];
        let nodes = bvh.nodes();
        let mut arrivals = Arrivals {
            kinds: 0,
            memory: Memory::new(bvh, leaves),
        };
        let mut started: LaneSet = 0;
        let mut next = Some(first);
        for (number, (lane, stack)) in lanes.iter_mut().zip(&mut stacks).enumerate() {
            let Some(ray) = next
                .take()
                .or_else(|| self.next::<N>(&mut queue, &mut work))
            else {
                break;
            };
            self.start::<N>(lane, stack, ray);
            arrivals.put(number, lane.at);
            started |= 1 << (2 * number);
        }
        // Lanes whose next step is at a node, and at a leaf.
        let Sorted {
            mut at_node,
            mut at_leaf,
            ..
        } = arrivals.take(started);
        while at_node | at_leaf != 0 {
            work.nodes += u64::from(at_node.count_ones());
            let mut now = at_node;
            while now != 0 {
                let number = take_lane(&mut now);
                let lane = &mut lanes[number];
                let stack = &mut stacks[number];
                let node = &nodes[lane.at as usize];
                let met = N::enter(node, &lane.slab, lane.limit);
                let (top, octant) = (lane.top as usize, lane.slab.octant as usize);
                let top = stack.push::<N, ANY>(top, octant, met, &node.children);
                let (at, top) = stack.pop(top);
                (lane.at, lane.top) = (at, top as u32);
                arrivals.put(number, at);
            }
            let come = arrivals.take(at_node);
            let done = come.done;
            at_leaf |= come.at_leaf;
            let mut now = at_leaf;
            while now != 0 {
                let number = take_lane(&mut now);
                let lane = &mut lanes[number];
                let (block, blocks) = (lane.at & !LEAF, &mut work.blocks);
                let ray = (&self.rays[lane.ray as usize], &lane.slab);
                let limit = leaves.visit::<ANY>(block, ray, &mut lane.query, blocks);
                let stack = &mut stacks[number];
                let mut top = lane.top as usize;
                if !ANY && limit < lane.limit {
                    if top > BOTTOM {
                        top = stack.cull::<N>(top, limit);
                    }
                    lane.limit = limit;
                }
                let (at, top) = if ANY && limit == f32::NEG_INFINITY {
                    (DONE, BOTTOM)
                } else {
                    stack.pop(top)
                };
                (lane.at, lane.top) = (at, top as u32);
                arrivals.put(number, at);
            }
            at_node = come.at_node;
            let come = arrivals.take(at_leaf);
            at_node |= come.at_node;
            at_leaf = come.at_leaf;
            let mut now = done | come.done;
            let mut started = 0;
            while now != 0 {
                let number = take_lane(&mut now);
                let lane = &mut lanes[number];
                (self.answer)(lane.ray as usize, Some(&lane.query));
                if let Some(ray) = self.next::<N>(&mut queue, &mut work) {
                    self.start::<N>(lane, &mut stacks[number], ray);
                    arrivals.put(number, lane.at);
                    started |= 1 << (2 * number);
                }
            }
            let come = arrivals.take(started);
            at_node |= come.at_node;
            at_leaf |= come.at_leaf;
        }
        work
    }
}
