use super::super::node::{WIDTH, WideNode};
use super::super::octant::FAR_TO_NEAR;
use super::super::simd::NodeTest;
use super::super::slab::FAR_MARGIN;
use super::interval::{Interval, Planes};
use super::rays::{PacketRays, PerRay, groups};
use crate::math::Lanes;

/// What a packet has still to visit, the nearest last.
#[derive(Debug)]
pub(super) struct Pending {
    pub(super) references: Vec<u32>,
    /// Where each ray enters; infinite for those that do not.
    pub(super) near: Vec<PerRay>,
}

impl Pending {
    /// Room for a tree of `depth` wide nodes from the root to the deepest, both included.
    pub(super) fn new(depth: usize) -> Self {
        // One node leaves all but one of its children behind when the packet goes deeper; above them
        // one entry is written that may not be kept.
        let size = (WIDTH - 1) * depth + 2;
        Self {
            references: vec![0; size],
            near: vec![PerRay::splat(0.0); size],
        }
    }

    /// The rays that still want the entry at `top`, given the `limit` of each.
    #[inline(always)]
    pub(super) fn active<V: Lanes>(&self, limit: &PerRay, top: usize) -> u32 {
        let near = &self.near[top];
        let mut active = 0;
        for group in 0..groups::<V>() {
            // Equality stays in: a hit at the same parameter may have the smaller id.
            let wants = near.group::<V>(group).le(limit.group(group));
            active |= V::bits(wants) << (V::N * group);
        }
        active
    }

    /// Puts the children of `node` that some ray meets before its `limit`, of which `most` is the
    /// largest or more, at `top`, the nearest last, and names each to `found`. Returns the new top.
    #[inline(always)]
    pub(super) fn open<N: NodeTest, const SHARED: bool>(
        &mut self,
        mut top: usize,
        node: &WideNode,
        (rays, interval, (limit, most)): (&PacketRays, &Interval, (&PerRay, f32)),
        found: impl Fn(u32),
    ) -> usize {
        let mut planes: Planes = [[[0.0; WIDTH]; 2]; 3];
        let (near, met) = interval.enter::<N::Eight, SHARED>(node, rays.octant, most, &mut planes);
        let count = met.count_ones() as usize;
        let order = FAR_TO_NEAR[rays.octant as usize % 8][met as usize % (1 << WIDTH)];
        for &slot in &far_to_near(order, count, near)[..count] {
            let slot = slot as usize % WIDTH;
            let entry = &mut self.near[top];
            let mut any = 0;
            for group in 0..groups::<N::Rays>() {
                let limit = limit.group::<N::Rays>(group);
                let (near, meets) = enter::<N::Rays, SHARED>(rays, &planes, (slot, group), limit);
                any |= N::Rays::bits(meets);
                let nowhere = N::Rays::splat(f32::INFINITY);
                entry.set_group(group, N::Rays::select(meets, near, nowhere));
            }
            self.references[top] = node.children[slot];
            found(node.children[slot]);
            top += usize::from(any != 0);
        }
        top
    }
}

/// The first `count` slots of `order` by falling `near`; at equal ones as they are.
#[inline(always)]
fn far_to_near<V: Lanes>(order: u64, count: usize, near: V) -> [u8; WIDTH] {
    let mut distance = [0.0; WIDTH];
    near.store(&mut distance);
    let mut order = order.to_le_bytes();
    let at = |slot: u8| distance[slot as usize % WIDTH];
    for i in 1..count {
        let slot = order[i % WIDTH];
        let mut to = i;
        while to > 0 && at(order[(to - 1) % WIDTH]) < at(slot) {
            order[to % WIDTH] = order[(to - 1) % WIDTH];
            to -= 1;
        }
        order[to % WIDTH] = slot;
    }
    order
}

/// [`super::super::SlabRay::enter`] for the child in a slot and the rays of a group.
#[inline(always)]
fn enter<V: Lanes, const SHARED: bool>(
    rays: &PacketRays,
    planes: &Planes,
    (slot, group): (usize, usize),
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
    (near, near.le(far * V::splat(FAR_MARGIN)))
}
