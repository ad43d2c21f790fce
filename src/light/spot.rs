use std::f32::consts::TAU;

use glam::Vec3;

use super::point::sample_point;
use super::{EmissionBounds, LightSample};
use crate::color::{Rgb, luminance};

/// A point that shines into a cone, by a power of the cosine to its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotLight {
    /// Place.
    pub position: Vec3,
    /// Unit direction of the axis, away from the light.
    pub axis: Vec3,
    /// Radiant intensity on the axis, in scene units as for [`super::PointLight`].
    pub intensity: Rgb,
    /// Cosine of half the opening angle, in 0..1.
    pub cos_half_angle: f32,
    /// Exponent of the cosine; 0 = even inside the cone.
    pub exponent: f32,
}

impl SpotLight {
    /// The intensity towards `direction`, a unit vector away from the light.
    pub fn intensity_towards(&self, direction: Vec3) -> Rgb {
        let cos = self.axis.dot(direction);
        if cos > 0.0 && cos >= self.cos_half_angle {
            self.intensity * cos.powf(self.exponent)
        } else {
            Rgb::ZERO
        }
    }

    pub(super) fn sample(&self, from: Vec3) -> Option<LightSample> {
        sample_point(from, self.position, |wi, distance| {
            self.intensity_towards(-wi) / distance / distance
        })
    }

    /// ∫ cosᵉ over the cone is 2π (1 − cosᵉ⁺¹ of the rim) / (e + 1).
    pub(super) fn power(&self) -> f32 {
        let e = self.exponent + 1.0;
        let rim = self.cos_half_angle.clamp(0.0, 1.0);
        TAU * (1.0 - rim.powf(e)) / e * luminance(self.intensity)
    }

    pub(super) fn bounds(&self) -> Option<EmissionBounds> {
        let intensity = luminance(self.intensity);
        EmissionBounds::cone(self.position, self.axis, self.cos_half_angle, intensity)
    }
}
