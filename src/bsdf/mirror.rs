use glam::Vec3;

use super::{BsdfSample, Lobe};
use crate::color::Rgb;

/// Perfect reflection from both sides of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirror {
    /// Reflectance at every angle, 0..1.
    pub reflectance: Rgb,
}

impl Mirror {
    /// A mirror of reflectance `reflectance`.
    pub const fn new(reflectance: Rgb) -> Self {
        Self { reflectance }
    }

    pub(super) fn sample(&self, wo: Vec3) -> Option<BsdfSample> {
        reflect(wo, self.reflectance, 1.0)
    }
}

/// The delta sample in the mirror direction of `wo`; `None` along the surface.
pub(super) fn reflect(wo: Vec3, weight: Rgb, probability: f32) -> Option<BsdfSample> {
    (wo.z != 0.0).then(|| BsdfSample {
        wi: Vec3::new(-wo.x, -wo.y, wo.z),
        value: weight,
        pdf: probability,
        lobe: Lobe::Delta,
    })
}
