use std::f32::consts::FRAC_1_PI;

use super::scatter::rays;
use super::shade::{Group, Shade};
use crate::light::{
    ContextLanes, LightSample, LightSampleContext, LightSampleLanes, ParallelogramLight,
};
use crate::math::{
    Lanes, ROW, SHADOW_T_MAX, Vec3Array, Vec3Lanes, gamma, offset_origin_lanes, set_bits,
};
use crate::sampling::Slot;

/// A light sample for each of eight vertices.
#[derive(Debug)]
pub(super) struct LightSamples {
    /// A bit for each lane that has one.
    lanes: u32,
    /// Of those the ones from infinity.
    infinite: u32,
    /// Those that no scattered ray finds.
    delta: u32,
    wi: Vec3Array,
    radiance: Vec3Array,
    point: Vec3Array,
    normal: Vec3Array,
    pdf: [f32; ROW],
    /// Weight over density.
    factor: [f32; ROW],
}

impl LightSamples {
    const NONE: Self = Self {
        lanes: 0,
        infinite: 0,
        delta: 0,
        wi: Vec3Array::ZERO,
        radiance: Vec3Array::ZERO,
        point: Vec3Array::ZERO,
        normal: Vec3Array::ZERO,
        pdf: [1.0; ROW],
        factor: [0.0; ROW],
    };

    /// The samples of one light that are there, of those `lanes`.
    #[inline(always)]
    fn set_all<L: Lanes>(
        &mut self,
        lanes: u32,
        light: &ParallelogramLight<'_>,
        found: &LightSampleLanes<L>,
        weight: f32,
    ) {
        self.lanes = L::bits(found.is_there) & lanes;
        self.wi = found.wi.store();
        self.point = found.point.store();
        self.radiance = Vec3Lanes::<L>::splat(light.radiance()).store();
        self.normal = Vec3Lanes::<L>::splat(light.normal()).store();
        found.pdf.store_row(&mut self.pdf);
        (L::splat(weight) / found.pdf).store_row(&mut self.factor);
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, sample: &LightSample, weight: f32) {
        let bit = 1 << lane;
        self.lanes |= bit;
        if !sample.distance.is_finite() {
            self.infinite |= bit;
        }
        if sample.is_delta {
            self.delta |= bit;
        }
        self.wi.set(lane, sample.wi);
        self.radiance.set(lane, sample.radiance);
        self.point.set(lane, sample.point);
        self.normal.set(lane, sample.normal);
        self.pdf[lane] = sample.pdf;
        self.factor[lane] = weight / sample.pdf;
    }
}

impl Shade<'_, '_> {
    /// Queues the rays of direct light of a group.
    #[inline(always)]
    pub(super) fn direct_light<L: Lanes>(&mut self, group: &Group<'_, L>) {
        if !self.tracer.counts_depth(self.bounce + 1) {
            return;
        }
        if self.tracer.plan.samples_hemisphere() {
            return self.direct_light_one_by_one(group, &group.surface.store());
        }
        let from = ContextLanes {
            point: group.surface.point,
            normal: group.lit_normal(),
        };
        for number in 0..self.tracer.plan.len() as u32 {
            let mut samples = LightSamples::NONE;
            if let Some((light, weight)) = &self.tracer.only_parallelogram {
                let u = (group.sampler).get_2d(self.bounce, Slot::LightPoint(number));
                samples.set_all(group.lanes, light, &light.sample(&from, u), *weight);
            } else {
                let places = (&from.point.store(), &from.normal.store());
                self.sample_one_by_one(&mut samples, group.first, group.lanes, places, number);
            }
            let made = if samples.lanes == 0 {
                0
            } else {
                self.shadow_rays(group, &samples)
            };
            self.counts.culled_shadow_rays += u64::from(group.lanes.count_ones() - made);
        }
    }

    /// Light samples of those of the eight that are in `lanes`.
    fn sample_one_by_one(
        &self,
        samples: &mut LightSamples,
        first: usize,
        lanes: u32,
        (points, normals): (&Vec3Array, &Vec3Array),
        number: u32,
    ) {
        for lane in set_bits(lanes) {
            let id = self.paths.states[first + lane].id as usize;
            let from = LightSampleContext {
                point: points.get(lane),
                normal: normals.get(lane),
            };
            let numbers = (self.samplers[id], self.bounce);
            if let Some((sample, weight)) = self.tracer.light_sample(numbers, &from, number) {
                samples.set(lane, &sample, weight);
            }
        }
    }

    /// Queues shadow rays as [`super::PathTracer::shadow_ray`] makes them; returns their number.
    #[inline(always)]
    fn shadow_rays<L: Lanes>(&mut self, group: &Group<'_, L>, samples: &LightSamples) -> u32 {
        let surface = &group.surface;
        let zero = L::splat(0.0);
        let wi = Vec3Lanes::<L>::load(&samples.wi);
        let z = surface.shading_normal.dot(wi);
        let normal = surface.geometric_normal;
        let is_lit = (z * wi.dot(normal)).gt(zero) & group.is_same_side(z);
        let bits = L::bits(is_lit) & samples.lanes;
        if bits == 0 {
            return 0;
        }
        let scattered = (surface.reflectance.scale(L::splat(FRAC_1_PI))).scale(z.abs());
        let mut contribution = (group.throughput * scattered * Vec3Lanes::load(&samples.radiance))
            .scale(L::load_row(&samples.factor));
        let black = contribution.x.eq(zero) & contribution.y.eq(zero) & contribution.z.eq(zero);
        let bits = bits & !L::bits(black);
        if self.tracer.shares_diffuse_emission() {
            let n = L::splat(self.tracer.settings.light_samples as f32);
            let scatter_pdf = group.scatter_pdf(z.abs() * L::splat(FRAC_1_PI), &samples.wi);
            let share = power_heuristic(n * L::load_row(&samples.pdf), scatter_pdf);
            let shared = contribution.scale(share);
            let is_delta = L::mask_of_bits(samples.delta);
            contribution = Vec3Lanes::select(is_delta, contribution, shared);
        }
        let origin = offset_origin_lanes(surface.departure, surface.error, normal, wi);
        let point = Vec3Lanes::load(&samples.point);
        let error = point.abs().scale(L::splat(gamma(8)));
        let target = offset_origin_lanes(point, error, Vec3Lanes::load(&samples.normal), -wi);
        let segment = target - origin;
        let infinite = L::mask_of_bits(samples.infinite);
        let direction = Vec3Lanes::select(infinite, wi, segment);
        let t_max = L::select(infinite, L::splat(f32::INFINITY), L::splat(SHADOW_T_MAX));
        let rays = rays(origin, direction, [zero, t_max]);
        let contribution = contribution.store();
        for lane in set_bits(bits) {
            let tally = group.tallies[lane];
            (self.direct).push_shadow(tally, rays[lane], contribution.get(lane));
        }
        bits.count_ones()
    }
}

/// As [`crate::sampling::power_heuristic`] for a finite `pdf_a` above 0.
#[inline(always)]
fn power_heuristic<L: Lanes>(pdf_a: L, pdf_b: L) -> L {
    let ratio = pdf_b / pdf_a;
    L::splat(1.0) / (L::splat(1.0) + ratio * ratio)
}
