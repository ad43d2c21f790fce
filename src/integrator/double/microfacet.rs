//! A rough conductor, in double precision.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::error_function::{bisect, erf_and_erfc};
use super::warp::HALF_CELL;
use crate::bsdf::Microfacet;

/// Smith's Λ of Beckmann's distribution. Heitz 2014, "Understanding the Masking-Shadowing Function
/// in Microfacet-Based BRDFs", equation 72.
fn lambda(alpha: f64, w: DVec3) -> f64 {
    let sin = w.x.hypot(w.y);
    if sin == 0.0 {
        return 0.0;
    }
    let a = w.z / (alpha * sin);
    0.5 * ((-a * a).exp() / (a * PI.sqrt()) - erf_and_erfc(a).1)
}

/// Beckmann's D. Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces",
/// equation 25.
fn density(alpha: f64, m: DVec3) -> f64 {
    let tan2 = (m.x * m.x + m.y * m.y) / (m.z * m.z);
    (-tan2 / (alpha * alpha)).exp() / (PI * alpha * alpha * m.z.powi(4))
}

/// Value without the cosine, and density of the sampling; `None` unless both lie on one side.
///
/// f = F D G / (4 cos cos) with Smith's height-correlated G = 1 / (1 + Λo + Λi); the density is that
/// of visible normals, D G1 (wo·m) / cos, over 4 (wo·m). Heitz 2014, equations 15, 99 and 2.
pub(super) fn eval_and_pdf(bsdf: &Microfacet, wo: DVec3, wi: DVec3) -> Option<(DVec3, f64)> {
    if wo.z * wi.z <= 0.0 {
        return None;
    }
    let (wo, wi) = (above(wo), above(wi));
    let alpha = f64::from(bsdf.alpha());
    let m = (wo + wi).normalize();
    let d = density(alpha, m);
    let (hidden_o, hidden_i) = (lambda(alpha, wo), lambda(alpha, wi));
    let geometry = d / (4.0 * wo.z * wi.z * (1.0 + hidden_o + hidden_i));
    let pdf = d / (4.0 * wo.z * (1.0 + hidden_o));
    Some((fresnel(bsdf, wo.dot(m)) * geometry, pdf))
}

/// Reflects `wo` in a visible normal. Heitz and d'Eon 2014, "Importance Sampling Microfacet-Based
/// BSDFs using the Distribution of Visible Normals".
pub(super) fn sample(bsdf: &Microfacet, wo: DVec3, u: DVec2) -> Option<DVec3> {
    if wo.z == 0.0 {
        return None;
    }
    let alpha = f64::from(bsdf.alpha());
    let view = above(wo);
    let stretched = DVec3::new(alpha * view.x, alpha * view.y, view.z).normalize();
    let sin = stretched.x.hypot(stretched.y);
    let towards_view = if sin > 0.0 {
        DVec2::new(stretched.x, stretched.y) / sin
    } else {
        DVec2::X
    };
    let along = visible_slope(stretched.z, sin, u.x + HALF_CELL);
    let across_share = 2.0 * (u.y + HALF_CELL) - 1.0;
    let across = bisect(-6.0, 6.0, |x| erf_and_erfc(x).0 - across_share);
    let slope = alpha * (along * towards_view + across * towards_view.perp());
    let m = DVec3::new(-slope.x, -slope.y, 1.0).normalize();
    let wi = 2.0 * view.dot(m) * m - view;
    (wi.z > 0.0).then(|| DVec3::new(wi.x, wi.y, wi.z.copysign(wo.z)))
}

/// The slope below which the share `u` of the area lies that is visible under (cos, sin), α = 1:
/// A(x) = ∫(cos − t sin) exp(−t²)/√π dt from −∞ to x, up to x = cot θ where facets turn away.
fn visible_slope(cos: f64, sin: f64, u: f64) -> f64 {
    let area = |x: f64| 0.5 * cos * erf_and_erfc(-x).1 + 0.5 * sin * (-x * x).exp() / PI.sqrt();
    let end = (cos / sin).min(6.0);
    let target = u * area(end);
    bisect(-6.0, end, |x| area(x) - target)
}

/// Fresnel's equations with a complex index in complex arithmetic, the mean of both polarisations.
/// Born and Wolf 1999, "Principles of Optics", section 14.4.
fn fresnel(bsdf: &Microfacet, cos: f64) -> DVec3 {
    let (eta, k) = (bsdf.eta().as_dvec3(), bsdf.k().as_dvec3());
    let cos = cos.clamp(0.0, 1.0);
    let channel = |i: usize| {
        let square = complex_product((eta[i], k[i]), (eta[i], k[i]));
        let root = complex_root((square.0 - (1.0 - cos * cos), square.1));
        let reflected = |near: (f64, f64), far: (f64, f64)| {
            let difference = (near.0 - far.0).powi(2) + (near.1 - far.1).powi(2);
            let sum = (near.0 + far.0).powi(2) + (near.1 + far.1).powi(2);
            difference / sum
        };
        let perpendicular = reflected((cos, 0.0), root);
        let parallel = reflected((square.0 * cos, square.1 * cos), root);
        0.5 * (perpendicular + parallel)
    };
    DVec3::new(channel(0), channel(1), channel(2))
}

fn complex_product(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

/// The square root in the first quadrant, of a number in the upper half plane.
fn complex_root(z: (f64, f64)) -> (f64, f64) {
    let modulus = z.0.hypot(z.1);
    (
        (0.5 * (modulus + z.0)).max(0.0).sqrt(),
        (0.5 * (modulus - z.0)).max(0.0).sqrt(),
    )
}

fn above(w: DVec3) -> DVec3 {
    DVec3::new(w.x, w.y, w.z.abs())
}
