use super::leaves::{Leaves, Work};
use super::node::{LEAF, WideNode};
use super::simd::{Kernel, NodeTest, prefetch};
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

/// Lanes that come to their next step in one pass, a bit each.
struct Arrivals {
    /// Lanes that come to a leaf or to the end.
    not_at_node: u32,
    /// Lanes that come to the end.
    done: u32,
    nodes: *const u8,
    blocks: *const u8,
    block_size: usize,
}

impl Arrivals {
    fn new(bvh: &Bvh, leaves: &impl Leaves) -> Self {
        let (nodes, blocks) = (bvh.nodes(), leaves.blocks());
        Self {
            not_at_node: 0,
            done: 0,
            nodes: nodes.as_ptr().cast(),
            blocks: blocks.as_ptr().cast(),
            block_size: size_of_val(blocks).checked_div(blocks.len()).unwrap_or(0),
        }
    }

    /// Notes that `lane` comes to `at`, and asks for the memory of that step. No branch: what comes
    /// next is hard to predict.
    #[inline(always)]
    fn put(&mut self, lane: usize, at: u32) {
        let is_leaf = at >> LEAF.trailing_zeros();
        self.not_at_node |= is_leaf << lane;
        self.done |= u32::from(at == DONE) << lane;
        let (memory, size) = if is_leaf == 1 {
            (self.blocks, self.block_size)
        } else {
            (self.nodes, size_of::<WideNode>())
        };
        prefetch(memory.wrapping_add((at & !LEAF) as usize * size), 4);
    }
}

/// Takes the number of the lowest bit out of a set.
#[inline(always)]
fn take(set: &mut u32) -> usize {
    let lowest = set.trailing_zeros();
    *set &= *set - 1;
    lowest as usize
}

impl<L: Leaves, F: FnMut(usize, Option<&L::Query>), const ANY: bool, const STACK: usize>
    Stream<'_, L, F, ANY, STACK>
{
    /// The number of the next ray that can meet anything; answers those that cannot.
    #[inline(always)]
    fn next(&mut self, next: &mut usize) -> Option<usize> {
        while let Some(ray) = self.rays.get(*next) {
            let number = *next;
            *next += 1;
            if SlabRay::can_meet(ray) {
                return Some(number);
            }
            (self.answer)(number, None);
        }
        None
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
        let mut next = 0;
        let Some(first) = self.next(&mut next) else {
            return work;
        };
        let mut lanes = [self.lane(first); LANES];
        let mut stacks = [Stack::<STACK>::EMPTY; LANES];
        // Lanes whose next step is at a node, and at a leaf; a bit each.
        let (mut at_node, mut at_leaf) = (1_u32, 0);
        for (number, lane) in lanes.iter_mut().enumerate().skip(1) {
            if let Some(ray) = self.next(&mut next) {
                *lane = self.lane(ray);
                at_node |= 1 << number;
            }
        }
        let mut arrivals = Arrivals::new(bvh, leaves);
        while at_node | at_leaf != 0 {
            work.nodes += u64::from(at_node.count_ones());
            let mut now = at_node;
            while now != 0 {
                let number = take(&mut now);
                let lane = &mut lanes[number % LANES];
                let stack = &mut stacks[number % LANES];
                let node = &bvh.nodes()[lane.at as usize];
                let met = N::enter(node, &lane.slab, lane.limit);
                let (top, octant) = (lane.top as usize, lane.slab.octant as usize);
                let top = stack.push::<N, ANY>(top, octant, met, &node.children);
                let (at, top) = stack.pop::<ANY>(top, lane.limit);
                (lane.at, lane.top) = (at, top as u32);
                arrivals.put(number, at);
            }
            at_node &= !arrivals.not_at_node;
            at_leaf |= arrivals.not_at_node & !arrivals.done;
            arrivals.not_at_node = 0;
            let mut now = at_leaf;
            while now != 0 {
                let number = take(&mut now);
                let lane = &mut lanes[number % LANES];
                let (block, blocks) = (lane.at & !LEAF, &mut work.blocks);
                let ray = (&self.rays[lane.ray as usize], &lane.slab);
                lane.limit = leaves.visit::<ANY>(block, ray, &mut lane.query, blocks);
                let (at, top) = if ANY && lane.limit == f32::NEG_INFINITY {
                    (DONE, BOTTOM)
                } else {
                    stacks[number % LANES].pop::<ANY>(lane.top as usize, lane.limit)
                };
                (lane.at, lane.top) = (at, top as u32);
                arrivals.put(number, at);
            }
            at_node |= at_leaf & !arrivals.not_at_node;
            at_leaf = arrivals.not_at_node & !arrivals.done;
            arrivals.not_at_node = 0;
            let mut now = std::mem::take(&mut arrivals.done);
            while now != 0 {
                let number = take(&mut now);
                let lane = &mut lanes[number % LANES];
                (self.answer)(lane.ray as usize, Some(&lane.query));
                if let Some(ray) = self.next(&mut next) {
                    self.renew(lane, ray);
                    at_node |= 1 << number;
                }
            }
        }
        work
    }
}
