use glam::Vec2;
use rayon::prelude::*;

use super::pace::MAX_PREVIEW_STEP;
use super::workers::Workers;
use crate::camera::RayCamera;
use crate::color::Rgb;
use crate::integrator::{PathCounts, PathId, PathTracer, first_hit};
use crate::scene::PreparedScene;
use crate::settings::{IntegratorKind, View};

/// Paths that one worker takes at a time; small, so that all workers end together.
const CHUNK: usize = 256;

/// A coarse picture: one value for each square of `step` × `step` pixels.
#[derive(Clone, Debug)]
pub(super) struct Preview {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) step: u32,
    pub(super) pixels: Vec<Rgb>,
}

impl Preview {
    /// The value for pixel `x`, `y` of the whole picture.
    pub(super) fn at(&self, x: u32, y: u32) -> Rgb {
        let (x, y) = ((x / self.step) as usize, (y / self.step) as usize);
        self.pixels[y.min(self.height - 1) * self.width + x.min(self.width - 1)]
    }

    fn new(size: [u32; 2], step: u32) -> Self {
        let step = step.clamp(1, MAX_PREVIEW_STEP);
        let (width, height) = (
            size[0].div_ceil(step) as usize,
            size[1].div_ceil(step) as usize,
        );
        Self {
            width,
            height,
            step,
            pixels: vec![Rgb::ZERO; width * height],
        }
    }

    /// The pixel of the whole picture in the middle of square number `index`.
    fn pixel(&self, index: usize, size: [u32; 2]) -> [u32; 2] {
        let (x, y) = ((index % self.width) as u32, (index / self.width) as u32);
        [
            (x * self.step + self.step / 2).min(size[0] - 1),
            (y * self.step + self.step / 2).min(size[1] - 1),
        ]
    }

    /// A whole picture, as a preview of one pixel a square.
    pub(super) fn of_picture(width: usize, height: usize, pixels: Vec<Rgb>) -> Self {
        Self {
            width,
            height,
            step: 1,
            pixels,
        }
    }

    /// One path for each square; `None` when `stop` said so, asked before each chunk of paths.
    pub(super) fn render(
        workers: &Workers,
        tracer: &PathTracer<'_>,
        (size, step): ([u32; 2], u32),
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Option<Self> {
        let mut preview = Self::new(size, step);
        let ids: Vec<PathId> = (0..preview.pixels.len())
            .map(|index| PathId {
                pixel: preview.pixel(index, size),
                sample: 0,
            })
            .collect();
        let is_whole = workers.install(|| {
            let chunks = preview
                .pixels
                .par_chunks_mut(CHUNK)
                .zip(ids.par_chunks(CHUNK));
            chunks
                .map(|(out, ids)| !stop() && fill(workers, tracer, ids, out))
                .all(|is_whole| is_whole)
        });
        is_whole.then_some(preview)
    }

    /// The same for a view of the first hit.
    pub(super) fn render_first_hit(
        workers: &Workers,
        scene: &PreparedScene,
        camera: &RayCamera,
        view: View,
        (size, step): ([u32; 2], u32),
    ) -> Self {
        let mut preview = Self::new(size, step);
        let pixels: Vec<[u32; 2]> = (0..preview.pixels.len())
            .map(|index| preview.pixel(index, size))
            .collect();
        workers.install(|| {
            preview
                .pixels
                .par_iter_mut()
                .zip(&pixels)
                .with_min_len(CHUNK)
                .for_each(|(out, pixel)| {
                    let center = Vec2::new(pixel[0] as f32 + 0.5, pixel[1] as f32 + 0.5);
                    *out = first_hit(scene, camera, view, center);
                });
        });
        preview
    }
}

/// Traces one chunk; true.
fn fill(workers: &Workers, tracer: &PathTracer<'_>, ids: &[PathId], out: &mut [Rgb]) -> bool {
    workers.with_arrays(|arrays| {
        arrays.ids.clear();
        arrays.ids.extend_from_slice(ids);
        // What a preview costs is no work of the picture.
        arrays.trace(
            tracer,
            IntegratorKind::Wavefront,
            &mut PathCounts::default(),
        );
        out.copy_from_slice(&arrays.radiance);
    });
    true
}
