//! Tests F4 and F5 of the stress list: pixels whose distribution is known.

use super::super::Schedule;
use crate::color::Rgb;
use crate::film::Film;
use crate::image::Region;
use crate::sampling::{PathSampler, Slot};
use crate::settings::{Adaptive, AdaptiveGoal, RenderSettings, StopRule};

const TOLERANCE: f64 = 0.05;

/// A sample of mean 1.
#[derive(Clone, Copy, Debug)]
enum Distribution {
    /// Between 0 and 2.
    Uniform,
    /// 1/p with probability p, else 0.
    Bernoulli(f32),
    /// 0.9, and with probability 0.005 20 more.
    BaseAndRare,
    /// Logarithm of deviation 1.
    LogNormal,
}

impl Distribution {
    fn value(self, u: [f32; 2]) -> f32 {
        match self {
            Self::Uniform => 2.0 * u[0],
            Self::Bernoulli(p) if u[0] < p => 1.0 / p,
            Self::Bernoulli(_) => 0.0,
            Self::BaseAndRare if u[0] < 0.005 => 20.9,
            Self::BaseAndRare => 0.9,
            Self::LogNormal => {
                let radius = (-2.0 * (1.0 - u[0]).ln()).sqrt();
                (radius * (std::f32::consts::TAU * u[1]).cos() - 0.5).exp()
            }
        }
    }
}

/// What has become of a picture of equal pixels.
#[derive(Debug)]
struct Ending {
    /// Mean of the picture, less 1.
    bias: f64,
    /// Share of the pixels that ended by themselves.
    closed: f64,
    /// Share of those that are within the tolerance.
    covered: f64,
}

pub(super) fn settings(goal: AdaptiveGoal, budget: u32) -> RenderSettings {
    RenderSettings {
        adaptive: Some(Adaptive {
            batch: 64,
            tolerance: TOLERANCE as f32,
            goal,
            exposure: 0.0,
        }),
        stop: StopRule {
            samples_per_pixel: Some(budget),
            ..StopRule::default()
        },
        ..RenderSettings::default()
    }
}

/// Samples of `value` in a picture of `size` pixels until adaptive sampling or the budget ends it.
pub(super) fn film_at_the_end(
    size: [u32; 2],
    settings: &RenderSettings,
    value: impl Fn(u32, PathSampler) -> f32,
) -> Film {
    let [width, height] = size;
    let region = Region {
        x: 3,
        y: 5,
        width,
        height,
    };
    let replicates = settings.replicates();
    let mut film = Film::with_replicates(region, replicates);
    let mut schedule = Schedule::default();
    while !schedule.all_closed() && !schedule.has_all_samples(settings) {
        let target = schedule.bound(settings);
        for tile in film.tiles_mut() {
            for index in 0..tile.pixels().len() {
                let (x, y) = tile.position(index);
                let pixel = tile.pixels()[index];
                for sample in pixel.count()..target.min(pixel.limit()) {
                    let numbers =
                        PathSampler::replicated(settings.seed, [x, y], sample, replicates);
                    tile.add(index, Rgb::splat(value(x - region.x, numbers)));
                }
            }
        }
        schedule.arrive(target, (&mut film, 1), settings);
    }
    film
}

fn ending(size: [u32; 2], settings: &RenderSettings, case: (Distribution, Slot)) -> Ending {
    let film = film_at_the_end(size, settings, |_, numbers| {
        case.0.value(numbers.get_2d(0, case.1).to_array())
    });
    let (mut sum, mut closed, mut covered) = (0.0, 0.0, 0.0);
    let pixels = film.tiles().iter().flat_map(|tile| tile.pixels());
    for pixel in pixels {
        let error = pixel.mean()[0] - 1.0;
        sum += error;
        if pixel.is_closed() {
            closed += 1.0;
            covered += f64::from(u8::from(error.abs() <= TOLERANCE));
        }
    }
    let n = f64::from(size[0] * size[1]);
    Ending {
        bias: sum / n,
        closed: closed / n,
        covered: covered / closed,
    }
}

/// Independent samples, and low-discrepancy ones.
const SLOTS: [Slot; 2] = [Slot::Roulette, Slot::LightPoint(0)];

const CASES: [Distribution; 7] = [
    Distribution::Uniform,
    Distribution::Bernoulli(0.3),
    Distribution::Bernoulli(0.05),
    Distribution::Bernoulli(0.01),
    Distribution::Bernoulli(0.002),
    Distribution::BaseAndRare,
    Distribution::LogNormal,
];

/// The picture's mean is right within half a percent (5 % where one sample in 500 finds the light),
/// and of the pixels that ended, at least 93 % are within the tolerance.
fn even_quality_is_honest(size: [u32; 2], budget: u32) {
    for distribution in CASES {
        for slot in SLOTS {
            let settings = settings(AdaptiveGoal::Even, budget);
            let end = ending(size, &settings, (distribution, slot));
            let is_rare = matches!(distribution, Distribution::Bernoulli(p) if p < 0.01);
            let limit = if is_rare { 0.05 } else { 0.005 };
            assert!(end.bias.abs() < limit, "{distribution:?} {slot:?}: {end:?}");
            if end.closed > 0.1 {
                assert!(end.covered >= 0.93, "{distribution:?} {slot:?}: {end:?}");
            }
        }
    }
}

#[test]
fn even_quality_is_honest_about_small_pictures() {
    even_quality_is_honest([60, 50], 4096);
}

/// The course's rule, for comparison: half of the pixels see nothing in 64 samples and end there.
#[test]
fn the_courses_rule_gives_up_on_rare_light() {
    let settings = settings(AdaptiveGoal::Course, 4096);
    let case = (Distribution::Bernoulli(0.01), Slot::Roulette);
    let end = ending([60, 50], &settings, case);
    assert!(end.bias < -0.3, "{end:?}");
}

/// Test F5: black and nearly black pixels end by the floor, unless they are to be seen at a higher
/// exposure.
#[test]
fn dark_pixels_end_by_the_floor() {
    let samples = |brightness: f32, exposure: f32| {
        let mut settings = settings(AdaptiveGoal::Even, 1024);
        if let Some(adaptive) = &mut settings.adaptive {
            adaptive.exposure = exposure;
        }
        let film = film_at_the_end([40, 40], &settings, |_, numbers| {
            let u = numbers.get_2d(0, Slot::Roulette).to_array();
            brightness * Distribution::Bernoulli(0.3).value(u)
        });
        film.summary().samples as f64 / 1600.0
    };
    assert_eq!(samples(0.0, 0.0), 64.0);
    assert_eq!(samples(1e-6, 0.0), 64.0);
    assert_eq!(samples(1e-6, 16.0), 1024.0);
}

#[test]
#[ignore = "some minutes"]
fn even_quality_is_honest_about_forty_thousand_pixels() {
    even_quality_is_honest([200, 200], 12_800);
}
