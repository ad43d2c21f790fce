//! A sphere that emits, sampled by the cone it fills, in double precision.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::frame::Frame;
use super::light::LightSample;
use super::warp;
use crate::geometry::Sphere;
use crate::light::SphereLight;

/// Points nearer to the sphere than this, relative to its radius, lie on it.
const ON_SURFACE: f64 = 1e-9;

/// Outside: even over the cone (Pharr, Jakob, Humphreys 2016, section 14.2.2); on and inside a
/// sphere that emits inwards: even over all directions.
pub(super) fn sample(
    light: &SphereLight,
    sphere: &Sphere,
    from: DVec3,
    u: DVec2,
) -> Option<LightSample> {
    let to_center = sphere.center.as_dvec3() - from;
    let radius = f64::from(sphere.radius);
    let (wi, is_near) = match one_minus_cos(to_center, radius) {
        Some(width) => {
            let local = warp::at_cosine(1.0 - u.x * width, u.y);
            let frame = Frame::from_normal(to_center.normalize());
            (frame.to_world(local), true)
        }
        None => (warp::sphere(u), false),
    };
    let along = to_center.dot(wi);
    let off_axis = (to_center - along * wi).length_squared();
    let half_chord = (radius * radius - off_axis).max(0.0).sqrt();
    let distance = along + if is_near { -half_chord } else { half_chord };
    let normal = (wi * distance - to_center).normalize();
    let pdf = pdf(light, sphere, from);
    (distance > 0.0 && pdf > 0.0).then(|| LightSample {
        wi,
        radiance: light.radiance.as_dvec3(),
        pdf,
        is_delta: false,
        end: Some((from + wi * distance, normal)),
    })
}

/// Density of [`sample`] for a direction that meets the emitting side.
pub(super) fn pdf(light: &SphereLight, sphere: &Sphere, from: DVec3) -> f64 {
    let to_center = sphere.center.as_dvec3() - from;
    match one_minus_cos(to_center, f64::from(sphere.radius)) {
        Some(width) => 1.0 / (TAU * width),
        None if light.two_sided => warp::SPHERE_PDF,
        None => 0.0,
    }
}

/// 1 − cos of the half angle of the cone that the sphere fills; `None` on and inside the sphere.
fn one_minus_cos(to_center: DVec3, radius: f64) -> Option<f64> {
    let sin = radius / to_center.length();
    let cos = ((1.0 - sin) * (1.0 + sin)).max(0.0).sqrt();
    (sin < 1.0 - ON_SURFACE).then(|| sin * sin / (1.0 + cos))
}
