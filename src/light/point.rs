use std::f32::consts::PI;

use glam::Vec3;

use super::{LightSample, direction_to};
use crate::color::{Rgb, luminance};

/// A point that shines evenly in all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    /// Place.
    pub position: Vec3,
    /// Radiant intensity (per steradian) in scene units: irradiance is intensity / distance².
    pub intensity: Rgb,
}

impl PointLight {
    pub(super) fn sample(&self, from: Vec3) -> Option<LightSample> {
        sample_point(from, self.position, |_| self.intensity)
    }

    pub(super) fn power(&self) -> f32 {
        4.0 * PI * luminance(self.intensity)
    }
}

/// The delta sample of a light at `position` that has the given intensity along `wi`; `None` where
/// it is black, or at the light itself.
pub(super) fn sample_point(
    from: Vec3,
    position: Vec3,
    intensity_along: impl Fn(Vec3) -> Rgb,
) -> Option<LightSample> {
    let (wi, distance) = direction_to(from, position)?;
    let radiance = intensity_along(wi) / distance / distance;
    (radiance.is_finite() && radiance.max_element() > 0.0).then_some(LightSample {
        wi,
        distance,
        radiance,
        pdf: 1.0,
        is_delta: true,
        point: position,
        normal: Vec3::ZERO,
    })
}
