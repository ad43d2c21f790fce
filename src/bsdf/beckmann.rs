use std::f32::consts::PI;
use std::f64::consts::FRAC_2_SQRT_PI;

use glam::{Vec2, Vec3};

use super::erf::{half_erfc_of_minus, inverse_erf, scaled_erfc};

/// Half the spacing 2⁻²⁴ of the random numbers.
const HALF_CELL: f64 = 1.0 / 33_554_432.0;

/// Beckmann's distribution of microfacet normals, isotropic.
///
/// All directions are in the local frame and, but for microfacet normals, have z > 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Beckmann {
    alpha: f32,
}

impl Beckmann {
    /// The root-mean-square slope `alpha`, kept at 10⁻³ or above.
    pub(super) fn new(alpha: f32) -> Self {
        Self {
            alpha: alpha.max(1e-3),
        }
    }

    pub(super) fn alpha(self) -> f32 {
        self.alpha
    }

    /// The area of microfacets with normal `m` per area and steradian, D(m).
    ///
    /// Walter, Marschner, Li, Torrance 2007, "Microfacet Models for Refraction through Rough
    /// Surfaces", equation 25.
    pub(super) fn density(self, m: Vec3) -> f32 {
        let alpha2 = self.alpha * self.alpha;
        let cos2 = m.z * m.z;
        let exponent = (m.x * m.x + m.y * m.y) / (cos2 * alpha2);
        if m.z > 0.0 && exponent < 80.0 {
            (-exponent).exp() / (PI * alpha2 * cos2 * cos2)
        } else {
            0.0
        }
    }

    /// Smith's Λ: masked over visible area of microfacets seen from `w`.
    ///
    /// Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs",
    /// equation 72, in closed form: ½(exp(−a²)/(a√π) − erfc a) with a = cot θ / α.
    pub(super) fn lambda(self, w: Vec3) -> f32 {
        let sin = w.x.hypot(w.y);
        let a = w.z / (self.alpha * sin);
        // Nothing left in f32; the normal itself, where a is infinite, is among these.
        if a >= 9.0 {
            return 0.0;
        }
        let over_a = 0.5 * FRAC_2_SQRT_PI as f32 / a;
        0.5 * (-a * a).exp() * (over_a - scaled_erfc(f64::from(a)) as f32)
    }

    /// The density per steradian of [`Self::sample_visible`] over 4(wo·m): what a reflection in `m`
    /// gives the direction wi. Heitz 2014, equation 2 and Walter et al. 2007, equation 14.
    pub(super) fn reflected_visible_density(self, wo: Vec3, m: Vec3) -> f32 {
        self.density(m) / (4.0 * (wo.z * (1.0 + self.lambda(wo))))
    }

    /// A microfacet normal distributed like those that `wo` sees.
    ///
    /// Heitz and d'Eon 2014, "Importance Sampling Microfacet-Based BSDFs using the Distribution of
    /// Visible Normals", section 3: stretch to α = 1, sample the slopes, unstretch.
    pub(super) fn sample_visible(self, wo: Vec3, u: Vec2) -> Vec3 {
        let stretched = Vec3::new(self.alpha * wo.x, self.alpha * wo.y, wo.z).normalize();
        let sin = stretched.x.hypot(stretched.y);
        let (cos_phi, sin_phi) = if sin > 0.0 {
            (stretched.x / sin, stretched.y / sin)
        } else {
            (1.0, 0.0)
        };
        let along = visible_slope(f64::from(stretched.z), f64::from(sin), f64::from(u.x)) as f32;
        let across = inverse_erf(2.0 * (f64::from(u.y) + HALF_CELL) - 1.0) as f32;
        let slope = Vec2::new(
            along * cos_phi - across * sin_phi,
            along * sin_phi + across * cos_phi,
        ) * self.alpha;
        Vec3::new(-slope.x, -slope.y, 1.0).normalize()
    }
}

/// The slope, towards the viewer, at which a share `u` of the area visible under (cos, sin) lies
/// below, for α = 1.
///
/// The visible area below slope x is ∫(cos − t sin)·exp(−t²)/√π dt from −∞ to x ≤ cot θ; it is
/// inverted by Newton's method inside a bracket.
fn visible_slope(cos: f64, sin: f64, u: f64) -> f64 {
    let visible_below = |x: f64| {
        let gauss = (-x * x).exp();
        let area = cos * half_erfc_of_minus(x, gauss) + sin * 0.25 * FRAC_2_SQRT_PI * gauss;
        let rate = (cos - x * sin) * 0.5 * FRAC_2_SQRT_PI * gauss;
        (area, rate)
    };
    let u = u + HALF_CELL;
    let (mut low, mut high) = (-6.0, (cos / sin).min(6.0));
    let total = visible_below(high).0;
    let target = u * total;
    // Exact at sin = 0 and at cos = 0.
    let guess = cos * inverse_erf(2.0 * u - 1.0) - sin * (-u.ln()).sqrt();
    let mut x = guess.clamp(low, high);
    for _ in 0..32 {
        let (area, rate) = visible_below(x);
        let error = area - target;
        if error.abs() < 1e-8 * total {
            break;
        }
        if error > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let newton = x - error / rate;
        x = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::ONE_MINUS_EPSILON;

    const ALPHAS: [f32; 6] = [1e-3, 0.01, 0.1, 0.3, 0.5, 1.0];

    fn view(cos: f32) -> Vec3 {
        let sin = ((1.0 - cos) * (1.0 + cos)).sqrt();
        Vec3::new(0.6 * sin, 0.8 * sin, cos)
    }

    /// Integrates `f` over microfacet normals in slope space, where the distribution is a Gauss bell:
    /// dm = cos³ dslope.
    fn integrate(alpha: f32, f: impl Fn(Vec3) -> f64) -> f64 {
        let n = 1200_i32;
        let step = 9.0 / f64::from(n);
        let mut sum = 0.0;
        for i in 0..n {
            for j in 0..n {
                let at = |k: i32| ((f64::from(k) + 0.5) * step - 4.5) as f32 * alpha;
                let m = Vec3::new(at(i), at(j), 1.0).normalize();
                sum += f(m) * f64::from(m.z).powi(3);
            }
        }
        sum * (step * f64::from(alpha)).powi(2)
    }

    #[test]
    fn projected_microfacet_area_is_one() {
        for alpha in ALPHAS {
            let beckmann = Beckmann::new(alpha);
            let area = integrate(alpha, |m| f64::from(beckmann.density(m) * m.z));
            assert!((area - 1.0).abs() < 1e-4, "{alpha}: {area}");
        }
    }

    /// Test S15 of the stress list, the weak white furnace: ∫ G1 (wo·m)⁺ D(m) dm = cos θo.
    #[test]
    fn visible_normals_are_normalised() {
        for alpha in ALPHAS {
            for cos in [0.02, 0.1, 0.5, 0.9, 1.0] {
                let (beckmann, wo) = (Beckmann::new(alpha), view(cos));
                let integral = integrate(alpha, |m| {
                    let visible = 4.0 * wo.dot(m).max(0.0);
                    f64::from(beckmann.reflected_visible_density(wo, m) * visible)
                });
                assert!((integral - 1.0).abs() < 1e-4, "{alpha} {cos}: {integral}");
            }
        }
    }

    #[test]
    fn slopes_are_inverted_to_the_accuracy_of_the_random_numbers() {
        for cos in [1.0, 0.9, 0.3, 1e-2, 1e-5, 0.0] {
            let sin = f64::sqrt(1.0 - cos * cos);
            let mut previous = f64::NEG_INFINITY;
            for i in 0..=1000 {
                let u = (f64::from(i) / 1000.0).min(f64::from(ONE_MINUS_EPSILON));
                let x = visible_slope(cos, sin, u);
                assert!(x.is_finite() && x > previous, "{cos} {u}: {x} {previous}");
                assert!(cos - x * sin >= 0.0, "{cos} {u}: {x} is hidden");
                previous = x;
            }
        }
    }

    /// Test S7 of the stress list for this warp.
    #[test]
    fn sampled_normals_are_finite_and_visible() {
        let edge = [0.0, f32::EPSILON * 0.5, 0.5, ONE_MINUS_EPSILON];
        for alpha in ALPHAS {
            for cos in [1.0, 0.7, 1e-2, 1e-6, 1e-20] {
                let wo = view(cos);
                for u in edge.iter().flat_map(|&x| edge.map(|y| Vec2::new(x, y))) {
                    let m = Beckmann::new(alpha).sample_visible(wo, u);
                    assert!(m.is_finite() && (m.length() - 1.0).abs() < 1e-6);
                    assert!(m.z > 0.0 && wo.dot(m) > -1e-6, "{alpha} {cos} {u} {m}");
                }
            }
        }
    }
}
