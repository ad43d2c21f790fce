use std::f32::consts::TAU;

use glam::{Vec2, Vec3};

use crate::math::Frame;
use crate::sampling::uniform_disk;

/// The directions in which a sphere is seen; from inside the half of all that faces its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Towards the centre, unit.
    pub axis: Vec3,
    /// 1 − cos of the half angle, 0 to 1.
    pub height: f32,
}

impl Cone {
    /// The cone that the sphere around `center` fills, seen from `from`; `radius2` is its radius
    /// squared, above 0.
    pub fn new(from: Vec3, center: Vec3, radius2: f32) -> Self {
        let to = center - from;
        Self {
            axis: to.normalize_or(Vec3::Z),
            height: height(to.length_squared(), radius2),
        }
    }

    /// A unit direction of the cone, evenly spread over the solid angle; `u` in [0, 1)².
    pub fn sample(&self, u: Vec2) -> Vec3 {
        let disk = uniform_disk(u);
        let h = disk.length_squared() * self.height;
        let side = disk * (self.height * (2.0 - h)).sqrt();
        Frame::from_normal(self.axis).to_world(side.extend(1.0 - h))
    }

    /// Solid angle in steradians.
    pub fn solid_angle(&self) -> f32 {
        TAU * self.height
    }
}

/// 1 − cos of the half angle under which a sphere is seen, without cancellation.
#[inline(always)]
pub(super) fn height(distance2: f32, radius2: f32) -> f32 {
    let ratio = radius2 / distance2;
    let sin2 = if ratio < 1.0 { ratio } else { 1.0 };
    sin2 / (1.0 + (1.0 - sin2).sqrt())
}
