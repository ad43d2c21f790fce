//! Packets: thirty-two rays that take nearly the same way go through the tree together.
//!
//! A lane of the processor's vectors is a ray here, where it is a child of a node or a triangle for
//! single rays; what is computed for a ray and a box or a triangle is the same. Rays that part from
//! the others go on by themselves below the node where they do.

mod interval;
mod pending;
mod pool;
mod rays;

pub use rays::{PACKET, PacketRays, PerRay, groups};

use super::flight::Lane;
use super::leaves::{PacketAnswers, PacketLeaves, Work};
use super::memory::Memory;
use super::node::LEAF;
use super::simd::{Kernel, NodeTest};
use super::tree::Bvh;
use crate::math::{Ray, take_lowest};
use interval::{Interval, largest};
use pending::Pending;
use pool::Pool;

/// Up to so many rays leave a packet at a node with many primitives for each; fewer are no packet.
/// More (9) is 10 % faster where triangles are smaller than pixels, and 10 % slower elsewhere.
const FEW: u32 = 4;

/// Many. More is slower where triangles are small.
const MANY: usize = 8;

/// All rays of a packet.
const ALL: u32 = u32::MAX >> (32 - PACKET);

/// Traces packets one after the other.
#[derive(Debug)]
pub(super) struct Packets<'a, L, A, const STACK: usize> {
    pub(super) bvh: &'a Bvh,
    pub(super) leaves: &'a L,
    pub(super) rays: &'a [Ray],
    pub(super) answers: &'a mut A,
    /// Gets the numbers of the rays that make no packet.
    pub(super) rest: &'a mut Vec<u32>,
}

/// All that one thread needs to trace packets.
struct Room<Q, P, const STACK: usize> {
    rays: PacketRays,
    packet: P,
    pending: Pending,
    pool: Pool<Q, STACK>,
    memory: Memory,
    work: Work,
}

impl<L: PacketLeaves, A: PacketAnswers<L>, const STACK: usize> Kernel for Packets<'_, L, A, STACK> {
    type Answer = Work;

    #[inline(always)]
    fn run<N: NodeTest>(mut self) -> Work {
        let mut room = Room {
            rays: PacketRays::EMPTY,
            packet: L::Packet::default(),
            pending: Pending::new(self.bvh.wide_depth()),
            pool: Pool::new(),
            memory: Memory::new(self.bvh, self.leaves),
            work: Work::default(),
        };
        let (packets, last) = self.rays.as_chunks::<PACKET>();
        let mut first = 0;
        for rays in packets {
            let is_whole = self.prepare::<N>(rays, &mut room);
            let mut left = ALL;
            while left != 0 {
                let members = if is_whole {
                    std::mem::take(&mut left)
                } else {
                    self.choose::<N>((first, rays), &mut left, &mut room)
                };
                if members != 0 {
                    self.trace::<N>(first, members, &mut room);
                }
            }
            first += PACKET;
        }
        self.finish::<N>(0, &mut room);
        self.rest.extend(first as u32..(first + last.len()) as u32);
        room.work
    }
}

impl<L: PacketLeaves, A: PacketAnswers<L>, const STACK: usize> Packets<'_, L, A, STACK> {
    /// Makes a packet of `rays`; false if they cannot be one.
    #[inline(always)]
    fn prepare<N: NodeTest>(
        &self,
        rays: &[Ray; PACKET],
        room: &mut Room<L::Query, L::Packet, STACK>,
    ) -> bool {
        room.rays.set::<N::Rays>(rays)
            && self
                .leaves
                .set_packet::<N::Rays>(&room.rays, &mut room.packet)
    }

    /// Makes a packet of those rays in `left` that agree with its first, and of copies of that one;
    /// returns them. If they are too few, they and what is like them are left to others.
    #[inline(always)]
    fn choose<N: NodeTest>(
        &mut self,
        (first, rays): (usize, &[Ray; PACKET]),
        left: &mut u32,
        room: &mut Room<L::Query, L::Packet, STACK>,
    ) -> u32 {
        let leader = left.trailing_zeros() as usize % PACKET;
        let mut chosen = [rays[leader]; PACKET];
        let mut members = 0;
        for i in 0..PACKET {
            if way(&rays[i]) == way(&rays[leader]) {
                chosen[i] = rays[i];
                members |= 1 << i;
            }
        }
        *left &= !members;
        let others = (0..PACKET).filter(|i| members >> i & 1 == 0);
        if members.count_ones() > FEW && self.prepare::<N>(&chosen, room) {
            others.for_each(|i| L::drop_ray(&mut room.packet, i));
            return members;
        }
        let members = (0..PACKET).filter(|i| members >> i & 1 == 1);
        self.rest.extend(members.map(|i| (first + i) as u32));
        0
    }

    /// Traces the packet in `room`, whose first ray has number `first`, and answers the rays in
    /// `wanted`.
    #[inline(always)]
    fn trace<N: NodeTest>(
        &mut self,
        first: usize,
        mut wanted: u32,
        room: &mut Room<L::Query, L::Packet, STACK>,
    ) {
        let shared = room.rays.share_origin::<N::Rays>();
        let interval = Interval::new::<N::Rays>(&room.rays, shared);
        room.pending.references[0] = 0;
        room.pending.near[0] = room.rays.t_min;
        let mut top = 1;
        let mut most = largest::<N::Rays>(L::limit(&room.packet));
        while top > 0 {
            top -= 1;
            let limit = L::limit(&room.packet);
            let active = room.pending.active::<N::Rays>(limit, top);
            if active == 0 {
                continue;
            }
            let at = room.pending.references[top];
            let count = active.count_ones();
            if self.parts(at, count) {
                if (room.pool.free() as usize) < PACKET {
                    self.finish::<N>((pool::POOL - PACKET) as u32, room);
                }
                self.leave(first, active, room, (at, top));
                wanted &= !active;
            } else if at & LEAF == 0 {
                room.work.nodes += u64::from(count);
                let (node, pending) = (&self.bvh.nodes()[at as usize], &mut room.pending);
                let memory = &room.memory;
                let packet = (&room.rays, &interval, (limit, most));
                let found = |child| memory.fetch(child);
                top = if shared {
                    pending.open::<N, true>(top, node, packet, found)
                } else {
                    pending.open::<N, false>(top, node, packet, found)
                };
            } else {
                let rays = (&self.rays[first..first + PACKET], &room.rays);
                let (block, packet) = (at & !LEAF, &mut room.packet);
                let blocks = if shared {
                    self.leaves
                        .visit_packet::<N::Rays, true>(block, rays, packet, active)
                } else {
                    self.leaves
                        .visit_packet::<N::Rays, false>(block, rays, packet, active)
                };
                room.work.blocks += blocks * u64::from(count);
                most = largest::<N::Rays>(L::limit(packet));
            }
        }
        if wanted == ALL {
            return self.answers.all(first, &room.packet);
        }
        let mut wanted = u64::from(wanted);
        while wanted != 0 {
            let i = take_lowest(&mut wanted);
            let query = self.leaves.of_packet(&room.packet, i);
            self.answers.one(first + i, Some(&query));
        }
    }

    /// Ray `i` of the packet by itself, to go on at `at`.
    #[inline(always)]
    fn lane(
        &self,
        first: usize,
        i: usize,
        room: &Room<L::Query, L::Packet, STACK>,
        at: u32,
    ) -> Lane<L::Query> {
        Lane {
            slab: room.rays.slab(i),
            limit: L::limit(&room.packet).of_ray(i),
            at,
            top: 0,
            ray: (first + i) as u32,
            query: self.leaves.of_packet(&room.packet, i),
        }
    }

    /// Whether `count` rays that meet what lies below `at` will find different ways there.
    #[inline(always)]
    fn parts(&self, at: u32, count: u32) -> bool {
        count <= FEW
            && at & LEAF == 0
            && self.bvh.nodes()[at as usize].primitives() >= MANY * count as usize
    }

    /// Takes the rays in `leaving` out of the packet: they go on from `at`, and then with what the
    /// packet has still to visit, below `top`.
    #[inline(always)]
    fn leave(
        &mut self,
        first: usize,
        leaving: u32,
        room: &mut Room<L::Query, L::Packet, STACK>,
        (at, top): (u32, usize),
    ) {
        let mut left = u64::from(leaving);
        while left != 0 {
            let i = take_lowest(&mut left);
            let lane = self.lane(first, i, room, at);
            let pending = &room.pending;
            room.pool.add(lane, |stacks, bottom| {
                let entries = pending.references[..top].iter().zip(&pending.near);
                entries.fold(bottom, |to, (&reference, near)| {
                    let near = near.of_ray(i);
                    stacks.put(to, (reference, near), lane.limit)
                })
            });
            L::drop_ray(&mut room.packet, i);
        }
    }

    /// Leads the rays in the pool on until at most `keep` of them are left, and answers the others.
    #[inline(always)]
    fn finish<N: NodeTest>(&mut self, keep: u32, room: &mut Room<L::Query, L::Packet, STACK>) {
        let set = (room.pool.taken(), keep);
        let (pool, work) = (&mut room.pool, &mut room.work);
        let tree = (self.bvh, self.leaves, &room.memory);
        let mut done = pool.run::<N, L>(set, tree, self.rays, work);
        while done != 0 {
            let lane = pool.remove(take_lowest(&mut done));
            self.answers.one(lane.ray as usize, Some(&lane.query));
        }
    }
}

/// The same number for rays whose directions agree in signs and in the axis along which they are longest.
fn way(ray: &Ray) -> u8 {
    let [x, y, z] = ray.direction.to_array();
    let [ax, ay, az] = [x.abs(), y.abs(), z.abs()];
    let longest = if az > ax && az > ay {
        2
    } else {
        u8::from(ay > ax)
    };
    longest << 3 | u8::from(z < 0.0) << 2 | u8::from(y < 0.0) << 1 | u8::from(x < 0.0)
}
