use glam::Vec2;

use super::ONE_MINUS_EPSILON;

/// Neither a sum of weights nor its inverse may overflow.
pub(super) const LEAST_SUM: f32 = 1e-30;
/// As [`LEAST_SUM`].
pub(super) const MOST_SUM: f32 = 1e30;

/// A density over the unit square that is bilinear between its values at the corners.
///
/// Pharr, Jakob and Humphreys 2023, "Physically Based Rendering", section A.5.2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bilinear {
    /// Shares of the corners (0, 0), (1, 0), (0, 1), (1, 1); they add to 1.
    shares: [f32; 4],
}

impl Bilinear {
    /// The density in proportion to `weights` at the corners (0, 0), (1, 0), (0, 1), (1, 1), none of
    /// them negative; `None` when their sum is not finite and above 0.
    pub fn new(weights: [f32; 4]) -> Option<Self> {
        let [w00, w10, w01, w11] = weights;
        let sum = (w00 + w10) + (w01 + w11);
        (LEAST_SUM..MOST_SUM).contains(&sum).then(|| Self {
            shares: [w00, w10, w01, w11].map(|w| w / sum),
        })
    }

    /// The point of the square that belongs to `u` in [0, 1)²: for a rising coordinate of `u` that of
    /// the point rises. Where all corners weigh the same it is `u` up to rounding.
    pub fn sample(&self, u: Vec2) -> Vec2 {
        let [s00, s10, s01, s11] = self.shares;
        let y = sample_linear(u.y, s00 + s10, s01 + s11);
        let x = sample_linear(u.x, mix(s00, s01, y), mix(s10, s11, y));
        Vec2::new(x, y)
    }

    /// The density per area at `place` in the square, with mean 1.
    pub fn pdf(&self, place: Vec2) -> f32 {
        let [s00, s10, s01, s11] = self.shares;
        4.0 * mix(mix(s00, s01, place.y), mix(s10, s11, place.y), place.x)
    }
}

/// `a` at 0, `b` at 1.
fn mix(a: f32, b: f32, t: f32) -> f32 {
    (1.0 - t) * a + t * b
}

/// In [0, 1), with a density that goes from `a` at 0 to `b` at 1, neither negative.
fn sample_linear(u: f32, a: f32, b: f32) -> f32 {
    // The root of the quadratic that does not cancel.
    let x = u * (a + b) / (a + mix(a * a, b * b, u).sqrt());
    x.min(ONE_MINUS_EPSILON)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_corners_leave_the_numbers_alone() {
        let even = Bilinear::new([7.0; 4]).expect("positive");
        for u in [
            Vec2::ZERO,
            Vec2::new(0.25, 0.9),
            Vec2::splat(ONE_MINUS_EPSILON),
        ] {
            assert!((even.sample(u) - u).abs().max_element() < 1e-6);
            assert_eq!(even.pdf(u), 1.0);
        }
    }

    /// The area below a sampled coordinate is the number it came from, also next to corners of weight
    /// zero.
    #[test]
    fn samples_invert_the_distribution() {
        for weights in [
            [1.0, 2.0, 3.0, 4.0],
            [0.0, 0.0, 1.0, 5.0],
            [1e-12, 3.0, 0.0, 1e-6],
            [0.0, 1.0, 0.0, 0.0],
        ] {
            let density = Bilinear::new(weights).expect("positive");
            let sum: f32 = weights.iter().sum();
            for i in 1..40 {
                let u = Vec2::new((i * 7 % 40) as f32, i as f32) / 40.0;
                let p = density.sample(u);
                let (low, high) = (weights[0] + weights[1], weights[2] + weights[3]);
                let below = (low * (p.y - 0.5 * p.y * p.y) + high * 0.5 * p.y * p.y) * 2.0 / sum;
                assert!((below - u.y).abs() < 1e-5, "{weights:?} {u}: {below}");
                let left = mix(weights[0], weights[2], p.y);
                let right = mix(weights[1], weights[3], p.y);
                let below = (left * (p.x - 0.5 * p.x * p.x) + right * 0.5 * p.x * p.x) * 2.0
                    / (left + right);
                assert!((below - u.x).abs() < 1e-5, "{weights:?} {u}: {below}");
                assert!(density.pdf(p) > 0.0);
            }
        }
    }

    #[test]
    fn the_whole_lattice_stays_in_the_square() {
        let density = Bilinear::new([0.0, 0.0, 0.0, 1.0]).expect("positive");
        let edge = [0.0, 1.0 / 16_777_216.0, 0.5, ONE_MINUS_EPSILON];
        for u in edge.into_iter().flat_map(|x| edge.map(|y| Vec2::new(x, y))) {
            let p = density.sample(u);
            assert!(p.min_element() >= 0.0 && p.max_element() < 1.0, "{u}: {p}");
        }
        assert!(Bilinear::new([0.0; 4]).is_none());
        assert!(Bilinear::new([f32::NAN, 1.0, 1.0, 1.0]).is_none());
        assert!(Bilinear::new([f32::INFINITY, 1.0, 1.0, 1.0]).is_none());
    }
}
