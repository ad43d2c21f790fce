use std::f32::consts::FRAC_1_PI;

use glam::{Vec2, Vec3};

use super::{BsdfSample, Lobe, same_side};
use crate::color::Rgb;
use crate::sampling::{cosine_hemisphere, cosine_hemisphere_pdf};

/// Lambertian reflection from both sides of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diffuse {
    /// Albedo, 0..1.
    pub reflectance: Rgb,
}

impl Diffuse {
    /// A Lambertian surface of albedo `reflectance`.
    pub const fn new(reflectance: Rgb) -> Self {
        Self { reflectance }
    }

    pub(super) fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if same_side(wo, wi) {
            self.reflectance * FRAC_1_PI
        } else {
            Rgb::ZERO
        }
    }

    pub(super) fn pdf(wo: Vec3, wi: Vec3) -> f32 {
        if same_side(wo, wi) {
            cosine_hemisphere_pdf(wi.z.abs())
        } else {
            0.0
        }
    }

    /// Cosine-distributed on the side of `wo`.
    pub(super) fn sample(&self, wo: Vec3, u: Vec2) -> Option<BsdfSample> {
        let mut wi = cosine_hemisphere(u);
        if wo.z < 0.0 {
            wi.z = -wi.z;
        }
        let pdf = Self::pdf(wo, wi);
        (pdf > 0.0).then(|| BsdfSample {
            wi,
            value: self.reflectance * FRAC_1_PI,
            pdf,
            lobe: Lobe::Diffuse,
        })
    }
}
