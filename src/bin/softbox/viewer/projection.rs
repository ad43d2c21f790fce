//! Points of tracing space on the screen, and lines and triangles between them.

use eframe::egui::{self, epaint::Vertex};
use eframe::egui::{Color32, Mesh, Pos2, Stroke, pos2};
use glam::{DVec3, Vec3};
use softbox::camera::Camera;
use softbox::math::Normalization;

use super::letterbox::Letterbox;

/// The camera's view of tracing space on the screen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Projector {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    half_extent: (f64, f64),
    letterbox: Letterbox,
    near: f64,
}

impl Projector {
    /// The projection of `camera` into `letterbox` for a scene moved by `normalization`.
    pub(super) fn new(
        camera: &Camera,
        letterbox: Letterbox,
        normalization: &Normalization,
    ) -> Self {
        let (right, up, back) = camera.basis();
        let [width, height] = letterbox.image;
        let distance = camera.eye.distance(camera.target) * normalization.scale;
        Self {
            eye: normalization.point_to_scene_f64(camera.eye),
            right,
            up,
            forward: -back,
            half_extent: camera.half_extent(width, height),
            letterbox,
            near: distance * 1e-3,
        }
    }

    /// Right, up and forward coordinates as the camera sees them.
    fn to_camera(self, point: Vec3) -> DVec3 {
        let offset = point.as_dvec3() - self.eye;
        DVec3::new(
            offset.dot(self.right),
            offset.dot(self.up),
            offset.dot(self.forward),
        )
    }

    fn to_screen(self, seen: DVec3) -> Pos2 {
        let x = seen.x / (seen.z * self.half_extent.0);
        let y = seen.y / (seen.z * self.half_extent.1);
        let rect = self.letterbox.rect;
        pos2(
            rect.center().x + 0.5 * rect.width() * x as f32,
            rect.center().y - 0.5 * rect.height() * y as f32,
        )
    }

    /// The visible part of a segment on the screen; `None` when all of it is behind the eye.
    pub(super) fn segment(&self, ends: [Vec3; 2]) -> Option<[Pos2; 2]> {
        let [a, b] = ends.map(|point| self.to_camera(point));
        if a.z < self.near && b.z < self.near {
            return None;
        }
        let clipped = |inside: DVec3, outside: DVec3| {
            let t = (self.near - inside.z) / (outside.z - inside.z);
            inside.lerp(outside, t)
        };
        let a_shown = if a.z < self.near { clipped(b, a) } else { a };
        let b_shown = if b.z < self.near { clipped(a, b) } else { b };
        Some([self.to_screen(a_shown), self.to_screen(b_shown)])
    }

    /// A triangle on the screen; `None` when a corner is behind the eye.
    pub(super) fn triangle(&self, corners: [Vec3; 3]) -> Option<[Pos2; 3]> {
        let seen = corners.map(|point| self.to_camera(point));
        seen.iter()
            .all(|point| point.z >= self.near)
            .then(|| seen.map(|point| self.to_screen(point)))
    }
}

/// Adds a line as a thin rectangle.
pub(super) fn add_line(mesh: &mut Mesh, projector: &Projector, ends: [Vec3; 2], stroke: Stroke) {
    let Some([a, b]) = projector.segment(ends) else {
        return;
    };
    let along = (b - a).normalized();
    let side = along.rot90() * (0.5 * stroke.width);
    let first = mesh.vertices.len() as u32;
    for pos in [a + side, a - side, b + side, b - side] {
        add_vertex(mesh, pos, stroke.color);
    }
    mesh.add_triangle(first, first + 1, first + 2);
    mesh.add_triangle(first + 1, first + 2, first + 3);
}

/// Adds a filled triangle.
pub(super) fn add_triangle(
    mesh: &mut Mesh,
    projector: &Projector,
    corners: [Vec3; 3],
    color: Color32,
) {
    let Some(corners) = projector.triangle(corners) else {
        return;
    };
    let first = mesh.vertices.len() as u32;
    for pos in corners {
        add_vertex(mesh, pos, color);
    }
    mesh.add_triangle(first, first + 1, first + 2);
}

fn add_vertex(mesh: &mut Mesh, pos: Pos2, color: Color32) {
    mesh.vertices.push(Vertex {
        pos,
        uv: egui::epaint::WHITE_UV,
        color,
    });
}
