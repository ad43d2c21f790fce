//! The production path tracer: a batch of paths goes through each stage together.

use super::direct::DirectRay;
use super::path::{Path, Vertex};
use super::{PathCounts, PathId, PathTracer};
use crate::color::{Rgb, is_valid_radiance};
use crate::geometry::Hit;
use crate::math::Ray;

/// Paths in one batch: enough to keep the tracing kernel busy, few enough that a batch ends within
/// some milliseconds when a render is cancelled and that the arrays stay in the cache.
pub const BATCH_SIZE: usize = 2048;

/// The arrays of one worker, kept from batch to batch.
#[derive(Debug, Default)]
pub struct Wavefront {
    paths: Vec<Path>,
    /// Paths still alive, as indices into `paths`.
    active: Vec<u32>,
    rays: Vec<Ray>,
    hits: Vec<Hit>,
    shadow: RayQueue,
    occluded: Vec<bool>,
    gather: RayQueue,
    gather_hits: Vec<Hit>,
}

/// Rays of direct light, with what they carry and the path that gets it.
#[derive(Debug, Default)]
struct RayQueue {
    rays: Vec<Ray>,
    carried: Vec<Rgb>,
    owners: Vec<u32>,
}

impl RayQueue {
    fn clear(&mut self) {
        self.rays.clear();
        self.carried.clear();
        self.owners.clear();
    }

    fn push(&mut self, ray: Ray, carried: Rgb, owner: u32) {
        self.rays.push(ray);
        self.carried.push(carried);
        self.owners.push(owner);
    }
}

impl Wavefront {
    /// Writes the radiance of each path of `ids` to `radiance`: the bits that
    /// [`super::reference()`] gives. Camera rays go fastest if every 32 paths in a row belong to a
    /// compact group of pixels.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn trace(
        &mut self,
        tracer: &PathTracer<'_>,
        ids: &[PathId],
        radiance: &mut [Rgb],
        counts: &mut PathCounts,
    ) {
        assert_eq!(ids.len(), radiance.len());
        self.paths.clear();
        self.paths.extend(ids.iter().map(|&id| tracer.start(id)));
        self.active.clear();
        self.active.extend(0..ids.len() as u32);
        counts.camera_rays += ids.len() as u64;
        let mut vertices = Vec::with_capacity(ids.len());
        let mut is_camera = true;
        while !self.active.is_empty() {
            self.trace_active(tracer, is_camera, counts);
            is_camera = false;
            self.shade(tracer, &mut vertices);
            self.add_direct_light(tracer, &vertices, counts);
            let paths = &mut self.paths;
            self.active.clear();
            self.active
                .extend(vertices.iter().filter_map(|(owner, vertex)| {
                    tracer
                        .scatter(&mut paths[*owner as usize], vertex)
                        .then_some(*owner)
                }));
        }
        for (path, out) in self.paths.iter().zip(radiance) {
            let is_valid = is_valid_radiance(path.radiance);
            counts.invalid_samples += u64::from(!is_valid);
            *out = if is_valid { path.radiance } else { Rgb::ZERO };
        }
    }

    /// The closest hits of all active paths. Camera rays are coherent if the caller gave the paths of
    /// neighbouring pixels one after the other.
    fn trace_active(&mut self, tracer: &PathTracer<'_>, is_camera: bool, counts: &mut PathCounts) {
        self.rays.clear();
        self.rays.extend(
            self.active
                .iter()
                .map(|&owner| self.paths[owner as usize].ray),
        );
        self.hits.clear();
        self.hits.resize(self.rays.len(), Hit::MISS);
        let (aggregate, trace) = (tracer.scene.aggregate(), &mut counts.trace);
        if is_camera {
            aggregate.closest_hit_coherent(&self.rays, &mut self.hits, trace);
        } else {
            aggregate.closest_hit(&self.rays, &mut self.hits, trace);
        }
        counts.closest_rays += self.rays.len() as u64;
    }

    /// Emission, and the vertices of the paths that go on.
    fn shade<'a>(&mut self, tracer: &PathTracer<'a>, vertices: &mut Vec<(u32, Vertex<'a>)>) {
        vertices.clear();
        for (&owner, hit) in self.active.iter().zip(&self.hits) {
            if let Some(vertex) = tracer.arrive(&mut self.paths[owner as usize], hit) {
                vertices.push((owner, vertex));
            }
        }
    }

    fn add_direct_light(
        &mut self,
        tracer: &PathTracer<'_>,
        vertices: &[(u32, Vertex<'_>)],
        counts: &mut PathCounts,
    ) {
        for number in 0..tracer.plan.len() as u32 {
            self.shadow.clear();
            self.gather.clear();
            for &(owner, ref vertex) in vertices {
                let path = &self.paths[owner as usize];
                if !tracer.wants_direct(path, vertex) {
                    continue;
                }
                match tracer.direct_ray(path, vertex, number) {
                    None => counts.culled_shadow_rays += 1,
                    Some(DirectRay::Shadow { ray, contribution }) => {
                        self.shadow.push(ray, contribution, owner);
                    }
                    Some(DirectRay::Gather { ray, factor }) => self.gather.push(ray, factor, owner),
                }
            }
            self.connect(tracer, counts);
            self.collect(tracer, counts);
        }
    }

    fn connect(&mut self, tracer: &PathTracer<'_>, counts: &mut PathCounts) {
        self.occluded.clear();
        self.occluded.resize(self.shadow.rays.len(), false);
        tracer
            .scene
            .aggregate()
            .any_hit(&self.shadow.rays, &mut self.occluded, &mut counts.trace);
        counts.shadow_rays += self.shadow.rays.len() as u64;
        for ((&owner, &contribution), &occluded) in self
            .shadow
            .owners
            .iter()
            .zip(&self.shadow.carried)
            .zip(&self.occluded)
        {
            if !occluded {
                self.paths[owner as usize].radiance += contribution;
            }
        }
    }

    fn collect(&mut self, tracer: &PathTracer<'_>, counts: &mut PathCounts) {
        self.gather_hits.clear();
        self.gather_hits.resize(self.gather.rays.len(), Hit::MISS);
        tracer.scene.aggregate().closest_hit(
            &self.gather.rays,
            &mut self.gather_hits,
            &mut counts.trace,
        );
        counts.closest_rays += self.gather.rays.len() as u64;
        for (i, &owner) in self.gather.owners.iter().enumerate() {
            let gathered = tracer.gathered(&self.gather.rays[i], &self.gather_hits[i]);
            self.paths[owner as usize].radiance += self.gather.carried[i] * gathered;
        }
    }
}
