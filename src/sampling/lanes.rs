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
    use crate::math::{Isa, LANES, LaneKernel, Vec3Array, run_lanes};
    use crate::sampling::{PathSampler, Slot, cosine_hemisphere};
    use glam::Vec2;

    struct Warp([[f32; LANES]; 2]);

    impl LaneKernel for Warp {
        type Answer = Vec3Array;

        fn run<L: Lanes>(self) -> Self::Answer {
            cosine_hemisphere_lanes(self.0.map(|u| L::load(&u))).store()
        }
    }

    #[test]
    fn lanes_are_warped_like_single_points() {
        let ends = [0.0, 0.5, 0.25, 1.0 - f32::EPSILON * 0.5];
        let grid = ends.into_iter().flat_map(|x| ends.map(|y| Vec2::new(x, y)));
        let spread = (0..4000).map(|i| PathSampler::new(3, [i, 0], 0).get_2d(0, Slot::Scatter));
        let points: Vec<Vec2> = grid.chain(spread).collect();
        for eight in points.chunks_exact(LANES) {
            let u = [0, 1].map(|axis| std::array::from_fn(|lane| eight[lane][axis]));
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
