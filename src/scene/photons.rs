//! Light paths through mirrors and glass, for the guide of a scene.

use std::ops::ControlFlow;

use glam::{Vec2, Vec3};

use super::specular::specular_bounds;
use super::{PrepareProgress, PreparedScene};
use crate::bsdf::BsdfSample;
use crate::geometry::{Hit, Sphere, TraceCounts};
use crate::guide::{Cone, Guide, Photon};
use crate::light::Light;
use crate::math::{Frame, Ray, gamma, offset_origin};
use crate::sampling::{Distribution1d, ONE_MINUS_EPSILON, PathSampler, Slot};

/// Light paths. Half as many give a tenth more noise, twice as many a tenth less.
const PATHS: u32 = 32_768;
/// Those that are traced together.
const BATCH: u32 = 4096;
/// Mirrors and glass that a path may meet.
const MOST_BOUNCES: u32 = 8;

/// A light path on its way.
struct Flight {
    sampler: PathSampler,
    ray: Ray,
    weight: f32,
    /// The last point on mirror or glass.
    seen: Option<Vec3>,
}

/// The guide of `scene`; none where no light of extent shines on mirrors or glass, and not in
/// course-compatible scenes. Breaks when `progress` does.
pub(super) fn guide(
    scene: &PreparedScene,
    progress: &PrepareProgress<'_>,
) -> ControlFlow<(), Option<Guide>> {
    let targets = specular_bounds(scene);
    let extended = |light: &Light| !light.is_delta() && !light.is_infinite();
    let power = |light: &Light| match extended(light) {
        true => light.power(scene.shapes(), 0.0),
        false => 0.0,
    };
    let powers: Vec<f32> = (scene.tables.lights.iter()).map(power).collect();
    let (Some(lights), false) = (
        Distribution1d::new(&powers),
        targets.is_empty() || scene.is_course_compatible(),
    ) else {
        return ControlFlow::Continue(None);
    };
    let mut photons = Vec::new();
    for first in (0..PATHS).step_by(BATCH as usize) {
        progress("following light", first as f32 / PATHS as f32)?;
        let numbers = first..first + BATCH;
        let flights = numbers.filter_map(|number| start(scene, &lights, &targets, number));
        fly(scene, flights.collect(), &mut photons);
    }
    let shining = powers.iter().filter(|power| power.is_finite());
    ControlFlow::Continue(Guide::new(&photons, shining.sum()))
}

/// A path from a point of a light, chosen by power, in a direction of the cone that one of `targets`
/// fills.
fn start(
    scene: &PreparedScene,
    lights: &Distribution1d,
    targets: &[Sphere],
    number: u32,
) -> Option<Flight> {
    let sampler = PathSampler::new(0, [0, 0], number);
    let choice = sampler.get_2d(0, Slot::LightChoice(0));
    let (light, pmf, u_part) = lights.sample(choice.x);
    let place = sampler.get_2d(0, Slot::LightPoint(0));
    let from = scene
        .light(light as u32)
        .emission_point(scene.shapes(), u_part, place)?;
    let target = (choice.y * targets.len() as f32) as usize;
    let Sphere { center, radius } = targets[target.min(targets.len() - 1)];
    let cone = Cone::new(from.point, center, radius * radius);
    let direction = cone.sample(sampler.get_2d(0, Slot::Scatter));
    let cosine = from.normal.dot(direction);
    let cosine = if from.two_sided { cosine.abs() } else { cosine };
    let chance = pmf / targets.len() as f32 * PATHS as f32;
    let weight = from.luminance_area * cosine * cone.solid_angle() / chance;
    let error = gamma(8) * from.point.abs();
    let origin = offset_origin(from.point, error, from.normal, direction);
    (weight.is_finite() && weight > 0.0).then(|| Flight {
        sampler,
        ray: Ray::new(origin, direction),
        weight,
        seen: None,
    })
}

/// Follows `flights` to where they end.
fn fly(scene: &PreparedScene, mut flights: Vec<Flight>, photons: &mut Vec<Photon>) {
    let mut counts = TraceCounts::default();
    let mut hits = Vec::new();
    for bounce in 0..=MOST_BOUNCES {
        let rays: Vec<Ray> = flights.iter().map(|flight| flight.ray).collect();
        hits.clear();
        hits.resize(rays.len(), Hit::MISS);
        scene.aggregate().closest_hit(&rays, &mut hits, &mut counts);
        let met = flights.into_iter().zip(&hits);
        flights = met
            .filter_map(|(flight, hit)| arrive(scene, flight, (hit, bounce), photons))
            .collect();
    }
}

/// Leaves a photon where the flight has come from mirror or glass to another surface; the flight as it
/// goes on from mirror or glass.
fn arrive(
    scene: &PreparedScene,
    flight: Flight,
    (hit, bounce): (&Hit, u32),
    photons: &mut Vec<Photon>,
) -> Option<Flight> {
    if hit.is_miss() {
        return None;
    }
    let bsdf = scene.bsdf(hit.primitive);
    let surface = scene.interaction(&flight.ray, hit);
    let wo = -flight.ray.direction;
    let agree = wo.dot(surface.geometric_normal) * wo.dot(surface.shading_normal) > 0.0;
    let normal = if agree {
        surface.shading_normal
    } else {
        surface.geometric_normal
    };
    let frame = Frame::from_normal(normal);
    let local = frame.to_local(wo);
    if !bsdf.is_delta() {
        if let (Some(seen), false) = (flight.seen, bsdf.is_black()) {
            let shift = flight.sampler.get_2d(bounce, Slot::Scatter) - 0.5;
            photons.push(Photon {
                point: surface.point,
                normal: normal * 1.0_f32.copysign(local.z),
                seen,
                weight: flight.weight,
                shift: frame.x * shift.x + frame.y * shift.y,
            });
        }
        return None;
    }
    let lobe = |u_lobe| bsdf.sample(local, u_lobe, Vec2::ZERO);
    let ends = (lobe(0.0), lobe(ONE_MINUS_EPSILON));
    let (sample, factor) = choose(ends, flight.sampler.get_1d(bounce, Slot::Lobe))?;
    let direction = frame.to_world(sample.wi).normalize_or_zero();
    if direction.dot(surface.geometric_normal) * sample.wi.z <= 0.0 {
        return None;
    }
    let origin = offset_origin(
        surface.departure,
        surface.error,
        surface.geometric_normal,
        direction,
    );
    Some(Flight {
        sampler: flight.sampler,
        ray: Ray::new(origin, direction),
        weight: flight.weight * factor,
        seen: Some(surface.point),
    })
}

/// One of the two ways from a smooth surface, and what the weight is multiplied with.
///
/// A path from the camera takes a way with probability p, so what it sees there has p times the mean and
/// a spread of √p: that is what aiming at it is worth, and so are the ways chosen.
fn choose(ends: (Option<BsdfSample>, Option<BsdfSample>), u: f32) -> Option<(BsdfSample, f32)> {
    match ends {
        (Some(a), Some(b)) if a.wi != b.wi => {
            let (root_a, root_b) = (a.pdf.sqrt(), b.pdf.sqrt());
            let sum = root_a + root_b;
            Some((if u * sum < root_a { a } else { b }, sum))
        }
        (a, b) => Some((a.or(b)?, 1.0)),
    }
}
