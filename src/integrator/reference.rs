//! The path tracer in its plainest form: one path at a time.

use super::direct::DirectRay;
use super::{PathCounts, PathId, PathTracer};
use crate::color::{Rgb, is_valid_radiance};
use crate::geometry::Hit;
use crate::math::Ray;

/// The radiance of one path, and the work it took.
///
/// The camera ray's emission counts in full. At each surface, direct light is estimated by the
/// samples of the plan; then the material sends the path on. Emission that the next ray meets
/// counts only where light samples did not count it already. Kajiya 1986, "The Rendering
/// Equation"; Veach 1997, chapter 9.
pub fn reference(tracer: &PathTracer<'_>, id: PathId, counts: &mut PathCounts) -> Rgb {
    let mut path = tracer.start(id);
    counts.camera_rays += 1;
    loop {
        let hit = closest(tracer, &path.ray, counts);
        let Some(vertex) = tracer.arrive(&mut path, &hit) else {
            break;
        };
        if tracer.wants_direct(&path, &vertex) {
            for number in 0..tracer.plan.len() as u32 {
                match tracer.direct_ray(&path, &vertex, number) {
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
        if !tracer.scatter(&mut path, &vertex) {
            break;
        }
    }
    if is_valid_radiance(path.radiance) {
        path.radiance
    } else {
        counts.invalid_samples += 1;
        Rgb::ZERO
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
