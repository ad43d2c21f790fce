use glam::Vec2;
use rayon::prelude::*;

use super::workers::Workers;
use crate::camera::RayCamera;
use crate::color::Rgb;
use crate::integrator::first_hit;
use crate::scene::PreparedScene;
use crate::settings::View;

/// One ray through the centre of every pixel; `None` when `stop` said so, asked before each row.
pub(super) fn first_hit_pass(
    workers: &Workers,
    scene: &PreparedScene,
    camera: &RayCamera,
    (view, size): (View, [u32; 2]),
    stop: &(dyn Fn() -> bool + Sync),
) -> Option<Vec<Rgb>> {
    let width = size[0] as usize;
    let mut pixels = vec![Rgb::ZERO; width * size[1] as usize];
    let is_whole = workers.install(|| {
        pixels.par_chunks_mut(width).enumerate().all(|(y, row)| {
            if stop() {
                return false;
            }
            for (x, out) in row.iter_mut().enumerate() {
                *out = first_hit(
                    scene,
                    camera,
                    view,
                    Vec2::new(x as f32 + 0.5, y as f32 + 0.5),
                );
            }
            true
        })
    });
    is_whole.then_some(pixels)
}
