use std::ops::Range;

use super::super::super::reuse::MAX_CLUSTER;
use super::super::scatter::rays;
use super::Reuse;
use super::rows::{ReceiverLanes, SharedLanes};
use crate::color::Rgb;
use crate::math::{
    LaneKernel, Lanes, ROW, Ray, SHADOW_T_MAX, Vec3Array, Vec3Lanes, offset_origin_lanes, set_bits,
};

/// How likely the receivers of each cluster of `rows` are to reach the shared vertices, and the rays
/// that have to be traced to know whether they do.
pub(super) struct Reach<'a> {
    pub(super) reuse: &'a mut Reuse,
    /// By path, what leaves its shared vertex.
    pub(super) lent: &'a [Rgb],
    pub(super) rows: Range<usize>,
}

/// Adds what receivers take in, when the reach of those that see nothing is 0.
pub(super) struct TakeIn<'a> {
    pub(super) reuse: &'a Reuse,
    pub(super) lent: &'a [Rgb],
    pub(super) own: &'a mut [Rgb],
    pub(super) rows: Range<usize>,
}

impl Reuse {
    /// The lanes of member `member` in `row` whose shared vertices send light.
    #[inline(always)]
    fn lenders(&self, member: usize, row: usize, lent: &[Rgb]) -> u32 {
        let all = self.shared[member * self.rows + row].lanes;
        let mut lanes = all;
        for lane in set_bits(all) {
            if lent[self.path(member, row, lane)] == Rgb::ZERO && self.furnace.is_none() {
                lanes &= !(1 << lane);
            }
        }
        lanes
    }

    /// The number of the path that is `member` of the cluster in `lane` of `row`.
    #[inline(always)]
    fn path(&self, member: usize, row: usize, lane: usize) -> usize {
        (row * self.width + lane) * self.members + member
    }
}

impl LaneKernel for Reach<'_> {
    type Answer = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { reuse, lent, rows } = self;
        let first = rows.start;
        for row in rows {
            for lender in 0..reuse.members {
                let lanes = reuse.lenders(lender, row, lent);
                reuse.reach_from::<L>((row, row - first), lender, lanes);
            }
        }
    }
}

impl Reuse {
    /// How likely the receivers of the clusters of `row`, number `part` of those that are asked for, are
    /// to reach the shared vertices of member `lender` in `lanes`; queues rays to those of others.
    #[inline(always)]
    fn reach_from<L: Lanes>(&mut self, (row, part): (usize, usize), lender: usize, lanes: u32) {
        let (members, count) = (self.members, self.rows);
        let start = (part * members + lender) * members;
        if lanes == 0 {
            self.reach[start..start + members].fill([0.0; ROW]);
            return;
        }
        let zero = L::splat(0.0);
        let shared = self.shared[lender * count + row].load::<L>();
        let own = reach(&self.receivers[lender * count + row].load(), &shared);
        let lends = L::mask_of_bits(lanes);
        let for_all = own.gt(zero) & lends;
        // What is not for all is for the lender alone.
        let own = L::select(for_all, own, L::select(lends, L::splat(1.0), zero));
        for member in 0..members {
            let at = start + member;
            if member == lender {
                own.store_row(&mut self.reach[at]);
                continue;
            }
            let receiver = self.receivers[member * count + row].load::<L>();
            let alike = L::ints_eq(receiver.bounce, shared.bounce) & for_all;
            let reach = L::select(alike, reach(&receiver, &shared), zero);
            reach.store_row(&mut self.reach[at]);
            let bits = L::bits(reach.gt(zero));
            if bits == 0 {
                continue;
            }
            let rays = rays_to(&receiver, &shared);
            for lane in set_bits(bits) {
                self.rays.push(rays[lane]);
                self.asked.push((at as u32, lane as u32));
            }
        }
    }
}

/// As of [`super::super::super::reuse::Receiver`].
#[inline(always)]
fn reach<L: Lanes>(receiver: &ReceiverLanes<L>, shared: &SharedLanes<L>) -> L {
    let zero = L::splat(0.0);
    let infinite = L::mask_of_bits(shared.infinite);
    let way = way(receiver, shared);
    let cosine = receiver.shading_normal.dot(way);
    let leaves = cosine.gt(zero) & receiver.geometric_normal.dot(way).gt(zero);
    let there = shared.shading_normal.dot(way).neg();
    let arrives = there.gt(zero) & shared.geometric_normal.dot(way).neg().gt(zero);
    let squared = way.length_squared();
    let reach = cosine * there / (squared * squared);
    let works = arrives & reach.lt(L::splat(f32::INFINITY));
    let reach = L::select(infinite, cosine, L::select(works, reach, zero));
    L::select(leaves, reach, zero)
}

/// From the receivers to the shared vertices, or the directions of the sky.
#[inline(always)]
fn way<L: Lanes>(receiver: &ReceiverLanes<L>, shared: &SharedLanes<L>) -> Vec3Lanes<L> {
    let infinite = L::mask_of_bits(shared.infinite);
    Vec3Lanes::select(infinite, shared.place, shared.place - receiver.point)
}

#[inline(always)]
fn rays_to<L: Lanes>(receiver: &ReceiverLanes<L>, shared: &SharedLanes<L>) -> [Ray; ROW] {
    let infinite = L::mask_of_bits(shared.infinite);
    let way = way(receiver, shared);
    let normal = receiver.geometric_normal;
    let origin = offset_origin_lanes(receiver.departure, receiver.error, normal, way);
    let target = offset_origin_lanes(shared.place, shared.error, shared.geometric_normal, -way);
    let direction = Vec3Lanes::select(infinite, shared.place, target - origin);
    let t_max = L::select(infinite, L::splat(f32::INFINITY), L::splat(SHADOW_T_MAX));
    rays(origin, direction, [L::splat(0.0), t_max])
}

impl LaneKernel for TakeIn<'_> {
    type Answer = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self {
            reuse,
            lent,
            own,
            rows,
        } = self;
        let first = rows.start;
        for row in rows {
            take_in::<L>(reuse, (row, row - first), lent, own);
        }
    }
}

/// What the clusters of `row` take in; it is number `part` of those whose reach is at hand.
#[inline(always)]
fn take_in<L: Lanes>(reuse: &Reuse, (row, part): (usize, usize), lent: &[Rgb], own: &mut [Rgb]) {
    let (members, zero) = (reuse.members, L::splat(0.0));
    let clusters = (own.len() / members - row * L::N).min(L::N);
    let mut sums = [Vec3Array::ZERO; MAX_CLUSTER];
    for (member, sums) in sums.iter_mut().enumerate().take(members) {
        for lane in 0..clusters {
            sums.set(lane, own[reuse.path(member, row, lane)]);
        }
    }
    let mut weights = [[0.0; ROW]; MAX_CLUSTER];
    for lender in 0..members {
        let start = (part * members + lender) * members;
        let reach = &reuse.reach[start..start + members];
        if L::bits(L::load_row(&reach[lender]).gt(zero)) == 0 {
            continue;
        }
        let all = (reach.iter()).fold(zero, |all, reach| all + L::load_row(reach));
        let share = L::splat(1.0) / all;
        let mut light = Vec3Array::ZERO;
        for lane in 0..clusters {
            light.set(lane, lent[reuse.path(lender, row, lane)]);
        }
        let light = Vec3Lanes::<L>::load(&light);
        for (member, sums) in sums.iter_mut().enumerate().take(members) {
            let reach = L::load_row(&reach[member]);
            let factor = reuse.receivers[member * reuse.rows + row].factor::<L>();
            let before = Vec3Lanes::load(sums);
            let after = before + (factor * light).scale(reach * share);
            *sums = Vec3Lanes::select(reach.gt(zero), after, before).store();
            if reuse.furnace.is_some() {
                let weight = L::select(reach.gt(zero), reach * share, zero);
                (L::load_row(&weights[member]) + weight).store_row(&mut weights[member]);
            }
        }
    }
    if let Some(sky) = reuse.furnace {
        correct::<L>(reuse, (row, sky), &weights, &mut sums);
    }
    for (member, sums) in sums.iter().enumerate().take(members) {
        for lane in 0..clusters {
            own[reuse.path(member, row, lane)] = sums.get(lane);
        }
    }
}

/// Corrects what the clusters of `row` have taken in by what the `weights` of that fall short of 1
/// ([`super::super::super::furnace`]).
#[inline(always)]
fn correct<L: Lanes>(
    reuse: &Reuse,
    (row, sky): (usize, Rgb),
    weights: &[[f32; ROW]; MAX_CLUSTER],
    sums: &mut [Vec3Array; MAX_CLUSTER],
) {
    let (zero, one) = (L::splat(0.0), L::splat(1.0));
    let openness = L::load_row(&reuse.openness[row]);
    let sky = Vec3Lanes::<L>::splat(sky);
    for member in 0..reuse.members {
        let at = member * reuse.rows + row;
        let shares = L::mask_of_bits(reuse.shared[at].lanes & L::ALL);
        let own = L::select(shares, zero, one);
        let missing = one - (L::load_row(&weights[member]) + own);
        let factor = reuse.receivers[at].factor::<L>();
        let before = Vec3Lanes::load(&sums[member]);
        let after = before + (factor * sky).scale(openness * missing);
        let receives = L::mask_of_bits(reuse.receivers[at].lanes::<L>());
        sums[member] = Vec3Lanes::select(receives, after, before).store();
    }
}
