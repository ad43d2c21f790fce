//! From a film to a snapshot.

use rayon::prelude::*;

use super::preview::Preview;
use super::workers::Workers;
use super::{RenderJob, SampleCounts, Snapshot};
use crate::color::Rgb;
use crate::film::{Film, FilmSummary, PixelStats};
use crate::settings::View;

/// What a snapshot says beside its pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Caption<'a> {
    pub(super) job: &'a RenderJob,
    pub(super) generation: u64,
    pub(super) seconds: f64,
    pub(super) cpu_seconds: f64,
}

impl Caption<'_> {
    /// A picture of single values: a preview or a view of the first hit.
    pub(super) fn plain(
        &self,
        (width, height): (usize, usize),
        pixels: Vec<Rgb>,
        is_preview: bool,
    ) -> Snapshot {
        let settings = &self.job.settings;
        Snapshot {
            generation: self.generation,
            width,
            height,
            image_size: [settings.width, settings.height],
            is_preview,
            view: settings.view,
            pixels,
            samples: SampleCounts::Uniform(u32::from(!is_preview)),
            noise: None,
            samples_mean: f64::from(u8::from(!is_preview)),
            samples_max: 1,
            seconds: self.seconds,
            cpu_seconds: self.cpu_seconds,
            relative_error: None,
            camera: self.job.camera,
            settings: settings.clone(),
        }
    }

    /// The picture so far. Where the film has no sample yet, `backdrop` shows through.
    pub(super) fn film(
        &self,
        workers: &Workers,
        film: &Film,
        summary: &FilmSummary,
        backdrop: Option<&Preview>,
    ) -> Snapshot {
        let settings = &self.job.settings;
        let (width, height) = (settings.width as usize, settings.height as usize);
        let background = |x: u32, y: u32| backdrop.map_or(Rgb::ZERO, |preview| preview.at(x, y));
        let pixels = assemble(workers, film, (width, height), background, |pixel, x, y| {
            if pixel.count() == 0 {
                background(x, y)
            } else {
                pixel.radiance()
            }
        });
        let covers_picture =
            film.region().width as usize == width && film.region().height as usize == height;
        let is_uniform =
            covers_picture && summary.samples == u64::from(summary.most) * summary.pixels;
        let samples = if is_uniform {
            SampleCounts::Uniform(summary.most)
        } else {
            SampleCounts::PerPixel(assemble(
                workers,
                film,
                (width, height),
                |_, _| 0,
                |pixel, _, _| pixel.count(),
            ))
        };
        let noise = (settings.view == View::Noise).then(|| {
            let (rows, region) = (film.rows(), film.region());
            assemble(
                workers,
                film,
                (width, height),
                |_, _| 0.0,
                |_, x, y| {
                    let pooled = rows.pooled((x - region.x) as usize, (y - region.y) as usize);
                    pooled.map_or(1.0, |pooled| pooled.relative_error() as f32)
                },
            )
        });
        Snapshot {
            generation: self.generation,
            width,
            height,
            image_size: [settings.width, settings.height],
            is_preview: false,
            view: settings.view,
            pixels,
            samples,
            noise,
            samples_mean: summary.samples as f64 / summary.pixels.max(1) as f64,
            samples_max: summary.most,
            seconds: self.seconds,
            cpu_seconds: self.cpu_seconds,
            relative_error: summary.relative_error,
            camera: self.job.camera,
            settings: settings.clone(),
        }
    }
}

/// One value for each pixel of the whole picture, row by row.
fn assemble<T: Copy + Default + Send>(
    workers: &Workers,
    film: &Film,
    (width, height): (usize, usize),
    outside: impl Fn(u32, u32) -> T + Sync,
    value: impl Fn(&PixelStats, u32, u32) -> T + Sync,
) -> Vec<T> {
    let region = film.region();
    let mut out = vec![T::default(); width * height];
    workers.install(|| {
        out.par_chunks_mut(width)
            .with_min_len(16)
            .enumerate()
            .for_each(|(y, row)| {
                let y = y as u32;
                if !region.contains(region.x, y) {
                    row.iter_mut()
                        .enumerate()
                        .for_each(|(x, out)| *out = outside(x as u32, y));
                    return;
                }
                let right = (region.x + region.width) as usize;
                for x in (0..region.x as usize).chain(right..width) {
                    row[x] = outside(x as u32, y);
                }
                for tile in film.tiles_of_row(y) {
                    let area = tile.area();
                    let start = tile.index(area.x, y);
                    for (i, pixel) in tile.pixels()[start..start + area.width as usize]
                        .iter()
                        .enumerate()
                    {
                        let x = area.x + i as u32;
                        row[x as usize] = value(pixel, x, y);
                    }
                }
            });
    });
    out
}
