//! Direct light at a vertex, in double precision.

use glam::DVec3;

use super::path::{Path, Vertex};
use super::surface::{Surface, off_surface};
use super::trace::{Ray, closest, is_occluded};
use super::{bsdf, environment, guided, light, light_choice, warp};
use crate::integrator::PathTracer;
use crate::integrator::direct::{DirectSample, light_numbers};
use crate::light::Light;
use crate::sampling::Slot;

/// Shadow rays end this share of the way to the light. In single precision they end earlier
/// ([`crate::math::SHADOW_T_MAX`]) and miss what lies within 2⁻¹⁶ of the way before it.
const SHADOW_END: f64 = 1.0 - 1e-12;

/// The light that arrives at `vertex` straight from lights, times the throughput: the sum of the
/// samples of the plan.
pub(super) fn direct_light(tracer: &PathTracer<'_>, path: &Path, vertex: &Vertex<'_>) -> DVec3 {
    let scene = tracer.scene;
    let from = (vertex.surface.point, vertex.lit_normal());
    let samples = tracer.plan.samples.iter().zip(0..);
    let sum = samples.map(|(sample, number)| match *sample {
        DirectSample::Light { light, weight } => {
            let (_, (u_part, u)) = light_numbers(path.sampler, path.bounce, number);
            let light = scene.light(light);
            let sample = light::sample(light, scene.shapes(), from, u_part, u);
            lit_by(tracer, path, vertex, sample) * f64::from(weight)
        }
        DirectSample::AnyLight { weight } => {
            let sample = any_light(tracer, path, vertex, number);
            lit_by(tracer, path, vertex, sample) * f64::from(weight)
        }
        DirectSample::Hemisphere { weight } => {
            from_hemisphere(tracer, path, vertex, number) * f64::from(weight)
        }
    });
    path.throughput * sum.sum::<DVec3>()
}

/// A direction to the part of a light that is chosen for the vertex; its density counts the choice.
fn any_light(
    tracer: &PathTracer<'_>,
    path: &Path,
    vertex: &Vertex<'_>,
    number: u32,
) -> Option<light::LightSample> {
    let scene = tracer.scene;
    let (u, numbers) = light_numbers(path.sampler, path.bounce, number);
    let place = (vertex.surface.point, vertex.lit_normal());
    let (index, part, pmf) = light_choice::choose(scene.light_sampler(), place, u)?;
    let sample = light::sample_part(scene.light(index), scene.shapes(), part, place, numbers)?;
    Some(light::LightSample {
        pdf: pmf * sample.pdf,
        ..sample
    })
}

/// What `sample` sends through the vertex.
fn lit_by(
    tracer: &PathTracer<'_>,
    path: &Path,
    vertex: &Vertex<'_>,
    sample: Option<light::LightSample>,
) -> DVec3 {
    let scene = tracer.scene;
    let shares = tracer.shares_emission(vertex.bsdf);
    let Some(sample) = sample else {
        return DVec3::ZERO;
    };
    let Some(wi) = vertex.local(sample.wi) else {
        return DVec3::ZERO;
    };
    let (value, scatter_pdf) = bsdf::eval_and_pdf(vertex.bsdf, vertex.wo, wi);
    let mut light = value * wi.z.abs() * sample.radiance / sample.pdf;
    if shares && !sample.is_delta {
        let n = f64::from(tracer.settings.light_samples);
        let scatter_pdf = match guided::lobes_at(tracer, path.bounce, vertex) {
            Some(lobes) => guided::mixture(lobes, vertex, scatter_pdf, sample.wi),
            None => scatter_pdf,
        };
        light *= warp::power_heuristic(n * sample.pdf, scatter_pdf);
    }
    let origin = vertex.surface.leave(sample.wi);
    let shadow_ray = match sample.end {
        Some((point, normal)) => Ray {
            origin,
            direction: off_surface(point, normal, -sample.wi) - origin,
            t_max: SHADOW_END,
        },
        None => Ray {
            origin,
            direction: sample.wi,
            t_max: f64::INFINITY,
        },
    };
    if light == DVec3::ZERO || is_occluded(scene, &shadow_ray) {
        DVec3::ZERO
    } else {
        light
    }
}

/// What an even direction of the hemisphere meets, through the vertex.
fn from_hemisphere(
    tracer: &PathTracer<'_>,
    path: &Path,
    vertex: &Vertex<'_>,
    number: u32,
) -> DVec3 {
    let u = path.sampler.get_2d(path.bounce, Slot::Hemisphere(number));
    let up = warp::hemisphere(u.as_dvec2());
    let wi = DVec3::new(up.x, up.y, up.z.copysign(vertex.wo.z));
    let direction = vertex.frame.to_world(wi).normalize();
    if vertex.local(direction).is_none() {
        return DVec3::ZERO;
    }
    let ray = Ray {
        origin: vertex.surface.leave(direction),
        direction,
        t_max: f64::INFINITY,
    };
    let (value, _) = bsdf::eval_and_pdf(vertex.bsdf, vertex.wo, wi);
    value * wi.z.abs() / warp::HEMISPHERE_PDF * gathered(tracer, &ray)
}

/// Emission that `ray` meets.
fn gathered(tracer: &PathTracer<'_>, ray: &Ray) -> DVec3 {
    let scene = tracer.scene;
    match closest(scene, ray) {
        Some(hit) => {
            let surface = Surface::new(scene, ray, &hit);
            scene.light_of(hit.primitive).map_or(DVec3::ZERO, |index| {
                light::emitted(scene.light(index), surface.geometric_normal, ray.direction)
            })
        }
        // The course's directions meet surfaces only.
        None if scene.is_course_compatible() => DVec3::ZERO,
        None => match scene.environment_light().map(|index| scene.light(index)) {
            Some(Light::Environment(sky)) => environment::radiance(sky, ray.direction, false),
            _ => DVec3::ZERO,
        },
    }
}
