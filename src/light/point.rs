use std::f32::consts::PI;

use glam::Vec3;

use super::{EmissionBounds, LightSample, direction_to};
use crate::color::{Rgb, luminance};

/// How the light of a point fades with the distance r.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PointFalloff {
    /// 1 / r².
    #[default]
    Correct,
    /// Not at all, as in the course's program. Only for reproducing its pictures.
    Course,
}

/// A point that shines evenly in all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    /// Place.
    pub position: Vec3,
    /// Radiant intensity (per steradian) in scene units: irradiance is intensity / distance².
    pub intensity: Rgb,
    /// How it fades; with [`PointFalloff::Course`] the irradiance is `intensity` everywhere.
    pub falloff: PointFalloff,
}

impl PointLight {
    pub(super) fn sample(&self, from: Vec3) -> Option<LightSample> {
        sample_point(from, self.position, |_, distance| match self.falloff {
            PointFalloff::Correct => self.intensity / distance / distance,
            PointFalloff::Course => self.intensity,
        })
    }

    pub(super) fn power(&self) -> f32 {
        4.0 * PI * luminance(self.intensity)
    }

    pub(super) fn bounds(&self) -> Option<EmissionBounds> {
        EmissionBounds::round(self.position, 0.0, luminance(self.intensity))
    }
}

/// The delta sample of a light at `position`; `irradiance` depends on the direction to the light
/// and its distance. `None` where it is black, or at the light itself.
pub(super) fn sample_point(
    from: Vec3,
    position: Vec3,
    irradiance: impl Fn(Vec3, f32) -> Rgb,
) -> Option<LightSample> {
    let (wi, distance) = direction_to(from, position)?;
    let radiance = irradiance(wi, distance);
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
