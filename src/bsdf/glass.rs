use glam::Vec3;

use super::BsdfSample;
use super::fresnel;
use super::mirror::reflect;
use super::refraction::{eta_far_over_near, transmit};
use crate::color::Rgb;

/// A smooth dielectric that reflects and transmits by Fresnel's equations.
///
/// Radiance is scaled on transmission as in [`super::Refraction`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glass {
    /// Tint of reflected light, 0..1.
    pub reflectance: Rgb,
    /// Tint of transmitted light, 0..1.
    pub transmittance: Rgb,
    /// Index of refraction of the inside relative to the outside, positive.
    pub ior: f32,
}

impl Glass {
    /// A boundary with the given tints to a medium of index `ior`.
    pub const fn new(reflectance: Rgb, transmittance: Rgb, ior: f32) -> Self {
        Self {
            reflectance,
            transmittance,
            ior,
        }
    }

    /// Reflects with the probability that its share of the light has, tints included.
    pub(super) fn sample(&self, wo: Vec3, u_lobe: f32) -> Option<BsdfSample> {
        let eta = eta_far_over_near(wo, self.ior);
        let boundary = fresnel::dielectric(wo.z.abs(), eta);
        let reflected = self.reflectance * boundary.reflected;
        let transmitted = self.transmittance * (1.0 - boundary.reflected);
        let (r, t) = (reflected.max_element(), transmitted.max_element());
        let probability = r / (r + t);
        if !probability.is_finite() {
            return None;
        }
        if u_lobe < probability {
            reflect(wo, reflected / probability, probability)
        } else {
            let rest = t / (r + t);
            transmit(wo, boundary, eta, transmitted / rest, rest)
        }
    }

    /// The tints mixed as at normal incidence.
    pub(super) fn albedo(&self) -> Rgb {
        let reflected = fresnel::dielectric(1.0, self.ior).reflected;
        self.reflectance * reflected + self.transmittance * (1.0 - reflected)
    }
}
