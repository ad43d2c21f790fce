use std::f32::consts::{FRAC_1_PI, FRAC_PI_4, TAU};

use glam::{Vec2, Vec3};

/// The spacing 2⁻²⁴ of the numbers that [`super::PathSampler`] gives.
pub(super) const LATTICE_CELL: f32 = 1.0 / 16_777_216.0;

/// The density of [`uniform_hemisphere`] per steradian.
pub const UNIFORM_HEMISPHERE_PDF: f32 = 1.0 / TAU;

/// The density of [`uniform_sphere`] per steradian.
pub const UNIFORM_SPHERE_PDF: f32 = 0.5 / TAU;

/// A unit vector with z ≥ 0, evenly spread over the solid angle.
pub fn uniform_hemisphere(u: Vec2) -> Vec3 {
    spherical((1.0 - u.x) * (1.0 + u.x), u.x, u.y)
}

/// A unit vector, evenly spread over the sphere.
pub fn uniform_sphere(u: Vec2) -> Vec3 {
    spherical(4.0 * u.x * (1.0 - u.x), 1.0 - 2.0 * u.x, u.y)
}

/// A point of the unit disk, evenly spread over its area (density 1/π).
///
/// Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square". Both coordinates are taken
/// at the middle of their lattice cell, so that the centre is never returned.
pub fn uniform_disk(u: Vec2) -> Vec2 {
    let (radius, direction) = concentric(u);
    radius * direction
}

/// A unit vector with z > 0 and density cos θ / π per steradian.
///
/// Malley's method: the disk lifted to the hemisphere (Pharr, Jakob, Humphreys 2016, section 13.6.3).
pub fn cosine_hemisphere(u: Vec2) -> Vec3 {
    let (radius, direction) = concentric(u);
    // Not from x² + y²: the factored form keeps z exact, and above zero, near the horizon.
    let z = ((1.0 - radius) * (1.0 + radius)).sqrt();
    (radius * direction).extend(z)
}

/// The density of [`cosine_hemisphere`] per steradian at cos θ = `cos_theta`; 0 below the horizon.
pub fn cosine_hemisphere_pdf(cos_theta: f32) -> f32 {
    cos_theta.max(0.0) * FRAC_1_PI
}

/// Barycentric weights of the second and third vertex of a point evenly spread over a triangle; the
/// weight of the first is `1 − b1 − b2`; none is negative.
///
/// Heitz 2019, "A Low-Distortion Map Between Triangle and Square".
pub fn uniform_triangle(u: Vec2) -> (f32, f32) {
    if u.y > u.x {
        let b1 = 0.5 * u.x;
        (b1, u.y - b1)
    } else {
        let b2 = 0.5 * u.y;
        (u.x - b2, b2)
    }
}

/// A unit vector evenly spread over the solid angle of the cone about +z that ends at
/// cos θ = 1 − `one_minus_cos_max`, which lies in (0, 2].
///
/// The cosine enters as its distance from one so that narrow cones keep their precision.
pub fn uniform_cone(u: Vec2, one_minus_cos_max: f32) -> Vec3 {
    let h = u.x * one_minus_cos_max;
    spherical(h * (2.0 - h), 1.0 - h, u.y)
}

/// The density of [`uniform_cone`] per steradian, inside the cone.
pub fn uniform_cone_pdf(one_minus_cos_max: f32) -> f32 {
    1.0 / (TAU * one_minus_cos_max)
}

fn spherical(sin2_theta: f32, cos_theta: f32, u_phi: f32) -> Vec3 {
    let sin_theta = sin2_theta.max(0.0).sqrt();
    let (sin_phi, cos_phi) = (TAU * u_phi).sin_cos();
    Vec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta)
}

/// Signed radius in (−1, 1), never 0, and unit direction of the concentric map.
fn concentric(u: Vec2) -> (f32, Vec2) {
    let p = 2.0 * u - Vec2::ONE + Vec2::splat(LATTICE_CELL);
    let is_wide = p.x.abs() > p.y.abs();
    let (radius, other) = if is_wide { (p.x, p.y) } else { (p.y, p.x) };
    let (sin, cos) = sin_cos_eighth(other / radius);
    // The angle is that from the axis of the larger coordinate.
    let direction = if is_wide { (cos, sin) } else { (sin, cos) };
    (radius, direction.into())
}

/// Sine and cosine of π/4 · `x` for `x` in [−1, 1], to about the last bit: the same bits everywhere,
/// which library functions do not promise, and in lanes too ([`super::lanes`]).
fn sin_cos_eighth(x: f32) -> (f32, f32) {
    let x2 = x * x;
    let [s0, s1, s2, s3] = SIN_EIGHTH;
    let [c0, c1, c2, c3, c4] = COS_EIGHTH;
    (
        x * (s0 + x2 * (s1 + x2 * (s2 + x2 * s3))),
        c0 + x2 * (c1 + x2 * (c2 + x2 * (c3 + x2 * c4))),
    )
}

/// Of sin(π/4 · x) / x as a polynomial of x², the one that is least wrong over [−1, 1].
pub(super) const SIN_EIGHTH: [f32; 4] = [FRAC_PI_4, -0.080_745_436, 0.002_490_007, -3.595_451e-5];

/// Of cos(π/4 · x), likewise.
pub(super) const COS_EIGHTH: [f32; 5] = [
    1.0,
    -0.308_425_13,
    0.015_854_325,
    -0.000_325_938_63,
    3.529_811_2e-6,
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{ONE_MINUS_EPSILON, PathSampler, Slot};

    #[test]
    fn the_polynomials_are_sine_and_cosine() {
        for i in -100_000..=100_000_i32 {
            let x = i as f32 / 100_000.0;
            let (sin, cos) = sin_cos_eighth(x);
            let phi = std::f64::consts::FRAC_PI_4 * f64::from(x);
            assert!((f64::from(sin) - phi.sin()).abs() < 1e-7, "{x}");
            assert!((f64::from(cos) - phi.cos()).abs() < 1e-7, "{x}");
        }
    }

    /// The corners and neighbourhood of the lattice {0, 2⁻²⁴, …, 1 − 2⁻²⁴}², and a spread of it.
    fn lattice() -> impl Iterator<Item = Vec2> {
        let cell = LATTICE_CELL;
        let edge = [
            0.0,
            cell,
            2.0 * cell,
            1.0 / 3.0,
            0.5 - cell,
            0.5,
            0.5 + cell,
            0.75,
            ONE_MINUS_EPSILON - cell,
            ONE_MINUS_EPSILON,
        ];
        let spread = (0..200_000).map(|i| PathSampler::new(3, [i, 0], 0).get_2d(0, Slot::Scatter));
        edge.into_iter()
            .flat_map(move |x| edge.into_iter().map(move |y| Vec2::new(x, y)))
            .chain(spread)
    }

    fn is_unit(v: Vec3) -> bool {
        v.is_finite() && (v.length() - 1.0).abs() < 1e-6
    }

    /// Test S7 of the stress list.
    #[test]
    fn warps_stay_on_their_domains() {
        for u in lattice() {
            let hemisphere = uniform_hemisphere(u);
            assert!(is_unit(hemisphere) && hemisphere.z >= 0.0, "{u}");
            assert!(is_unit(uniform_sphere(u)), "{u}");
            let cosine = cosine_hemisphere(u);
            assert!(
                is_unit(cosine) && cosine_hemisphere_pdf(cosine.z) > 0.0,
                "{u}"
            );
            assert!(uniform_disk(u).length() <= 1.0, "{u}");
            let (b1, b2) = uniform_triangle(u);
            assert!(b1 >= 0.0 && b2 >= 0.0 && 1.0 - b1 - b2 >= 0.0, "{u}");
            for width in [1e-12, 1e-6, 0.3, 1.0, 2.0] {
                let w = uniform_cone(u, width);
                assert!(is_unit(w) && w.z >= 1.0 - width - 1e-7, "{u} {width}");
            }
        }
    }

    #[test]
    fn narrow_cones_keep_their_opening() {
        let width = 1e-10_f32;
        let rim = uniform_cone(Vec2::new(ONE_MINUS_EPSILON, 0.0), width);
        let expected = (2.0 * width).sqrt();
        assert!((rim.x / expected - 1.0).abs() < 1e-5, "{rim}");
    }

    #[test]
    fn means_are_those_of_the_densities() {
        const N: u16 = 512;
        let mut sums = [0.0_f64; 4];
        for i in 0..N {
            for j in 0..N {
                let u = Vec2::new(f32::from(i) + 0.5, f32::from(j) + 0.5) / f32::from(N);
                sums[0] += f64::from(cosine_hemisphere(u).z);
                sums[1] += f64::from(uniform_hemisphere(u).z);
                sums[2] += f64::from(uniform_disk(u).length_squared());
                sums[3] += f64::from(uniform_triangle(u).0);
            }
        }
        let expected = [2.0 / 3.0, 0.5, 0.5, 1.0 / 3.0];
        for (sum, mean) in sums.into_iter().zip(expected) {
            assert!((sum / f64::from(N).powi(2) - mean).abs() < 1e-4, "{sums:?}");
        }
    }
}
