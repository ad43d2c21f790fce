use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use super::super::path::{MIN_SURVIVAL, SURVIVAL_OF_THROUGHPUT, TRAPPED_AFTER, TRAPPED_SURVIVAL};
use super::paths::{NONE, PathState};
use super::shade::{Group, Shade};
use crate::math::{Lanes, ROW, Ray, Vec3Lanes, offset_origin_lanes, set_bits};
use crate::sampling::{PathSamplerLanes, Slot, cosine_hemisphere_lanes};

impl Shade<'_, '_> {
    /// Sends the paths of a group on, as [`super::PathTracer::scatter`] does from diffuse surfaces.
    #[inline(always)]
    ///
    /// Those of `receivers` are sure to go on.
    pub(super) fn scatter<L: Lanes>(&mut self, group: &Group<'_, L>, receivers: u32) {
        let shares_emission = self.tracer.shares_diffuse_emission();
        if self.bounce + 1 >= self.tracer.settings.max_depth.0 && !shares_emission {
            return;
        }
        let sampler = if self.bounce == 0 && self.reuse.is_on() {
            PathSamplerLanes::new(self.samplers_from(group.first), 0, Slot::Scatter)
        } else {
            group.sampler
        };
        let u = sampler.get_2d(self.bounce, Slot::Scatter);
        let mut local = cosine_hemisphere_lanes(u);
        let zero = L::splat(0.0);
        local.z = L::select(group.wo_z.lt(zero), local.z.neg(), local.z);
        let (mut z, mut towards) = (local.z, group.frame.to_world(local));
        if let Some(guided) = &group.guided {
            let [u_lobe, _] = sampler.get_2d(self.bounce, Slot::Lobe);
            (z, towards) = guided.aim(group, u_lobe, u, (z, towards));
        }
        let size = z.abs();
        let cosine = size * L::splat(FRAC_1_PI);
        let direction = towards.normalize_or(Vec3Lanes::splat(Vec3::ZERO));
        let pdf = match &group.guided {
            Some(_) => group.scatter_pdf(cosine, &direction.store()),
            None => cosine,
        };
        let normal = group.surface.geometric_normal;
        let mut alive =
            group.is_same_side(z) & cosine.gt(zero) & (direction.dot(normal) * z).gt(zero);
        let value = group.surface.reflectance.scale(L::splat(FRAC_1_PI));
        let mut throughput = group.throughput * value.scale(size / pdf);
        alive = alive & throughput.max_element().gt(zero);
        if self.bounce >= 1 {
            let most = if self.bounce + 1 < TRAPPED_AFTER {
                1.0
            } else {
                TRAPPED_SURVIVAL
            };
            let kept = match &group.guided {
                Some(_) => group.throughput * value.scale(size / cosine),
                None => throughput,
            };
            let wanted = L::splat(SURVIVAL_OF_THROUGHPUT) * kept.max_element();
            let survival = wanted.max(L::splat(MIN_SURVIVAL)).min(L::splat(most));
            let sure = L::mask_of_bits(receivers);
            let survival = L::select(sure, L::splat(1.0), survival);
            let at_risk = L::bits(alive & survival.lt(L::splat(1.0))) & group.lanes;
            // Whoever is sure to live needs no number, and is divided by 1.
            if at_risk != 0 {
                let [u, _] = sampler.get_2d(self.bounce, Slot::Roulette);
                alive = alive & u.lt(survival);
                throughput = Vec3Lanes::new(
                    throughput.x / survival,
                    throughput.y / survival,
                    throughput.z / survival,
                );
            }
        }
        let origin = offset_origin_lanes(
            group.surface.departure,
            group.surface.error,
            normal,
            direction,
        );
        let bits = L::bits(alive) & group.lanes;
        if group.guided.is_some() {
            self.aim(group.first, receivers & bits, &(cosine / pdf).to_array());
        }
        let nowhere = Vec3Lanes::splat(Vec3::ZERO);
        let (from, side) = if shares_emission {
            (group.surface.point, group.lit_normal())
        } else {
            (nowhere, nowhere)
        };
        let pdf = if shares_emission { pdf } else { L::splat(NONE) };
        self.go_on(
            group,
            bits,
            [origin, direction, throughput, from, side],
            pdf,
        );
    }

    /// Takes note of the scales with which those of `lanes` leave their receivers.
    fn aim(&mut self, first: usize, lanes: u32, scales: &[f32; ROW]) {
        for lane in set_bits(lanes) {
            let id = self.paths.states[first + lane].id;
            self.reuse.aim(id, scales[lane]);
        }
    }

    #[inline(always)]
    fn go_on<L: Lanes>(
        &mut self,
        group: &Group<'_, L>,
        lanes: u32,
        [origin, direction, throughput, from, side]: [Vec3Lanes<L>; 5],
        pdf: L,
    ) {
        let ends = [L::splat(0.0), L::splat(f32::INFINITY)];
        let rays = rays(origin, direction, ends);
        let (throughput, pdf) = (throughput.store(), pdf.to_array());
        let (from, side) = (from.store(), side.store());
        for lane in set_bits(lanes) {
            self.next.rays.push(rays[lane]);
            self.next.states.push(PathState {
                throughput: throughput.get(lane),
                id: self.paths.states[group.first + lane].id,
                tally: group.tallies[lane],
                from: from.get(lane),
                normal: side.get(lane),
                scatter_pdf: pdf[lane],
            });
        }
    }
}

/// Rays of all lanes.
#[inline(always)]
pub(super) fn rays<L: Lanes>(
    origin: Vec3Lanes<L>,
    direction: Vec3Lanes<L>,
    [t_min, t_max]: [L; 2],
) -> [Ray; ROW] {
    let (o, d) = (origin, direction);
    let mut rays = [Ray::new(Vec3::ZERO, Vec3::ZERO); ROW];
    L::to_rays([o.x, o.y, o.z, d.x, d.y, d.z, t_min, t_max], &mut rays);
    rays
}
