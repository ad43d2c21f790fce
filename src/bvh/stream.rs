use super::leaves::{Leaves, Work};
use super::node::{LEAF, WideNode};
use super::simd::{Kernel, NodeTest, prefetch};
use super::slab::SlabRay;
use super::stack::{DONE, Stacks};
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
    /// Top of the stack.
    top: u32,
    /// Number of the ray.
    ray: u32,
    query: Q,
}

/// Lanes that wait for their next step, a bit each.
struct Waiting {
    nodes: u32,
    leaves: u32,
    done: u32,
    node_memory: *const u8,
    block_memory: *const u8,
    block_size: usize,
}

impl Waiting {
    /// Puts `lane` where its next step is done, and asks for the memory of that step. No branch:
    /// what comes next is hard to predict.
    #[inline(always)]
    fn put(&mut self, lane: u32, at: u32) {
        let is_leaf = at & LEAF != 0;
        let is_done = at == DONE;
        self.nodes |= u32::from(!is_leaf) << lane;
        self.leaves |= u32::from(is_leaf & !is_done) << lane;
        self.done |= u32::from(is_done) << lane;
        let (memory, size) = if is_leaf {
            (self.block_memory, self.block_size)
        } else {
            (self.node_memory, size_of::<WideNode>())
        };
        prefetch(memory.wrapping_add((at & !LEAF) as usize * size), 4);
    }
}

/// Takes the lowest bit out of a set.
#[inline(always)]
fn take(set: &mut u32) -> u32 {
    let lowest = set.trailing_zeros();
    *set &= *set - 1;
    lowest
}

impl<L: Leaves, F: FnMut(usize, Option<&L::Query>), const ANY: bool> Stream<'_, L, F, ANY> {
    /// The next ray that can meet anything, at the root with a stack from `bottom` on; answers those
    /// that cannot.
    #[inline(always)]
    fn next(&mut self, next: &mut usize, bottom: usize) -> Option<Lane<L::Query>> {
        while let Some(ray) = self.rays.get(*next) {
            let number = *next;
            *next += 1;
            if let Some(slab) = SlabRay::new(ray) {
                return Some(Lane {
                    slab,
                    limit: slab.t_max(),
                    at: 0,
                    top: bottom as u32,
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
        let mut waiting = Waiting {
            nodes: 0,
            leaves: 0,
            done: 0,
            node_memory: bvh.nodes().as_ptr().cast(),
            block_memory: leaves.blocks().as_ptr().cast(),
            block_size: size_of::<L::Block>(),
        };
        let mut stacks = Stacks::new(bvh, LANES);
        let mut next = 0;
        let mut lanes = Vec::with_capacity(LANES);
        while lanes.len() < LANES
            && let Some(lane) = self.next(&mut next, stacks.bottom(lanes.len()))
        {
            waiting.nodes |= 1 << lanes.len();
            lanes.push(lane);
        }
        while waiting.nodes | waiting.leaves != 0 {
            let mut now = std::mem::take(&mut waiting.nodes);
            work.nodes += u64::from(now.count_ones());
            while now != 0 {
                let number = take(&mut now);
                let lane = &mut lanes[number as usize];
                let node = &bvh.nodes()[lane.at as usize];
                let met = N::enter(node, &lane.slab, lane.limit);
                let (top, octant) = (lane.top as usize, lane.slab.octant as usize);
                let top = stacks.push::<N, ANY>(top, octant, met, &node.children);
                let (at, top) = stacks.pop::<ANY>(top, lane.limit);
                (lane.at, lane.top) = (at, top as u32);
                waiting.put(number, at);
            }
            let mut now = std::mem::take(&mut waiting.leaves);
            while now != 0 {
                let number = take(&mut now);
                let lane = &mut lanes[number as usize];
                let (block, blocks) = (lane.at & !LEAF, &mut work.blocks);
                lane.limit = leaves.visit::<ANY>(
                    block,
                    (&self.rays[lane.ray as usize], &lane.slab),
                    &mut lane.query,
                    blocks,
                );
                let (at, top) = if ANY && lane.limit == f32::NEG_INFINITY {
                    (DONE, 0)
                } else {
                    stacks.pop::<ANY>(lane.top as usize, lane.limit)
                };
                (lane.at, lane.top) = (at, top as u32);
                waiting.put(number, at);
            }
            let mut now = std::mem::take(&mut waiting.done);
            while now != 0 {
                let number = take(&mut now);
                let lane = &mut lanes[number as usize];
                (self.answer)(lane.ray as usize, Some(&lane.query));
                if let Some(new) = self.next(&mut next, stacks.bottom(number as usize)) {
                    *lane = new;
                    waiting.nodes |= 1 << number;
                }
            }
        }
        work
    }
}
