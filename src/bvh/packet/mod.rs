//! Packets: sixteen rays that take nearly the same way go through the tree together.
//!
//! A lane of the processor's vectors is a ray here, where it is a child of a node or a triangle for
//! single rays; what is computed for a ray and a box or a triangle is the same. Rays that part from
//! the others go on by themselves below the node where they do.

mod few;
mod interval;
mod rays;

pub use rays::{GROUPS, PACKET, PacketRays, PerRay};

use super::leaves::{PacketLeaves, Work};
use super::node::{LEAF, WIDTH};
use super::octant::FAR_TO_NEAR;
use super::simd::{Kernel, LANES, Lanes, NodeTest};
use super::stack::Stacks;
use super::tree::Bvh;
use crate::math::Ray;
use few::Few;
use interval::{Interval, Planes, largest};

/// Up to so many rays of a packet go on by themselves.
const FEW: u32 = 4;

/// Traces packets one after the other.
#[derive(Debug)]
pub(super) struct Packets<'a, L, F> {
    pub(super) bvh: &'a Bvh,
    pub(super) leaves: &'a L,
    pub(super) rays: &'a [Ray],
    /// Takes the number of a ray and its answer.
    pub(super) answer: F,
    /// Gets the numbers of the rays that make no packet.
    pub(super) rest: &'a mut Vec<u32>,
}

/// What a packet has still to visit, the nearest last.
#[derive(Debug)]
struct Pending {
    references: Vec<u32>,
    /// Where each ray enters; infinite for those that do not.
    near: Vec<PerRay>,
}

/// All that one thread needs to trace packets.
struct Room<Q, P> {
    rays: PacketRays,
    packet: P,
    pending: Pending,
    few: Few<Q>,
    work: Work,
}

impl<L: PacketLeaves, F: FnMut(usize, Option<&L::Query>)> Kernel for Packets<'_, L, F> {
    type Answer = Work;

    #[inline(always)]
    fn run<N: NodeTest>(mut self) -> Work {
        let depth = (WIDTH - 1) * self.bvh.wide_depth() + 1 + WIDTH;
        let mut room = Room {
            rays: PacketRays::EMPTY,
            packet: L::Packet::default(),
            pending: Pending {
                references: vec![0; depth],
                near: vec![[[0.0; LANES]; GROUPS]; depth],
            },
            few: Few::new(Stacks::new(self.bvh, PACKET)),
            work: Work::default(),
        };
        let (packets, last) = self.rays.as_chunks::<PACKET>();
        let mut first = 0;
        for rays in packets {
            let is_packet = room.rays.set::<N::Rays>(rays)
                && self
                    .leaves
                    .set_packet::<N::Rays>(&room.rays, &mut room.packet);
            if is_packet {
                if room.rays.share_origin::<N::Rays>() {
                    self.trace::<N, true>(rays, &mut room);
                } else {
                    self.trace::<N, false>(rays, &mut room);
                }
                for i in 0..PACKET {
                    (self.answer)(first + i, Some(&self.leaves.of_packet(&room.packet, i)));
                }
            } else {
                self.rest.extend(first as u32..(first + PACKET) as u32);
            }
            first += PACKET;
        }
        self.rest.extend(first as u32..(first + last.len()) as u32);
        room.work
    }
}

impl<L: PacketLeaves, F> Packets<'_, L, F> {
    /// Traces the packet in `room`, made of `rays`. If `SHARED`, all start at one point.
    #[inline(always)]
    fn trace<N: NodeTest, const SHARED: bool>(
        &self,
        rays: &[Ray; PACKET],
        room: &mut Room<L::Query, L::Packet>,
    ) {
        let interval = Interval::new::<N::Rays>(&room.rays);
        room.pending.references[0] = 0;
        room.pending.near[0] = room.rays.t_min;
        let mut top = 1;
        while top > 0 {
            top -= 1;
            let active = room.active::<N::Rays>(L::limit(&room.packet), top);
            if active == 0 {
                continue;
            }
            let at = room.pending.references[top];
            let count = active.count_ones();
            if count <= FEW {
                self.part::<N>(rays, room, at, active);
            } else if at & LEAF == 0 {
                room.work.nodes += u64::from(count);
                top = self.open::<N, SHARED>(room, at, &interval, top);
            } else {
                let blocks = self.leaves.visit_packet::<N::Rays, SHARED>(
                    at & !LEAF,
                    (rays, &room.rays),
                    &mut room.packet,
                    active,
                );
                room.work.blocks += blocks * u64::from(count);
            }
        }
    }

    /// Puts the children of node `at` that some ray meets on the stack; returns the new top.
    #[inline(always)]
    fn open<N: NodeTest, const SHARED: bool>(
        &self,
        room: &mut Room<L::Query, L::Packet>,
        at: u32,
        interval: &Interval,
        mut top: usize,
    ) -> usize {
        let Room {
            rays,
            packet,
            pending,
            ..
        } = room;
        let node = &self.bvh.nodes()[at as usize];
        let limit = L::limit(packet);
        let limits: [N::Rays; GROUPS] = [N::Rays::load(&limit[0]), N::Rays::load(&limit[1])];
        let mut planes: Planes = [[[0.0; WIDTH]; 2]; 3];
        let most = largest(limits[0].max(limits[1]));
        let met = interval.enter::<N::Rays, SHARED>(node, rays.octant, most, &mut planes);
        let mut order = FAR_TO_NEAR[rays.octant as usize % 8][met as usize % (1 << WIDTH)];
        for _ in 0..met.count_ones() {
            let slot = order as usize % WIDTH;
            order >>= 8;
            let entry = &mut pending.near[top];
            let mut any = 0;
            for group in 0..GROUPS {
                let (near, meets) =
                    enter_child::<N::Rays, SHARED>(rays, &planes, slot, group, limits[group]);
                any |= N::Rays::bits(meets);
                N::Rays::select(meets, near, N::Rays::splat(f32::INFINITY))
                    .store(&mut entry[group]);
            }
            pending.references[top] = node.children[slot];
            top += usize::from(any != 0);
        }
        top
    }

    /// Lets the `active` rays go on by themselves from `at` on, up to the end of what lies below.
    #[inline(always)]
    fn part<N: NodeTest>(
        &self,
        rays: &[Ray; PACKET],
        room: &mut Room<L::Query, L::Packet>,
        at: u32,
        active: u32,
    ) {
        let mut left = active;
        room.few.clear();
        while left != 0 {
            let i = left.trailing_zeros() as usize % PACKET;
            left &= left - 1;
            let query = self.leaves.of_packet(&room.packet, i);
            let limit = L::limit(&room.packet)[i / LANES][i % LANES];
            room.few.push(i as u32, room.rays.slab(i), limit, query);
        }
        room.few
            .run::<N, L>(self.bvh, self.leaves, (rays, at), &mut room.work);
        for (i, query) in room.few.answers() {
            self.leaves
                .to_packet(&room.rays, query, &mut room.packet, i as usize);
        }
    }
}

impl<Q, P> Room<Q, P> {
    /// The rays that still want the entry `top`.
    #[inline(always)]
    fn active<V: Lanes>(&self, limit: &PerRay, top: usize) -> u32 {
        let near = &self.pending.near[top];
        let mut active = 0;
        for group in 0..GROUPS {
            // Equality stays in: a hit at the same parameter may have the smaller id.
            let wants = V::load(&near[group]).le(V::load(&limit[group]));
            active |= V::bits(wants) << (LANES * group);
        }
        active
    }
}

/// [`super::SlabRay::enter`] for the rays of a group and the child in `slot`.
#[inline(always)]
fn enter_child<V: Lanes, const SHARED: bool>(
    rays: &PacketRays,
    planes: &Planes,
    slot: usize,
    group: usize,
    limit: V,
) -> (V, V::Mask) {
    let t = |axis: usize, side: usize| {
        let plane = V::splat(planes[axis][side][slot]);
        let distance = if SHARED {
            plane
        } else {
            plane - rays.origin(axis, group)
        };
        distance * rays.inverse(axis, group)
    };
    let near = t(0, 0).max(t(1, 0)).max(t(2, 0).max(rays.t_min(group)));
    let far = t(0, 1).min(t(1, 1)).min(t(2, 1).min(limit));
    (near, near.le(far * V::splat(super::slab::FAR_MARGIN)))
}
