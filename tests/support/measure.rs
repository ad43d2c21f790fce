//! Mean and standard error of the radiance of many paths.

use std::ops::ControlFlow;

use glam::DVec3;
use rayon::prelude::*;
use softbox::camera::{Camera, Framing, RayCamera};
use softbox::integrator::{BATCH_SIZE, PathCounts, PathId, PathSettings, PathTracer, Wavefront};
use softbox::scene::{PrepareSettings, PreparedScene, Scene, prepare};
use softbox::settings::{MaxDepth, Mode};

/// Samples of one replicate, of which [`blocks`] takes the mean as one value: the samples of a
/// sequence are not independent, and their own spread would only say that the error is no larger.
const REPLICATE: u32 = 64;

/// Mean of many independent values and its standard error, per channel.
#[derive(Clone, Copy, Debug, Default)]
pub struct Estimate {
    pub n: f64,
    pub sum: [f64; 3],
    pub sum_of_squares: [f64; 3],
    /// The largest value.
    pub largest: f64,
}

impl Estimate {
    pub fn add(&mut self, x: [f64; 3]) {
        self.n += 1.0;
        for (c, &x) in x.iter().enumerate() {
            self.sum[c] += x;
            self.sum_of_squares[c] += x * x;
            self.largest = self.largest.max(x);
        }
    }

    pub fn merge(mut self, other: Self) -> Self {
        self.n += other.n;
        self.largest = self.largest.max(other.largest);
        for c in 0..3 {
            self.sum[c] += other.sum[c];
            self.sum_of_squares[c] += other.sum_of_squares[c];
        }
        self
    }

    pub fn mean(&self, c: usize) -> f64 {
        self.sum[c] / self.n
    }

    pub fn standard_error(&self, c: usize) -> f64 {
        let variance = (self.sum_of_squares[c] / self.n - self.mean(c).powi(2)).max(0.0);
        (variance / (self.n - 1.0)).sqrt()
    }
}

pub fn prepared(scene: &Scene) -> PreparedScene {
    prepare(scene, &PrepareSettings::default(), &|_, _| {
        ControlFlow::Continue(())
    })
    .expect("nothing asks it to stop")
}

pub fn settings(mode: Mode, max_depth: MaxDepth) -> PathSettings {
    PathSettings {
        mode,
        light_samples: 1,
        max_depth,
        only_last_bounce: false,
        seed: 1,
        replicates: 1,
        reuse: 1,
    }
}

pub fn camera(eye: DVec3, target: DVec3, fov_x_degrees: f64) -> Camera {
    let up = if (target - eye).normalize().y.abs() > 0.99 {
        DVec3::Z
    } else {
        DVec3::Y
    };
    Camera {
        eye,
        target,
        up,
        framing: Framing::Horizontal(fov_x_degrees.to_radians()),
        ..Camera::default()
    }
}

/// Radiance over a picture of one pixel.
pub fn measure(
    scene: &PreparedScene,
    camera: &Camera,
    settings: PathSettings,
    samples: u32,
) -> Estimate {
    blocks(scene, camera, settings, (1, 1), samples)[0]
}

/// Radiance over each pixel of a picture of `size` pixels: each value is the mean of a replicate of
/// some 64 samples.
pub fn blocks(
    scene: &PreparedScene,
    camera: &Camera,
    settings: PathSettings,
    size: (u32, u32),
    samples: u32,
) -> Vec<Estimate> {
    let settings = PathSettings {
        replicates: samples / REPLICATE,
        ..settings
    };
    let length = samples / settings.replicates;
    replicated(scene, camera, settings, size, length)
}

/// The same with `length` samples in each of the replicates of `settings`.
pub fn replicated(
    scene: &PreparedScene,
    camera: &Camera,
    settings: PathSettings,
    size: (u32, u32),
    length: u32,
) -> Vec<Estimate> {
    let camera = RayCamera::new(camera, size.0, size.1, scene.normalization());
    let tracer = PathTracer::new(scene, &camera, settings);
    (0..size.0 * size.1)
        .into_par_iter()
        .map(|pixel| pixel_means(&tracer, [pixel % size.0, pixel / size.0], length))
        .collect()
}

/// The means of the replicates of one pixel, `length` samples of each.
fn pixel_means(tracer: &PathTracer<'_>, pixel: [u32; 2], length: u32) -> Estimate {
    let replicates = tracer.settings.replicates;
    let of_a_batch = (BATCH_SIZE as u32 / length).max(1);
    let firsts = (0..replicates).into_par_iter().step_by(of_a_batch as usize);
    firsts
        .map(|first| {
            let end = replicates.min(first + of_a_batch);
            let ids: Vec<PathId> = (first..end)
                .flat_map(|replicate| {
                    (0..length).map(move |i| PathId {
                        pixel,
                        sample: i * replicates + replicate,
                    })
                })
                .collect();
            replicate_means(tracer, &ids, length as usize)
        })
        .reduce(Estimate::default, Estimate::merge)
}

/// The means of every `length` paths; each leads a cluster of its own, with pixels to the right and
/// below.
fn replicate_means(tracer: &PathTracer<'_>, ids: &[PathId], length: usize) -> Estimate {
    let size = tracer.cluster_size() as u32;
    let clusters: Vec<PathId> = ids
        .iter()
        .flat_map(
            |&PathId {
                 pixel: [x, y],
                 sample,
             }| {
                (0..size).map(move |i| PathId {
                    pixel: [x + i % 4, y + i / 4],
                    sample,
                })
            },
        )
        .collect();
    let mut radiance = vec![glam::Vec3::ZERO; clusters.len()];
    let mut counts = PathCounts::default();
    Wavefront::default().trace(tracer, &clusters, &mut radiance, &mut counts);
    assert_eq!(counts.invalid_samples, 0);
    let mut estimate = Estimate::default();
    for samples in radiance.chunks_exact(length * size as usize) {
        let own = samples.iter().step_by(size as usize);
        let sum: DVec3 = own.map(|r| r.as_dvec3()).sum();
        estimate.add((sum / length as f64).to_array());
    }
    estimate
}
