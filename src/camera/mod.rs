//! Floor 3: the camera. `Camera` is what people edit, in file coordinates and double precision;
//! `RayCamera` makes rays in tracing space.

mod lanes;
mod ray_camera;

pub use ray_camera::RayCamera;

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// How the picture's size and the opening angle hang together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Framing {
    /// The full horizontal angle in radians stays, whatever the size.
    Horizontal(f64),
    /// The course's rule: the distance of the image plane in pixels stays, so that a smaller
    /// picture is cut out of a larger one.
    ScreenDistance(f64),
}

/// A perspective camera with a thin lens, in file coordinates (Y up).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// Position of the lens centre.
    pub eye: DVec3,
    /// Point in the middle of the picture and pivot of orbiting; differs from `eye`.
    pub target: DVec3,
    /// Any direction that shall point upwards in the picture, not parallel to the view.
    pub up: DVec3,
    /// Opening angle.
    pub framing: Framing,
    /// Radius of the lens; 0 = pinhole.
    pub lens_radius: f64,
    /// Distance of the plane in focus from the eye, along the view direction.
    pub focal_distance: f64,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            eye: DVec3::new(0.0, 0.0, 1.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            framing: Framing::Horizontal(50_f64.to_radians()),
            lens_radius: 0.0,
            focal_distance: 4.7,
        }
    }
}

impl Camera {
    /// Half the picture's width at unit distance, and half its height, for a picture of
    /// `width` × `height` pixels.
    pub fn half_extent(&self, width: u32, height: u32) -> (f64, f64) {
        let (width, height) = (f64::from(width.max(1)), f64::from(height.max(1)));
        match self.framing {
            Framing::Horizontal(angle) => {
                let half = (angle * 0.5).tan();
                (half, half * height / width)
            }
            Framing::ScreenDistance(pixels) => (width * 0.5 / pixels, height * 0.5 / pixels),
        }
    }

    /// Right, up and backward unit vectors of the camera. Falls back to some upright frame where
    /// eye, target and up do not span one.
    pub fn basis(&self) -> (DVec3, DVec3, DVec3) {
        let back = (self.eye - self.target).try_normalize().unwrap_or(DVec3::Z);
        let right = self
            .up
            .cross(back)
            .try_normalize()
            .or_else(|| DVec3::Z.cross(back).try_normalize())
            .unwrap_or(DVec3::X);
        (right, back.cross(right), back)
    }

    /// True when every number is usable: finite, eye apart from target, a positive angle below 180°.
    pub fn is_valid(&self) -> bool {
        let angle_is_valid = match self.framing {
            Framing::Horizontal(angle) => angle > 0.0 && angle < std::f64::consts::PI,
            Framing::ScreenDistance(pixels) => pixels > 0.0 && pixels.is_finite(),
        };
        angle_is_valid
            && self.eye.is_finite()
            && self.target.is_finite()
            && self.up.is_finite()
            && self.eye != self.target
            && self.lens_radius >= 0.0
            && self.lens_radius.is_finite()
            && self.focal_distance > 0.0
            && self.focal_distance.is_finite()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn horizontal_framing_keeps_the_angle_and_screen_distance_crops() {
        let mut camera = Camera {
            framing: Framing::Horizontal(90_f64.to_radians()),
            ..Camera::default()
        };
        let (x, y) = camera.half_extent(800, 400);
        assert!((x - 1.0).abs() < 1e-12 && (y - 0.5).abs() < 1e-12);
        // The course's Cornell boxes: screen distance 875 gives 37.85° at 800×600, 23.26° at 480×360.
        camera.framing = Framing::ScreenDistance(875.0);
        let vertical = |w, h| 2.0 * camera.half_extent(w, h).1.atan().to_degrees();
        assert!((vertical(800, 600) - 37.85).abs() < 0.01);
        assert!((vertical(480, 360) - 23.26).abs() < 0.02);
    }

    #[test]
    fn the_basis_is_right_handed_even_when_up_is_parallel_to_the_view() {
        for up in [DVec3::Y, DVec3::Z, DVec3::ZERO] {
            let (right, up, back) = Camera {
                up,
                ..Camera::default()
            }
            .basis();
            assert!((right.cross(up) - back).length() < 1e-12);
        }
    }
}
