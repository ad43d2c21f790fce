use std::path::Path;
use std::time::Instant;

use anyhow::{Context, anyhow};
use serde::Serialize;
use softbox::color::Rgb;
use softbox::image::Image;
use softbox::io::picture::read_picture;
use softbox::session::Workbench;
use softbox::settings::{Mode, RenderSettings};
use softbox::study::Reference;

use crate::bench_args::BenchArgs;
use crate::exit::{Failure, Status};

/// Added to the seed of the runs: far from all of them.
const SEEDS: u64 = 0x5eed_0000_0000;
/// Below this probability the halves are said to disagree.
const DOUBT: f64 = 0.01;

/// What the scores are measured against.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct ReferenceFacts {
    /// File that it was read from.
    pub(super) file: Option<String>,
    /// Estimator that made it.
    pub(super) mode: Option<&'static str>,
    /// Samples in each pixel.
    pub(super) samples_per_pixel: Option<u32>,
    /// relMSE of its own noise, subtracted from all figures.
    pub(super) rel_mse: f64,
    /// Probability that its halves differ as much as they do.
    pub(super) agreement: Option<f64>,
    /// Processor seconds that it took.
    pub(super) cpu_seconds: f64,
}

impl ReferenceFacts {
    /// False when something is wrong with it, once in a hundred times by chance.
    pub(super) fn agrees(&self) -> bool {
        self.agreement.is_none_or(|p| p >= DOUBT)
    }
}

/// Reads the reference of the arguments, which must fit the picture of `settings`.
pub(super) fn read(
    path: &Path,
    args: &BenchArgs,
    settings: &RenderSettings,
) -> Result<(Reference, ReferenceFacts), Failure> {
    let picture = read_picture(path).map_err(Status::Failed.because())?;
    let image = fitting(picture.image, settings)
        .with_context(|| format!("Cannot compare with '{}'", path.display()))
        .map_err(Status::Failed.because())?;
    let noise = args.reference_noise.unwrap_or(0.0);
    let facts = ReferenceFacts {
        file: Some(path.display().to_string()),
        mode: None,
        samples_per_pixel: None,
        rel_mse: noise,
        agreement: None,
        cpu_seconds: 0.0,
    };
    Ok((Reference::known(image, noise), facts))
}

/// The part of a whole picture that is rendered, or a picture of that part as it is.
fn fitting(image: Image<Rgb>, settings: &RenderSettings) -> anyhow::Result<Image<Rgb>> {
    let region = settings.active_region();
    let size = (image.width(), image.height());
    if size == (region.width as usize, region.height as usize) {
        return Ok(image);
    }
    if size == (settings.width as usize, settings.height as usize) {
        return Ok(image.part(region));
    }
    Err(anyhow!(
        "it has {}x{} pixels, the picture {}x{}; give --size",
        size.0,
        size.1,
        settings.width,
        settings.height
    ))
}

/// How a reference is made here.
pub(super) struct Recipe<'a> {
    pub(super) mode: Mode,
    /// Seed of the runs that are scored against it; its own are others.
    pub(super) seed: u64,
    /// Samples in each pixel, both halves together.
    pub(super) samples: u32,
    /// Seconds on the wall, after which it does with fewer samples.
    pub(super) time_limit: Option<f64>,
    pub(super) stop: &'a (dyn Fn() -> bool + Sync),
}

/// Renders a reference in two halves; `None` when stopped. `on_step` is told the fraction that is
/// done.
pub(super) fn make(
    bench: &Workbench,
    recipe: &Recipe<'_>,
    on_step: &mut dyn FnMut(f64),
) -> Option<(Reference, ReferenceFacts)> {
    let (mode, seed) = (recipe.mode, recipe.seed.wrapping_add(SEEDS));
    let half = recipe.samples.div_ceil(2);
    let mut first = bench.begin_as(mode, None, seed);
    let started = Instant::now();
    let mut target = 0;
    while target < half {
        let next = next_step(target, half);
        let after = started.elapsed().as_secs_f64() * f64::from(next) / f64::from(target.max(1));
        let is_too_long = |limit: f64| after > 0.5 * limit;
        if target > 0 && recipe.time_limit.is_some_and(is_too_long) {
            break;
        }
        if !bench.advance(&mut first, next, recipe.stop) {
            return None;
        }
        target = next;
        on_step(0.5 * f64::from(target) / f64::from(half));
    }
    let mut second = bench.begin_as(mode, None, seed.wrapping_add(1));
    while second.samples_per_pixel() < target {
        let next = next_step(second.samples_per_pixel(), half).min(target);
        if !bench.advance(&mut second, next, recipe.stop) {
            return None;
        }
        on_step(0.5 + 0.5 * f64::from(next) / f64::from(target));
    }
    let reference = Reference::from_halves(&first.image(), &second.image())
        .expect("two pictures of the same finite film");
    let facts = ReferenceFacts {
        file: None,
        mode: Some(mode.name()),
        samples_per_pixel: Some(2 * target),
        rel_mse: reference.noise.rel_mse,
        agreement: reference.agreement,
        cpu_seconds: first.cpu_seconds() + second.cpu_seconds(),
    };
    Some((reference, facts))
}

/// Twice as many samples, but not much more than a sixteenth of all: somebody wants to see progress.
fn next_step(done: u32, all: u32) -> u32 {
    let step = done.clamp(1, all.div_ceil(16).max(1));
    done.saturating_add(step).min(all)
}

#[cfg(test)]
mod tests {
    use softbox::image::Region;

    use super::*;

    #[test]
    fn the_rendered_part_is_cut_out_of_a_whole_reference() {
        let pixels = (0..12).map(|i| Rgb::splat(i as f32)).collect();
        let image = Image::from_pixels(4, 3, pixels);
        let mut settings = RenderSettings {
            width: 4,
            height: 3,
            ..RenderSettings::default()
        };
        assert_eq!(fitting(image.clone(), &settings).unwrap(), image);
        settings.region = Some(Region {
            x: 1,
            y: 1,
            width: 2,
            height: 2,
        });
        let part = fitting(image.clone(), &settings).unwrap();
        let values: Vec<f32> = part.pixels().iter().map(|p| p.x).collect();
        assert_eq!(values, [5.0, 6.0, 9.0, 10.0]);
        assert_eq!(fitting(part.clone(), &settings).unwrap(), part);
        settings.height = 5;
        let error = fitting(image, &settings).unwrap_err().to_string();
        assert!(error.contains("4x3") && error.contains("4x5"), "{error}");
    }
}
