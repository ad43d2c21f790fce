//! The production path tracer: a batch of paths goes through each stage together.
//!
//! All paths of a batch have bounced equally often. The plain surfaces among those that they meet,
//! which are nearly all, are shaded eight at a time (`shade`, `surface`, `direct`, `scatter`); the others by the
//! steps of the reference, one after the other. Either way the bits are those of the reference.

mod direct;
mod guided;
mod paths;
mod queue;
mod reuse;
mod scatter;
mod shade;
mod start;
mod surface;

use super::path::{Path, Vertex};
use super::{PathCounts, PathId, PathTracer};
use crate::color::Rgb;
use crate::geometry::Hit;
use crate::math::{ROW, run_lanes};
use crate::sampling::PathSampler;
use paths::Paths;
use queue::DirectQueues;
use reuse::Reuse;
use shade::Shade;
use start::Start;

/// Paths in one batch: enough to keep the tracing kernel busy, few enough that a batch ends within
/// some milliseconds when a render is cancelled and that the arrays stay in the cache; `bench/wavefront`
/// has what other sizes, and other shapes of the wavefront, cost.
pub const BATCH_SIZE: usize = 2048;

/// Direct light rays that wait to be traced together, at most; more samples a vertex than one take a
/// batch in parts.
const MOST_DIRECT: usize = 2 * BATCH_SIZE;

/// The arrays of one worker, kept from batch to batch.
#[derive(Debug, Default)]
pub struct Wavefront {
    /// Of all paths of the batch, by number.
    samplers: Vec<PathSampler>,
    /// Those still alive.
    paths: Paths,
    hits: Vec<Hit>,
    /// Those alive after this bounce.
    next: Paths,
    direct: DirectQueues,
    reuse: Reuse,
    /// Of all paths, and behind them what leaves their shared vertices.
    radiance: Vec<Rgb>,
}

impl Wavefront {
    /// Writes the radiance of each path of `ids` to `radiance`: the bits that
    /// [`super::reference_cluster`] gives for the clusters of `ids`, which follow each other
    /// ([`PathTracer::cluster_size`]). Camera rays go fastest if every 32 paths in a row belong to a
    /// compact group of pixels.
    ///
    /// # Panics
    /// When the slices differ in length or the last cluster is not whole.
    pub fn trace(
        &mut self,
        tracer: &PathTracer<'_>,
        ids: &[PathId],
        radiance: &mut [Rgb],
        counts: &mut PathCounts,
    ) {
        assert_eq!(ids.len(), radiance.len());
        self.reuse.begin(tracer, ids.len());
        let tallies = ids.len() * if self.reuse.is_on() { 2 } else { 1 };
        self.radiance.clear();
        self.radiance.resize(tallies, Rgb::ZERO);
        self.start(tracer, ids);
        counts.camera_rays += ids.len() as u64;
        let mut bounce = 0;
        while !self.paths.is_empty() {
            self.trace_rays(tracer, bounce == 0, counts);
            self.shade(tracer, bounce, counts);
            std::mem::swap(&mut self.paths, &mut self.next);
            bounce += 1;
        }
        self.reuse
            .exchange(tracer, &self.samplers, &mut self.radiance, counts);
        radiance.copy_from_slice(&self.radiance[..ids.len()]);
        for radiance in radiance {
            if !tracer.is_valid(*radiance) {
                counts.invalid_samples += 1;
                *radiance = Rgb::ZERO;
            }
        }
    }

    fn start(&mut self, tracer: &PathTracer<'_>, ids: &[PathId]) {
        self.paths.clear();
        self.samplers.clear();
        for cluster in ids.chunks(tracer.cluster_size()) {
            let samplers = (cluster.iter().zip(0..))
                .map(|(&id, number)| tracer.sampler(id, (cluster[0].pixel, number)));
            self.samplers.extend(samplers);
        }
        if tracer.camera.is_pinhole() {
            let start = Start {
                tracer,
                ids,
                samplers: &self.samplers,
                paths: &mut self.paths,
            };
            return run_lanes(tracer.scene.aggregate().isa(), start);
        }
        for (number, (&id, &sampler)) in (0..).zip(ids.iter().zip(&self.samplers)) {
            self.paths
                .push((number, number), &tracer.start(id, sampler));
        }
    }

    /// The closest hits of all rays. Camera rays are coherent if the caller gave the paths of
    /// neighbouring pixels one after the other.
    fn trace_rays(&mut self, tracer: &PathTracer<'_>, is_camera: bool, counts: &mut PathCounts) {
        let rays = &self.paths.rays;
        self.hits.clear();
        self.hits.resize(rays.len(), Hit::MISS);
        let (aggregate, trace) = (tracer.scene.aggregate(), &mut counts.trace);
        if is_camera {
            aggregate.closest_hit_coherent(rays, &mut self.hits, trace);
        } else {
            aggregate.closest_hit(rays, &mut self.hits, trace);
        }
        counts.closest_rays += rays.len() as u64;
    }

    /// Emission, direct light, and the next rays of the paths that go on.
    fn shade(&mut self, tracer: &PathTracer<'_>, bounce: u32, counts: &mut PathCounts) {
        self.next.clear();
        let part = (MOST_DIRECT / tracer.plan.len().max(1))
            .max(ROW)
            .next_multiple_of(ROW);
        for first in (0..self.paths.len()).step_by(part) {
            let shade = Shade {
                tracer,
                paths: &self.paths,
                hits: &self.hits,
                samplers: &self.samplers,
                bounce,
                range: first..(first + part).min(self.paths.len()),
                radiance: &mut self.radiance,
                reuse: &mut self.reuse,
                next: &mut self.next,
                direct: &mut self.direct,
                counts: &mut *counts,
            };
            run_lanes(tracer.scene.aggregate().isa(), shade);
            self.direct.trace(tracer, &mut self.radiance, counts);
        }
    }
}
