//! The path tracer in its plainest form: one path at a time.

use super::direct::DirectRay;
use super::path::{Path, Vertex};
use super::reuse::{Followed, SharedVertex, exchange};
use super::{PathCounts, PathId, PathTracer};
use crate::color::Rgb;
use crate::geometry::Hit;
use crate::math::Ray;

/// The radiance of one path by itself, and the work it took.
///
/// The camera ray's emission counts in full. At each surface, direct light is estimated by the
/// samples of the plan; then the material sends the path on. Emission that the next ray meets
/// counts only where light samples did not count it already. Kajiya 1986, "The Rendering
/// Equation"; Veach 1997, chapter 9.
pub fn reference(tracer: &PathTracer<'_>, id: PathId, counts: &mut PathCounts) -> Rgb {
    let mut radiance = [Rgb::ZERO];
    reference_cluster(tracer, &[id], &mut radiance, counts);
    radiance[0]
}

/// The same for the paths of a cluster, which share their light (see `reuse`).
///
/// # Panics
/// When the slices differ in length or hold more than [`super::MAX_CLUSTER`] paths.
pub fn reference_cluster(
    tracer: &PathTracer<'_>,
    ids: &[PathId],
    radiance: &mut [Rgb],
    counts: &mut PathCounts,
) {
    assert_eq!(ids.len(), radiance.len());
    let paths: Vec<Followed> = (ids.iter().zip(0..))
        .map(|(&id, number)| {
            let sampler = tracer.sampler(id, (ids[0].pixel, number));
            follow(tracer, tracer.start(id, sampler), counts)
        })
        .collect();
    for (radiance, path) in radiance.iter_mut().zip(&paths) {
        *radiance = path.radiance;
    }
    exchange((&paths, tracer.furnace), radiance, counts, |ray, counts| {
        occluded(tracer, ray, counts)
    });
    for radiance in radiance {
        if !tracer.is_valid(*radiance) {
            counts.invalid_samples += 1;
            *radiance = Rgb::ZERO;
        }
    }
}

/// Follows one path to its end.
fn follow(tracer: &PathTracer<'_>, mut path: Path, counts: &mut PathCounts) -> Followed {
    let (mut receiver, mut shared, mut radiance) = (None, None, Rgb::ZERO);
    let sampler = path.sampler;
    counts.camera_rays += 1;
    loop {
        let hit = closest(tracer, &path.ray, counts);
        if hit.is_miss() && tracer.shares_sky(&path) {
            shared = Some(SharedVertex::sky(path.ray.direction));
            radiance = path.share();
        }
        let Some(vertex) = tracer.arrive(&mut path, &hit) else {
            break;
        };
        if tracer.shares(&path, &vertex) {
            shared = Some(SharedVertex::surface(&vertex));
            radiance = path.share();
        }
        if tracer.wants_direct(&path, &vertex) {
            direct_light(tracer, &mut path, &vertex, counts);
        }
        if let Some(found) = tracer.receive(&mut path, &vertex) {
            receiver = Some(found);
        }
        if !tracer.scatter(&mut path, &vertex) {
            break;
        }
    }
    match shared {
        None => Followed {
            sampler,
            radiance: path.radiance,
            receiver,
            shared: None,
        },
        Some(vertex) => Followed {
            sampler,
            radiance,
            receiver,
            shared: Some((vertex, path.radiance)),
        },
    }
}

/// Adds the direct light samples of the plan.
fn direct_light(
    tracer: &PathTracer<'_>,
    path: &mut Path,
    vertex: &Vertex<'_>,
    counts: &mut PathCounts,
) {
    for number in 0..tracer.plan.len() as u32 {
        match tracer.direct_ray(path, vertex, number) {
            None => counts.culled_shadow_rays += 1,
            Some(DirectRay::Shadow { ray, contribution }) => {
                if !occluded(tracer, &ray, counts) {
                    path.radiance += contribution;
                }
            }
            Some(DirectRay::Gather { ray, factor }) => {
                let hit = closest(tracer, &ray, counts);
                path.radiance += factor * tracer.gathered(&ray, &hit);
            }
        }
    }
}

fn closest(tracer: &PathTracer<'_>, ray: &Ray, counts: &mut PathCounts) -> Hit {
    let mut hit = [Hit::MISS];
    tracer
        .scene
        .aggregate()
        .closest_hit(std::slice::from_ref(ray), &mut hit, &mut counts.trace);
    counts.closest_rays += 1;
    hit[0]
}

fn occluded(tracer: &PathTracer<'_>, ray: &Ray, counts: &mut PathCounts) -> bool {
    let mut blocked = [false];
    tracer
        .scene
        .aggregate()
        .any_hit(std::slice::from_ref(ray), &mut blocked, &mut counts.trace);
    counts.shadow_rays += 1;
    blocked[0]
}
