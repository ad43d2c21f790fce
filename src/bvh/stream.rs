use super::leaves::{Leaves, Work};
use super::node::LEAF;
use super::simd::{Kernel, NodeTest, prefetch};
use super::slab::SlabRay;
use super::stack::{DONE, Stack, stack_size};
use super::tree::Bvh;
use crate::math::Ray;

/// Rays in flight. Of 8, 16, 32 and 64 the fastest.
const LANES: usize = 32;

/// Many rays at once, a step each in turn, so that the memory that one ray waits for arrives while
/// the others work.
#[derive(Debug)]
pub(super) struct Stream<'a, L, F, const ANY: bool> {
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
    octant: u32,
    /// Height of the stack.
    open: u32,
    /// Number of the ray.
    ray: u32,
    query: Q,
}

/// Numbers of lanes.
struct Queue {
    lanes: [u8; 2 * LANES],
    len: usize,
}

impl Queue {
    const EMPTY: Self = Self {
        lanes: [0; 2 * LANES],
        len: 0,
    };

    /// Appends `lane` if `condition`, without a branch.
    #[inline(always)]
    fn push_if(&mut self, condition: bool, lane: u8) {
        self.lanes[self.len % (2 * LANES)] = lane;
        self.len += usize::from(condition);
    }

    /// The lanes; the queue is empty afterwards.
    #[inline(always)]
    fn take(&mut self) -> ([u8; 2 * LANES], usize) {
        (self.lanes, std::mem::take(&mut self.len))
    }
}

struct Queues {
    nodes: Queue,
    leaves: Queue,
    done: Queue,
}

impl Queues {
    /// Puts `lane` where its next step is done, and asks for the memory of that step.
    #[inline(always)]
    fn put<L: Leaves>(&mut self, bvh: &Bvh, leaves: &L, lane: u8, at: u32) {
        let is_leaf = at & LEAF != 0;
        let is_done = at == DONE;
        self.nodes.push_if(!is_leaf, lane);
        self.leaves.push_if(is_leaf & !is_done, lane);
        self.done.push_if(is_done, lane);
        if is_leaf {
            leaves.prefetch(at & !LEAF);
        } else if let Some(node) = bvh.nodes().get(at as usize) {
            prefetch(node);
        }
    }
}

impl<L: Leaves, F: FnMut(usize, Option<&L::Query>), const ANY: bool> Stream<'_, L, F, ANY> {
    /// The next ray that can meet anything; answers those that cannot.
    #[inline(always)]
    fn next(&mut self, next: &mut usize) -> Option<Lane<L::Query>> {
        while let Some(ray) = self.rays.get(*next) {
            let number = *next;
            *next += 1;
            if let Some(slab) = SlabRay::new(ray) {
                return Some(Lane {
                    slab,
                    limit: slab.t_max(),
                    at: 0,
                    octant: slab.octant() as u32,
                    open: 1,
                    ray: number as u32,
                    query: self.leaves.query(ray, &slab),
                });
            }
            (self.answer)(number, None);
        }
        None
    }
}

impl<L: Leaves, F: FnMut(usize, Option<&L::Query>), const ANY: bool> Kernel
    for Stream<'_, L, F, ANY>
{
    type Answer = Work;

    #[inline(always)]
    fn run<N: NodeTest>(mut self) -> Work {
        let (bvh, leaves) = (self.bvh, self.leaves);
        let mut work = Work::default();
        let mut queues = Queues {
            nodes: Queue::EMPTY,
            leaves: Queue::EMPTY,
            done: Queue::EMPTY,
        };
        let size = stack_size(bvh);
        let (mut references, mut near) = (vec![0; LANES * size], vec![0.0; LANES * size]);
        let mut next = 0;
        let mut lanes = Vec::with_capacity(LANES);
        while lanes.len() < LANES
            && let Some(lane) = self.next(&mut next)
        {
            let number = lanes.len();
            let begin = number * size;
            Stack::new(&mut references[begin..], &mut near[begin..]).clear();
            queues.nodes.push_if(true, number as u8);
            lanes.push(lane);
        }
        while queues.nodes.len + queues.leaves.len > 0 {
            let (queue, len) = queues.nodes.take();
            work.nodes += len as u64;
            for &number in &queue[..len] {
                let lane = &mut lanes[number as usize];
                let begin = number as usize * size;
                let (references, near) = (&mut references[begin..], &mut near[begin..]);
                let mut stack = Stack::new(&mut references[..size], &mut near[..size]);
                let node = &bvh.nodes()[lane.at as usize];
                let met = N::enter(node, &lane.slab, lane.limit);
                let open = lane.open as usize;
                let open = stack.push::<N, ANY>(open, lane.octant as usize, met, &node.children);
                let (at, open) = stack.pop::<ANY>(open, lane.limit);
                (lane.at, lane.open) = (at, open as u32);
                queues.put(bvh, leaves, number, at);
            }
            let (queue, len) = queues.leaves.take();
            for &number in &queue[..len] {
                let lane = &mut lanes[number as usize];
                let begin = number as usize * size;
                let (references, near) = (&mut references[begin..], &mut near[begin..]);
                let stack = Stack::new(&mut references[..size], &mut near[..size]);
                let blocks = &mut work.blocks;
                let block = lane.at & !LEAF;
                lane.limit = leaves.visit::<ANY>(block, &lane.slab, &mut lane.query, blocks);
                let (at, open) = if ANY && lane.limit == f32::NEG_INFINITY {
                    (DONE, 1)
                } else {
                    stack.pop::<ANY>(lane.open as usize, lane.limit)
                };
                (lane.at, lane.open) = (at, open as u32);
                queues.put(bvh, leaves, number, at);
            }
            let (queue, len) = queues.done.take();
            for &number in &queue[..len] {
                let lane = &mut lanes[number as usize];
                (self.answer)(lane.ray as usize, Some(&lane.query));
                if let Some(new) = self.next(&mut next) {
                    *lane = new;
                    queues.nodes.push_if(true, number);
                }
            }
        }
        work
    }
}
