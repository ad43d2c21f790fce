use glam::Vec3;

use super::fresnel::{self, Boundary};
use super::mirror::reflect;
use super::{BsdfSample, Lobe};
use crate::color::Rgb;

/// A smooth dielectric that transmits all light, but for total reflection.
///
/// The normal points out of the medium. A transmitted ray carries radiance scaled by
/// (n_near / n_far)², n_near being the index on the side of `wo`: what is conserved along a ray is
/// radiance over n² (Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation",
/// section 5.2). The factors multiply to 1 over a path that enters and leaves, so a camera in the
/// air sees a constant environment unchanged through any closed object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refraction {
    /// Tint of transmitted light, 0..1; total reflection is untinted.
    pub transmittance: Rgb,
    /// Index of refraction of the inside relative to the outside, positive.
    pub ior: f32,
}

impl Refraction {
    /// A boundary of tint `transmittance` to a medium of index `ior`.
    pub const fn new(transmittance: Rgb, ior: f32) -> Self {
        Self { transmittance, ior }
    }

    pub(super) fn sample(&self, wo: Vec3) -> Option<BsdfSample> {
        let eta = eta_far_over_near(wo, self.ior);
        let boundary = fresnel::dielectric(wo.z.abs(), eta);
        if boundary.cos_transmitted > 0.0 {
            transmit(wo, boundary, eta, self.transmittance, 1.0)
        } else {
            reflect(wo, Rgb::ONE, 1.0)
        }
    }
}

/// The index beyond the surface over that on the side of `wo`.
pub(super) fn eta_far_over_near(wo: Vec3, ior: f32) -> f32 {
    if wo.z > 0.0 { ior } else { 1.0 / ior }
}

/// The delta sample in the refracted direction of `wo`, radiance scaled by 1/η².
pub(super) fn transmit(
    wo: Vec3,
    boundary: Boundary,
    eta: f32,
    weight: Rgb,
    probability: f32,
) -> Option<BsdfSample> {
    (boundary.cos_transmitted > 0.0 && wo.z != 0.0).then(|| BsdfSample {
        wi: Vec3::new(
            -wo.x / eta,
            -wo.y / eta,
            -boundary.cos_transmitted.copysign(wo.z),
        ),
        value: weight / (eta * eta),
        pdf: probability,
        lobe: Lobe::Delta,
    })
}
