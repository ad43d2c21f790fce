//! Perfect mirrors and smooth dielectrics, in double precision.

use glam::DVec3;

use super::bsdf::Scattered;
use crate::bsdf::{Glass, Mirror, Refraction};

pub(super) fn mirror(mirror: &Mirror, wo: DVec3) -> Scattered {
    reflect(wo, mirror.reflectance.as_dvec3())
}

pub(super) fn refraction(refraction: &Refraction, wo: DVec3) -> Scattered {
    let eta = far_over_near(wo, f64::from(refraction.ior));
    match transmitted_cosine(wo, eta) {
        Some(cos) => transmit(wo, eta, cos, refraction.transmittance.as_dvec3()),
        None => reflect(wo, DVec3::ONE),
    }
}

/// Reflects with the share of the brightest channel that reflection has.
pub(super) fn glass(glass: &Glass, wo: DVec3, u_lobe: f64) -> Option<Scattered> {
    let eta = far_over_near(wo, f64::from(glass.ior));
    let cos_transmitted = transmitted_cosine(wo, eta);
    let reflected_share = cos_transmitted.map_or(1.0, |cos| fresnel(wo.z.abs(), cos, eta));
    let reflected = glass.reflectance.as_dvec3() * reflected_share;
    let transmitted = glass.transmittance.as_dvec3() * (1.0 - reflected_share);
    let (r, t) = (reflected.max_element(), transmitted.max_element());
    if r + t <= 0.0 {
        return None;
    }
    let probability = r / (r + t);
    if u_lobe < probability {
        Some(reflect(wo, reflected / probability))
    } else {
        cos_transmitted.map(|cos| transmit(wo, eta, cos, transmitted / (1.0 - probability)))
    }
}

fn reflect(wo: DVec3, weight: DVec3) -> Scattered {
    Scattered::Delta {
        wi: DVec3::new(-wo.x, -wo.y, wo.z),
        weight,
    }
}

/// Radiance over the square of the index is what is conserved along a ray. Veach 1997, "Robust Monte
/// Carlo Methods for Light Transport Simulation", section 5.2.
fn transmit(wo: DVec3, eta: f64, cos: f64, weight: DVec3) -> Scattered {
    Scattered::Delta {
        wi: DVec3::new(-wo.x / eta, -wo.y / eta, -cos.copysign(wo.z)),
        weight: weight / (eta * eta),
    }
}

/// The index beyond the surface over that on the side of `wo`; the normal points out of the medium.
fn far_over_near(wo: DVec3, ior: f64) -> f64 {
    if wo.z > 0.0 { ior } else { 1.0 / ior }
}

/// Snell's law; `None` under total reflection.
fn transmitted_cosine(wo: DVec3, eta: f64) -> Option<f64> {
    let sin2 = (wo.x * wo.x + wo.y * wo.y) / (eta * eta);
    (sin2 < 1.0).then(|| (1.0 - sin2).sqrt())
}

/// Fresnel's equations, the mean of both polarisations. Born and Wolf 1999, "Principles of Optics",
/// section 1.5.2.
fn fresnel(cos_near: f64, cos_far: f64, eta: f64) -> f64 {
    let perpendicular = (cos_near - eta * cos_far) / (cos_near + eta * cos_far);
    let parallel = (eta * cos_near - cos_far) / (eta * cos_near + cos_far);
    0.5 * (perpendicular * perpendicular + parallel * parallel)
}
