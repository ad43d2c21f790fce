//! Direct light at a vertex: which samples are taken, and the rays they ask for.

use glam::Vec2;

use super::path::{Path, Vertex};
use super::{PathSettings, PathTracer};
use crate::color::Rgb;
use crate::geometry::Hit;
use crate::light::{LightSample, LightSampleContext};
use crate::math::{Ray, SHADOW_T_MAX, gamma, offset_origin};
use crate::sampling::{
    PathSampler, Slot, UNIFORM_HEMISPHERE_PDF, power_heuristic, uniform_hemisphere,
};
use crate::scene::PreparedScene;
use crate::settings::Mode;

/// So many lights without extent are all sampled at every vertex: what they send has no noise, while
/// choosing one of them has.
const FEW: usize = 8;

/// One direct light sample of a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum DirectSample {
    /// Light `light` of the scene, weighted 1 / (samples of this light).
    Light { light: u32, weight: f32 },
    /// A part of a light chosen for the vertex, shared with the scattered ray by multiple importance.
    AnyLight { weight: f32 },
    /// A uniform direction of the hemisphere; what it meets is taken as it is.
    Hemisphere { weight: f32 },
}

/// The direct light samples that every vertex takes, in order. The number of a sample in the plan
/// is its random number slot.
#[derive(Clone, Debug, PartialEq)]
pub struct DirectPlan {
    pub(super) samples: Vec<DirectSample>,
}

impl DirectPlan {
    /// The plan of `settings` for `scene`: empty when nothing can be sampled.
    pub fn new(scene: &PreparedScene, settings: &PathSettings) -> Self {
        let n = settings.light_samples;
        let lights = scene.sampled_lights();
        let per_light = |light: u32| {
            let count = if scene.light(light).is_delta() { 1 } else { n };
            std::iter::repeat_n(
                DirectSample::Light {
                    light,
                    weight: 1.0 / count as f32,
                },
                count as usize,
            )
        };
        let samples = match settings.mode {
            _ if settings.max_depth.0 == 0 => Vec::new(),
            Mode::Importance => lights.iter().copied().flat_map(per_light).collect(),
            Mode::Best
                if scene.is_course_compatible()
                    || (lights.len() <= FEW
                        && lights.iter().all(|&light| scene.light(light).is_delta())) =>
            {
                lights.iter().copied().flat_map(per_light).collect()
            }
            Mode::Best if scene.light_sampler().is_empty() => Vec::new(),
            Mode::Best => vec![
                DirectSample::AnyLight {
                    weight: 1.0 / n as f32
                };
                n as usize
            ],
            Mode::Hemisphere => {
                let count = scene.hemisphere_light_count() * n;
                let mut samples = vec![
                    DirectSample::Hemisphere {
                        weight: 1.0 / count as f32
                    };
                    count as usize
                ];
                if !scene.is_course_compatible() {
                    let delta = lights
                        .iter()
                        .copied()
                        .filter(|&light| scene.light(light).is_delta());
                    samples.extend(delta.map(|light| DirectSample::Light { light, weight: 1.0 }));
                }
                samples
            }
        };
        Self { samples }
    }

    /// Number of direct light samples a vertex.
    pub fn len(&self) -> usize {
        self.samples.len()
    }

    /// The light that every sample goes to, if there is only one, and the weight of each sample.
    pub(super) fn only_light(&self, scene: &PreparedScene) -> Option<(u32, f32)> {
        let first = self.samples.first()?;
        match *first {
            DirectSample::AnyLight { weight } => {
                Some((scene.light_sampler().only_light()?, weight))
            }
            DirectSample::Light { light, weight } => {
                let is_same = |sample: &DirectSample| sample == first;
                self.samples.iter().all(is_same).then_some((light, weight))
            }
            DirectSample::Hemisphere { .. } => None,
        }
    }

    /// True when some samples are directions of the hemisphere.
    pub(super) fn samples_hemisphere(&self) -> bool {
        matches!(self.samples.first(), Some(DirectSample::Hemisphere { .. }))
    }

    /// True when a vertex takes none.
    pub fn is_empty(&self) -> bool {
        self.samples.is_empty()
    }
}

/// A ray that carries direct light to a vertex.
#[derive(Clone, Copy, Debug)]
pub(super) enum DirectRay {
    /// Adds `contribution` to the path's radiance when nothing lies on the ray.
    Shadow { ray: Ray, contribution: Rgb },
    /// Adds what the ray meets, times `factor`.
    Gather { ray: Ray, factor: Rgb },
}

/// What chooses a light, and what chooses inside it and the place there, for light sample `number` at
/// a vertex.
pub(super) fn light_numbers(sampler: PathSampler, bounce: u32, number: u32) -> (f32, (f32, Vec2)) {
    let choice = sampler.get_2d(bounce, Slot::LightChoice(number));
    let place = sampler.get_2d(bounce, Slot::LightPoint(number));
    (choice.x, (choice.y, place))
}

impl PathTracer<'_> {
    /// True when direct light at the vertex that `path` has reached is part of the picture.
    pub(super) fn wants_direct(&self, path: &Path, vertex: &Vertex<'_>) -> bool {
        !vertex.bsdf.is_delta() && self.counts_depth(path.bounce + 1)
    }

    /// The ray of direct light sample `number` of the plan; `None` when it would carry nothing.
    pub(super) fn direct_ray(
        &self,
        path: &Path,
        vertex: &Vertex<'_>,
        number: u32,
    ) -> Option<DirectRay> {
        match self.plan.samples[number as usize] {
            DirectSample::Light { .. } | DirectSample::AnyLight { .. } => {
                let from = LightSampleContext {
                    point: vertex.surface.point,
                    normal: vertex.lit_normal(),
                };
                let (sample, weight) =
                    self.light_sample((path.sampler, path.bounce), &from, number)?;
                self.shadow_ray(path, vertex, &sample, weight)
            }
            DirectSample::Hemisphere { weight } => {
                let mut local =
                    uniform_hemisphere(path.sampler.get_2d(path.bounce, Slot::Hemisphere(number)));
                if vertex.wo.z < 0.0 {
                    local.z = -local.z;
                }
                let wi = vertex.frame.to_world(local).normalize_or_zero();
                let local = vertex.local(wi)?;
                let scattered = vertex.bsdf.eval(vertex.wo, local) * local.z.abs();
                let factor = path.throughput * scattered * (weight / UNIFORM_HEMISPHERE_PDF);
                (factor != Rgb::ZERO).then(|| DirectRay::Gather {
                    ray: Ray::new(vertex.origin(wi), wi),
                    factor,
                })
            }
        }
    }

    /// Light sample `number` of the plan for a surface, and its weight; its density counts the choice
    /// of its light. `None` for a sample of the hemisphere and where the light sends nothing.
    pub(super) fn light_sample(
        &self,
        (sampler, bounce): (PathSampler, u32),
        from: &LightSampleContext,
        number: u32,
    ) -> Option<(LightSample, f32)> {
        let shapes = self.scene.shapes();
        let (u, numbers) = light_numbers(sampler, bounce, number);
        match self.plan.samples[number as usize] {
            DirectSample::Hemisphere { .. } => None,
            DirectSample::Light { light, weight } => {
                let light = self.scene.light(light);
                Some((light.sample(shapes, from, numbers.0, numbers.1)?, weight))
            }
            DirectSample::AnyLight { weight } => {
                let choice = self
                    .scene
                    .light_sampler()
                    .sample(from.point, from.normal, u)?;
                let (light, part) = (self.scene.light(choice.light), choice.part as usize);
                let sample = light.sample_part(shapes, part, from, numbers)?;
                let pdf = choice.pmf * sample.pdf;
                (pdf > 0.0).then_some((LightSample { pdf, ..sample }, weight))
            }
        }
    }

    /// The shadow ray to `sample`, whose density counts the choice of its light.
    fn shadow_ray(
        &self,
        path: &Path,
        vertex: &Vertex<'_>,
        sample: &LightSample,
        weight: f32,
    ) -> Option<DirectRay> {
        let shares = self.shares_emission(vertex.bsdf);
        let local = vertex.local(sample.wi)?;
        let scattered = vertex.bsdf.eval(vertex.wo, local) * local.z.abs();
        let mut contribution =
            path.throughput * scattered * sample.radiance * (weight / sample.pdf);
        if contribution == Rgb::ZERO {
            return None;
        }
        if shares && !sample.is_delta {
            let n = self.settings.light_samples as f32;
            let scatter_pdf = self.scatter_pdf(path.bounce, vertex, (sample.wi, local));
            contribution *= power_heuristic(n * sample.pdf, scatter_pdf);
        }
        let origin = vertex.origin(sample.wi);
        let ray = if sample.distance.is_finite() {
            let error = gamma(8) * sample.point.abs();
            let target = offset_origin(sample.point, error, sample.normal, -sample.wi);
            Ray::segment(origin, target - origin, SHADOW_T_MAX)
        } else {
            Ray::new(origin, sample.wi)
        };
        Some(DirectRay::Shadow { ray, contribution })
    }

    /// What a gathering ray brings back.
    pub(super) fn gathered(&self, ray: &Ray, hit: &Hit) -> Rgb {
        if hit.is_miss() {
            // The course's directions meet surfaces only.
            if self.scene.is_course_compatible() {
                return Rgb::ZERO;
            }
            return self.scene.environment_radiance(ray.direction, false);
        }
        self.scene
            .emitted(&self.scene.interaction(ray, hit), -ray.direction)
    }
}
