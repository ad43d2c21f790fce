use super::ONE_MINUS_EPSILON;
use super::bilinear::{LEAST_SUM, MOST_SUM};
use super::warp::{COS_EIGHTH, LATTICE_CELL, SIN_EIGHTH};
use crate::math::{Lanes, Vec3Lanes};

/// [`super::cosine_hemisphere`] of eight points at once, the same bits.
#[inline(always)]
pub fn cosine_hemisphere_lanes<L: Lanes>(u: [L; 2]) -> Vec3Lanes<L> {
    let (x, y) = (centred(u[0]), centred(u[1]));
    let is_wide = x.abs().gt(y.abs());
    let radius = L::select(is_wide, x, y);
    let (sin, cos) = sin_cos_eighth(L::select(is_wide, y, x) / radius);
    let z = ((L::splat(1.0) - radius) * (L::splat(1.0) + radius)).sqrt();
    let (dx, dy) = (L::select(is_wide, cos, sin), L::select(is_wide, sin, cos));
    Vec3Lanes::new(radius * dx, radius * dy, z)
}

/// From [0, 1) to (−1, 1), never 0.
#[inline(always)]
fn centred<L: Lanes>(u: L) -> L {
    L::splat(2.0) * u - L::splat(1.0) + L::splat(LATTICE_CELL)
}

/// Eight of [`super::Bilinear`], the same bits.
#[derive(Clone, Copy, Debug)]
pub struct BilinearLanes<L> {
    shares: [L; 4],
}

impl<L: Lanes> BilinearLanes<L> {
    /// The densities, and where they are usable.
    #[inline(always)]
    pub fn new([w00, w10, w01, w11]: [L; 4]) -> (Self, L::Mask) {
        let sum = (w00 + w10) + (w01 + w11);
        let is_usable = sum.ge(L::splat(LEAST_SUM)) & sum.lt(L::splat(MOST_SUM));
        let shares = [w00 / sum, w10 / sum, w01 / sum, w11 / sum];
        (Self { shares }, is_usable)
    }

    /// As [`super::Bilinear::sample`].
    #[inline(always)]
    pub fn sample(&self, u: [L; 2]) -> [L; 2] {
        let [s00, s10, s01, s11] = self.shares;
        let y = sample_linear(u[1], s00 + s10, s01 + s11);
        [sample_linear(u[0], mix(s00, s01, y), mix(s10, s11, y)), y]
    }

    /// As [`super::Bilinear::pdf`].
    #[inline(always)]
    pub fn pdf(&self, place: [L; 2]) -> L {
        let [s00, s10, s01, s11] = self.shares;
        let [x, y] = place;
        L::splat(4.0) * mix(mix(s00, s01, y), mix(s10, s11, y), x)
    }
}

#[inline(always)]
fn mix<L: Lanes>(a: L, b: L, t: L) -> L {
    (L::splat(1.0) - t) * a + t * b
}

#[inline(always)]
fn sample_linear<L: Lanes>(u: L, a: L, b: L) -> L {
    let x = u * (a + b) / (a + mix(a * a, b * b, u).sqrt());
    x.min(L::splat(ONE_MINUS_EPSILON))
}

#[inline(always)]
fn sin_cos_eighth<L: Lanes>(x: L) -> (L, L) {
    let x2 = x * x;
    let s = |i: usize| L::splat(SIN_EIGHTH[i]);
    let c = |i: usize| L::splat(COS_EIGHTH[i]);
    (
        x * (s(0) + x2 * (s(1) + x2 * (s(2) + x2 * s(3)))),
        c(0) + x2 * (c(1) + x2 * (c(2) + x2 * (c(3) + x2 * c(4)))),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Isa, LaneKernel, ROW, Vec3Array, run_lanes};
    use crate::sampling::{PathSampler, Slot, cosine_hemisphere};
    use glam::Vec2;

    struct Warp([[f32; ROW]; 2]);

    impl LaneKernel for Warp {
        type Answer = Vec3Array;

        fn run<L: Lanes>(self) -> Self::Answer {
            cosine_hemisphere_lanes(self.0.map(|u| L::load_row(&u))).store()
        }
    }

    #[test]
    fn lanes_are_warped_like_single_points() {
        let ends = [0.0, 0.5, 0.25, 1.0 - f32::EPSILON * 0.5];
        let grid = ends.into_iter().flat_map(|x| ends.map(|y| Vec2::new(x, y)));
        let spread = (0..4000).map(|i| PathSampler::new(3, [i, 0], 0).get_2d(0, Slot::Scatter));
        let points: Vec<Vec2> = grid.chain(spread).collect();
        for eight in points.chunks_exact(8) {
            let u = [0, 1].map(|axis| std::array::from_fn(|lane| eight[lane % 8][axis]));
            for isa in Isa::available() {
                let warped = run_lanes(isa, Warp(u));
                for (lane, &u) in eight.iter().enumerate() {
                    let bits = warped.get(lane).to_array().map(f32::to_bits);
                    assert_eq!(
                        bits,
                        cosine_hemisphere(u).to_array().map(f32::to_bits),
                        "{u}"
                    );
                }
            }
        }
    }
}
