//! Radiances of the same paths in both precisions, held against each other.

use glam::DVec3;
use rayon::prelude::*;
use softbox::camera::{Camera, RayCamera};
use softbox::color::Rgb;
use softbox::integrator::{BATCH_SIZE, PathCounts, PathId, PathTracer, Wavefront, reference_f64};
use softbox::scene::PreparedScene;

/// The picture's size, not a multiple of anything.
const WIDTH: u32 = 61;
const HEIGHT: u32 = 47;

/// The largest share of paths that rounding may send elsewhere. The rates found over half a million
/// paths a case lie between 10⁻⁶ and 3 · 10⁻⁵, glass included.
pub(crate) const FLIP_RATE: f64 = 2e-4;

/// The same where a closed mesh glows: shadow rays in single precision miss blockers just before the
/// light's silhouette. Over half a million paths of the smooth meshes, two light samples a vertex,
/// the rate is 7 · 10⁻⁶ with one bounce, 3 · 10⁻⁵ with two and 2.1 · 10⁻⁴ with four; without the glow
/// 4 · 10⁻⁵ with four. The first 16 samples alone come to 4.1 · 10⁻⁴.
pub(crate) const GLOWING_FLIP_RATE: f64 = 6e-4;

/// The same for paths of any length between mirrors and glass, whose curves spread rounding: with at
/// most 3, 5, 8, 12, 20 and 40 bounces the rates are 0, 4 · 10⁻⁵, 1.4, 2.9, 3.6 and 3.6 · 10⁻⁴.
pub(crate) const ENDLESS_FLIP_RATE: f64 = 5e-4;

pub(crate) fn ray_camera(scene: &PreparedScene, camera: &Camera) -> RayCamera {
    RayCamera::new(camera, WIDTH, HEIGHT, scene.normalization())
}

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Comparison {
    samples: f64,
    /// Paths whose radiance differs by more than 10⁻³ relative and 10⁻⁵ absolute.
    flips: f64,
    /// Sums over all channels of the other paths.
    single: f64,
    double: f64,
    /// Sums over all paths of the difference, mean of the channels.
    difference: f64,
    squared_difference: f64,
}

impl Comparison {
    /// `single` as the production integrator renders it against `double` in double precision.
    pub(crate) fn new(single: &PathTracer<'_>, double: &PathTracer<'_>, samples: u32) -> Self {
        let ids: Vec<PathId> = (0..WIDTH * HEIGHT * samples)
            .map(|i| PathId {
                pixel: [i / samples % WIDTH, i / samples / WIDTH],
                sample: i % samples,
            })
            .collect();
        ids.par_chunks(BATCH_SIZE)
            .map(|ids| {
                let mut radiance = vec![Rgb::ZERO; ids.len()];
                let mut counts = PathCounts::default();
                Wavefront::default().trace(single, ids, &mut radiance, &mut counts);
                assert_eq!(counts.invalid_samples, 0);
                let mut comparison = Self::default();
                for (&id, radiance) in ids.iter().zip(radiance) {
                    comparison.add(radiance.as_dvec3(), reference_f64(double, id));
                }
                comparison
            })
            .reduce(Self::default, Self::merge)
    }

    fn add(&mut self, single: DVec3, double: DVec3) {
        assert!(double.is_finite() && double.min_element() >= 0.0);
        let allowed = 1e-3 * single.max(double) + DVec3::splat(1e-5);
        let difference = (single - double).element_sum() / 3.0;
        self.samples += 1.0;
        self.difference += difference;
        self.squared_difference += difference * difference;
        if (single - double).abs().cmpgt(allowed).any() {
            self.flips += 1.0;
        } else {
            self.single += single.element_sum();
            self.double += double.element_sum();
        }
    }

    fn merge(self, other: Self) -> Self {
        Self {
            samples: self.samples + other.samples,
            flips: self.flips + other.flips,
            single: self.single + other.single,
            double: self.double + other.double,
            difference: self.difference + other.difference,
            squared_difference: self.squared_difference + other.squared_difference,
        }
    }

    pub(crate) fn flip_rate(&self) -> f64 {
        self.flips / self.samples
    }

    /// Few paths part; the others have the same mean up to 10⁻⁵, and all together up to the noise
    /// of those few.
    pub(crate) fn check(&self, name: &str) {
        self.check_within(name, FLIP_RATE);
    }

    /// The same with another limit for the share of paths that part.
    #[expect(clippy::print_stdout, reason = "the rates are the result of the test")]
    pub(crate) fn check_within(&self, name: &str, flip_rate: f64) {
        let off = self.single / self.double - 1.0;
        let mean = self.difference / self.samples;
        let variance = self.squared_difference / self.samples - mean * mean;
        let error = (variance.max(0.0) / self.samples).sqrt();
        println!(
            "{name}: flips {:.1e}; mean of the others off by {off:.1e}; all {mean:.1e} ± {error:.1e}",
            self.flip_rate()
        );
        assert!(self.double > 0.0, "{name} is black");
        assert!(self.flip_rate() <= flip_rate, "{name}: {self:?}");
        assert!(off.abs() < 1e-5, "{name}: off by {off}");
        let noise = 5.0 * error + 1e-5 * self.double / (3.0 * self.samples);
        assert!(mean.abs() < noise, "{name}: {mean} ± {error}");
    }
}

/// The largest channel of all paths of `tracer`.
pub(crate) fn brightest(tracer: &PathTracer<'_>, samples: u32) -> f32 {
    (0..WIDTH * HEIGHT)
        .into_par_iter()
        .map(|i| {
            let pixel = [i % WIDTH, i / WIDTH];
            let ids: Vec<PathId> = (0..samples)
                .map(|sample| PathId { pixel, sample })
                .collect();
            let mut radiance = vec![Rgb::ZERO; ids.len()];
            let mut counts = PathCounts::default();
            Wavefront::default().trace(tracer, &ids, &mut radiance, &mut counts);
            radiance.iter().map(|r| r.max_element()).fold(0.0, f32::max)
        })
        .reduce(|| 0.0, f32::max)
}
