use super::entrance::Entrance;
use super::flight::{ALL, Arrivals, Flight, Lane, Sets, take_lane};
use super::leaves::{Leaves, Work};
use super::memory::Memory;
use super::simd::{Kernel, NodeTest};
use super::slab::SlabRay;
use super::stack::{BOTTOM, Stack};
use super::tree::Bvh;
use crate::math::{Ray, take_lowest};

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

/// Rays that have not started yet.
#[derive(Debug, Default)]
struct Queue {
    /// The first that nobody has looked at.
    next: usize,
    /// The rays from `first` on have been looked at together.
    first: usize,
    entrance: Entrance,
    /// A bit for each of them that goes on below the root.
    waiting: u64,
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
            let entrance = Entrance::new::<N::Eight>(&self.bvh.nodes()[0], rest);
            work.nodes += u64::from(entrance.valid().count_ones());
            queue.next += entrance.count();
            (queue.first, queue.waiting) = (first, u64::from(entrance.go_on()));
            let mut others = u64::from(entrance.all()) & !queue.waiting;
            while others != 0 {
                (self.answer)(first + take_lowest(&mut others), None);
            }
            queue.entrance = entrance;
        }
        let lane = take_lowest(&mut queue.waiting);
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
        let (nodes, leaves) = (self.bvh.nodes(), self.leaves);
        let mut work = Work::default();
        let mut queue = Queue::default();
        let Some(first) = self.next::<N>(&mut queue, &mut work) else {
            return work;
        };
        let memory = Memory::new(self.bvh, leaves);
        let mut flight = Flight::<_, STACK>::new(self.lane(first.0));
        let mut sets = Sets::default();
        let (mut next, mut empty) = (Some(first), ALL);
        let mut has_answers = false;
        loop {
            let (mut started, mut arrivals) = (0, Arrivals::default());
            while empty != 0 {
                let number = take_lane(&mut empty);
                let (lane, stack) = flight.lane(number);
                if has_answers {
                    (self.answer)(lane.ray as usize, Some(&lane.query));
                }
                let ray = next
                    .take()
                    .or_else(|| self.next::<N>(&mut queue, &mut work));
                let Some(ray) = ray else { continue };
                self.start::<N>(lane, stack, ray);
                memory.fetch(lane.at);
                started |= arrivals.put(number, lane.at);
            }
            has_answers = true;
            sets.sort(started, &arrivals);
            if sets.at_node | sets.at_leaf == 0 {
                return work;
            }
            work.nodes += u64::from(sets.at_node.count_ones());
            let moved = std::mem::take(&mut sets.at_node);
            let arrivals = flight.pass_nodes::<N, ANY>(moved, nodes, &memory);
            sets.sort(moved, &arrivals);
            let moved = std::mem::take(&mut sets.at_leaf);
            let arrivals = flight.pass_leaves::<N, ANY, L>(
                moved,
                (leaves, self.rays),
                &memory,
                &mut work.blocks,
            );
            sets.sort(moved, &arrivals);
            empty = std::mem::take(&mut sets.done);
        }
    }
}
