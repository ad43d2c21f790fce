//! Random numbers to directions and points, in double precision.

use std::f64::consts::{FRAC_PI_4, TAU};

use glam::{DVec2, DVec3};

/// Half the spacing 2⁻²⁴ of the random numbers: to the middle of their lattice cell.
pub(super) const HALF_CELL: f64 = 1.0 / 33_554_432.0;

/// Density of the even hemisphere, per steradian.
pub(super) const HEMISPHERE_PDF: f64 = 1.0 / TAU;
/// Density of the even sphere, per steradian.
pub(super) const SPHERE_PDF: f64 = 1.0 / (2.0 * TAU);

/// The direction with cosine `cos` to +z and azimuth 2π `u`.
pub(super) fn at_cosine(cos: f64, u: f64) -> DVec3 {
    let sin = ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt();
    let (sin_phi, cos_phi) = (TAU * u).sin_cos();
    DVec3::new(sin * cos_phi, sin * sin_phi, cos)
}

/// Even over the hemisphere z ≥ 0.
pub(super) fn hemisphere(u: DVec2) -> DVec3 {
    at_cosine(u.x, u.y)
}

/// Even over the sphere.
pub(super) fn sphere(u: DVec2) -> DVec3 {
    at_cosine(1.0 - 2.0 * u.x, u.y)
}

/// Even over the unit disk. Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square".
pub(super) fn disk(u: DVec2) -> DVec2 {
    let p = 2.0 * (u + DVec2::splat(HALF_CELL)) - DVec2::ONE;
    if p.x.abs() > p.y.abs() {
        p.x * DVec2::from_angle(FRAC_PI_4 * p.y / p.x)
    } else {
        p.y * DVec2::from_angle(FRAC_PI_4 * (2.0 - p.x / p.y))
    }
}

/// With density cos θ / π: the disk lifted to the hemisphere (Malley's method).
pub(super) fn cosine_hemisphere(u: DVec2) -> DVec3 {
    let p = disk(u);
    p.extend((1.0 - p.length_squared()).max(0.0).sqrt())
}

/// Weights of the second and third vertex of a point even over a triangle. Heitz 2019, "A
/// Low-Distortion Map Between Triangle and Square".
pub(super) fn triangle(u: DVec2) -> (f64, f64) {
    if u.y > u.x {
        (0.5 * u.x, u.y - 0.5 * u.x)
    } else {
        (u.x - 0.5 * u.y, 0.5 * u.y)
    }
}

/// The weight of a sample of density `a` that another strategy draws with density `b`. Veach and
/// Guibas 1995, "Optimally Combining Sampling Techniques for Monte Carlo Rendering".
pub(super) fn power_heuristic(a: f64, b: f64) -> f64 {
    if a > 0.0 {
        a * a / (a * a + b * b)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{self, PathSampler, Slot};

    #[test]
    fn warps_give_what_single_precision_gives() {
        for i in 0..10_000 {
            let u = PathSampler::new(1, [i, 0], 0).get_2d(0, Slot::Scatter);
            let d = u.as_dvec2();
            let pairs = [
                (hemisphere(d), sampling::uniform_hemisphere(u)),
                (sphere(d), sampling::uniform_sphere(u)),
                (cosine_hemisphere(d), sampling::cosine_hemisphere(u)),
                (disk(d).extend(0.0), sampling::uniform_disk(u).extend(0.0)),
            ];
            for (ours, theirs) in pairs {
                assert!((ours - theirs.as_dvec3()).length() < 2e-6, "{u}: {ours}");
            }
            let (b1, b2) = sampling::uniform_triangle(u);
            let ours = triangle(d);
            assert!((ours.0 - f64::from(b1)).abs() + (ours.1 - f64::from(b2)).abs() < 1e-6);
        }
    }
}
