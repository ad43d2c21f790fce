//! The course's logged rays: every five-hundredth camera ray of a picture, kept while the camera
//! moves on, so that one can look at them from the side.

use eframe::egui::{self, Color32, Mesh, Shape, Stroke};
use glam::{Vec2, Vec3};
use softbox::camera::{Camera, RayCamera};
use softbox::scene::PreparedScene;

use super::letterbox::Letterbox;
use super::projection::{Projector, add_line};

/// One ray in this many is kept, as in the course.
const STRIDE: u32 = 500;
/// Rays that meet nothing are drawn this long in tracing space, beyond the whole scene.
const MISS_LENGTH: f32 = 4.0;

const HIT: Color32 = Color32::from_rgb(255, 255, 0);
const MISS: Color32 = Color32::from_rgb(255, 0, 0);

/// A ray as it is drawn, in tracing space.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LoggedRay {
    ends: [Vec3; 2],
    is_hit: bool,
}

/// The rays that are shown; none while the log is off.
#[derive(Clone, Debug, Default)]
pub(super) struct RayLog {
    rays: Vec<LoggedRay>,
}

impl RayLog {
    /// True when rays are shown.
    pub(super) fn is_on(&self) -> bool {
        !self.rays.is_empty()
    }

    /// Hides the rays.
    pub(super) fn clear(&mut self) {
        self.rays.clear();
    }

    /// Keeps rays through the middles of the pixels of a picture of `size` pixels.
    pub(super) fn log(&mut self, scene: &PreparedScene, camera: &Camera, size: [u32; 2]) {
        let [width, height] = size;
        let ray_camera = RayCamera::new(camera, width, height, scene.normalization());
        let pixels = (0..width * height).step_by(STRIDE as usize);
        self.rays = pixels
            .map(|pixel| {
                let position =
                    Vec2::new((pixel % width) as f32 + 0.5, (pixel / width) as f32 + 0.5);
                let ray = ray_camera.generate_ray(position, || Vec2::ZERO);
                let hit = scene.aggregate().closest(&ray);
                let t = if hit.is_miss() { MISS_LENGTH } else { hit.t };
                LoggedRay {
                    ends: [ray.origin, ray.at(t)],
                    is_hit: !hit.is_miss(),
                }
            })
            .collect();
    }

    /// Draws the rays over the picture: hits yellow, misses red.
    pub(super) fn paint(
        &self,
        painter: &egui::Painter,
        scene: &PreparedScene,
        camera: &Camera,
        at: Letterbox,
    ) {
        if self.rays.is_empty() {
            return;
        }
        let projector = Projector::new(camera, at, scene.normalization());
        let mut mesh = Mesh::default();
        for ray in &self.rays {
            let color = if ray.is_hit { HIT } else { MISS };
            add_line(&mut mesh, &projector, ray.ends, Stroke::new(1.0, color));
        }
        painter.with_clip_rect(at.rect).add(Shape::mesh(mesh));
    }

    /// How many rays are shown, and how many of them met something.
    #[cfg(test)]
    pub(super) fn counts(&self) -> (usize, usize) {
        (
            self.rays.len(),
            self.rays.iter().filter(|ray| ray.is_hit).count(),
        )
    }
}
