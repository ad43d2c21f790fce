use super::super::direct::DirectRay;
use super::super::{PathCounts, PathTracer};
use crate::color::Rgb;
use crate::geometry::Hit;
use crate::math::Ray;

/// Rays of direct light on their way, with what they carry and the path that gets it.
#[derive(Debug, Default)]
pub(super) struct DirectQueues {
    shadow: RayQueue,
    occluded: Vec<bool>,
    gather: RayQueue,
    hits: Vec<Hit>,
}

/// Rays of one kind.
#[derive(Debug, Default)]
struct RayQueue {
    rays: Vec<Ray>,
    carried: Vec<(Rgb, u32)>,
}

impl RayQueue {
    fn clear(&mut self) {
        self.rays.clear();
        self.carried.clear();
    }
}

impl DirectQueues {
    /// Adds a ray of path `owner`.
    pub(super) fn push(&mut self, owner: u32, ray: DirectRay) {
        match ray {
            DirectRay::Shadow { ray, contribution } => {
                self.push_shadow(owner, ray, contribution);
            }
            DirectRay::Gather { ray, factor } => {
                self.gather.rays.push(ray);
                self.gather.carried.push((factor, owner));
            }
        }
    }

    /// Adds a ray that brings `contribution` to path `owner` when nothing lies on it.
    #[inline(always)]
    pub(super) fn push_shadow(&mut self, owner: u32, ray: Ray, contribution: Rgb) {
        self.shadow.rays.push(ray);
        self.shadow.carried.push((contribution, owner));
    }

    /// Traces all rays and adds what they bring to the `radiance` of their paths in the order of
    /// the plan: gathering rays come first there.
    pub(super) fn trace(
        &mut self,
        tracer: &PathTracer<'_>,
        radiance: &mut [Rgb],
        counts: &mut PathCounts,
    ) {
        self.trace_gathering(tracer, radiance, counts);
        self.trace_shadow(tracer, radiance, counts);
    }

    fn trace_gathering(
        &mut self,
        tracer: &PathTracer<'_>,
        radiance: &mut [Rgb],
        counts: &mut PathCounts,
    ) {
        self.hits.clear();
        self.hits.resize(self.gather.rays.len(), Hit::MISS);
        let aggregate = tracer.scene.aggregate();
        aggregate.closest_hit(&self.gather.rays, &mut self.hits, &mut counts.trace);
        counts.closest_rays += self.gather.rays.len() as u64;
        for (i, &(factor, owner)) in self.gather.carried.iter().enumerate() {
            let gathered = tracer.gathered(&self.gather.rays[i], &self.hits[i]);
            radiance[owner as usize] += factor * gathered;
        }
        self.gather.clear();
    }

    fn trace_shadow(
        &mut self,
        tracer: &PathTracer<'_>,
        radiance: &mut [Rgb],
        counts: &mut PathCounts,
    ) {
        self.occluded.clear();
        self.occluded.resize(self.shadow.rays.len(), false);
        let aggregate = tracer.scene.aggregate();
        aggregate.any_hit(&self.shadow.rays, &mut self.occluded, &mut counts.trace);
        counts.shadow_rays += self.shadow.rays.len() as u64;
        for (&(contribution, owner), &occluded) in self.shadow.carried.iter().zip(&self.occluded) {
            if !occluded {
                radiance[owner as usize] += contribution;
            }
        }
        self.shadow.clear();
    }
}
