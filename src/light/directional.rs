use std::f32::consts::PI;

use glam::Vec3;

use super::LightSample;
use crate::color::{Rgb, luminance};

/// Parallel light from infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight {
    /// Unit direction towards the light.
    pub to_light: Vec3,
    /// Irradiance on a surface that faces the light.
    pub irradiance: Rgb,
}

impl DirectionalLight {
    pub(super) fn sample(&self) -> LightSample {
        LightSample {
            wi: self.to_light,
            distance: f32::INFINITY,
            radiance: self.irradiance,
            pdf: 1.0,
            is_delta: true,
            point: Vec3::ZERO,
            normal: Vec3::ZERO,
        }
    }

    pub(super) fn power(&self, scene_radius: f32) -> f32 {
        PI * scene_radius * scene_radius * luminance(self.irradiance)
    }
}
