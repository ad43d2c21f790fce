use super::super::leaves::{Leaves, Work};
use super::super::node::LEAF;
use super::super::simd::NodeTest;
use super::super::slab::SlabRay;
use super::super::stack::{DONE, Stacks};
use super::super::tree::Bvh;
use super::rays::PACKET;
use crate::math::Ray;

/// A few rays of a packet on their own way, a step each in turn.
pub(super) struct Few<Q> {
    lanes: Vec<Lane<Q>>,
    stacks: Stacks,
}

/// One of them.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Lane<Q> {
    slab: SlabRay,
    limit: f32,
    at: u32,
    /// Top of the stack.
    top: u32,
    /// Number in the packet.
    ray: u32,
    query: Q,
}

impl<Q: Copy> Few<Q> {
    /// Nobody; `stacks` are for all rays of a packet.
    pub(super) fn new(stacks: Stacks) -> Self {
        Self {
            lanes: Vec::with_capacity(PACKET),
            stacks,
        }
    }

    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.lanes.clear();
    }

    /// Adds ray `ray` of the packet.
    #[inline(always)]
    pub(super) fn push(&mut self, ray: u32, slab: SlabRay, limit: f32, query: Q) {
        self.lanes.push(Lane {
            slab,
            limit,
            at: 0,
            top: 0,
            ray,
            query,
        });
    }

    /// Leads all of them through what lies below `at`.
    #[inline(always)]
    pub(super) fn run<N: NodeTest, L: Leaves<Query = Q>>(
        &mut self,
        bvh: &Bvh,
        leaves: &L,
        (rays, at): (&[Ray; PACKET], u32),
        work: &mut Work,
    ) {
        for (i, lane) in self.lanes.iter_mut().enumerate() {
            lane.at = at;
            lane.top = self.stacks.bottom(i) as u32;
        }
        let mut open = (1_u32 << self.lanes.len()) - 1;
        while open != 0 {
            let mut now = open;
            while now != 0 {
                let number = now.trailing_zeros() as usize;
                now &= now - 1;
                let lane = &mut self.lanes[number];
                let mut top = lane.top as usize;
                if lane.at & LEAF == 0 {
                    work.nodes += 1;
                    let node = &bvh.nodes()[lane.at as usize];
                    let met = N::enter(node, &lane.slab, lane.limit);
                    let octant = lane.slab.octant as usize;
                    top = self
                        .stacks
                        .push::<N, false>(top, octant, met, &node.children);
                } else {
                    let ray = (&rays[lane.ray as usize % PACKET], &lane.slab);
                    let blocks = &mut work.blocks;
                    lane.limit =
                        leaves.visit::<false>(lane.at & !LEAF, ray, &mut lane.query, blocks);
                }
                let (at, top) = self.stacks.pop::<false>(top, lane.limit);
                (lane.at, lane.top) = (at, top as u32);
                open &= !(u32::from(at == DONE) << number);
            }
        }
    }

    /// The rays, by their numbers in the packet, and their best hits.
    #[inline(always)]
    pub(super) fn answers(&self) -> impl Iterator<Item = (u32, &Q)> {
        self.lanes.iter().map(|lane| (lane.ray, &lane.query))
    }
}
