//! The scattering models in the frame of the shading normal, in double precision.

use std::f64::consts::FRAC_1_PI;

use glam::{DVec2, DVec3};

use super::{delta, microfacet, warp};
use crate::bsdf::Bsdf;

/// A scattered direction.
#[derive(Clone, Copy, Debug)]
pub(super) enum Scattered {
    /// The only direction of its lobe; `weight` is value · |cos| / probability.
    Delta { wi: DVec3, weight: DVec3 },
    /// One of many: value without the cosine, and density per steradian.
    Smooth { wi: DVec3, value: DVec3, pdf: f64 },
}

/// Value without the cosine and density of [`sample`] for a pair of directions; black and 0 where
/// nothing is scattered and for delta lobes.
pub(super) fn eval_and_pdf(bsdf: &Bsdf, wo: DVec3, wi: DVec3) -> (DVec3, f64) {
    match bsdf {
        Bsdf::Diffuse(diffuse) if wo.z * wi.z > 0.0 => (
            diffuse.reflectance.as_dvec3() * FRAC_1_PI,
            wi.z.abs() * FRAC_1_PI,
        ),
        Bsdf::Microfacet(rough) => {
            microfacet::eval_and_pdf(rough, wo, wi).unwrap_or((DVec3::ZERO, 0.0))
        }
        Bsdf::Diffuse(_) | Bsdf::Mirror(_) | Bsdf::Refraction(_) | Bsdf::Glass(_) => {
            (DVec3::ZERO, 0.0)
        }
    }
}

/// The direction that `u_lobe` and `u` stand for; `None` where nothing is scattered.
pub(super) fn sample(bsdf: &Bsdf, wo: DVec3, u_lobe: f64, u: DVec2) -> Option<Scattered> {
    match bsdf {
        Bsdf::Diffuse(_) => {
            let up = warp::cosine_hemisphere(u);
            smooth(bsdf, wo, DVec3::new(up.x, up.y, up.z.copysign(wo.z)))
        }
        Bsdf::Microfacet(rough) => smooth(bsdf, wo, microfacet::sample(rough, wo, u)?),
        Bsdf::Mirror(mirror) => Some(delta::mirror(mirror, wo)),
        Bsdf::Refraction(refraction) => Some(delta::refraction(refraction, wo)),
        Bsdf::Glass(glass) => delta::glass(glass, wo, u_lobe),
    }
}

fn smooth(bsdf: &Bsdf, wo: DVec3, wi: DVec3) -> Option<Scattered> {
    let (value, pdf) = eval_and_pdf(bsdf, wo, wi);
    (pdf > 0.0).then_some(Scattered::Smooth { wi, value, pdf })
}
