//! A density over the unit square that is bilinear between its corners, in double precision.

use glam::{DVec2, DVec3};

/// What a corner weighs by the surface that it lights: its cosine, 0 below the horizon.
pub(super) fn cosine(facing: DVec3, wi: DVec3) -> f64 {
    facing.dot(wi).max(0.0)
}

/// The weights of the corners, if they make a density.
pub(super) fn usable(weights: [f64; 4]) -> Option<[f64; 4]> {
    let sum: f64 = weights.iter().sum();
    (sum > 0.0 && sum.is_finite()).then_some(weights)
}

/// The density that is bilinear between `weights` at the corners (0, 0), (1, 0), (0, 1), (1, 1).
pub(super) fn bilinear_density([w00, w10, w01, w11]: [f64; 4], place: DVec2) -> f64 {
    let DVec2 { x, y } = place.clamp(DVec2::ZERO, DVec2::ONE);
    let sum = w00 * (1.0 - x) * (1.0 - y) + w10 * x * (1.0 - y) + w01 * (1.0 - x) * y + w11 * x * y;
    4.0 * sum / (w00 + w10 + w01 + w11)
}

/// Distributed with [`bilinear_density`]: the row first, then the place in it.
pub(super) fn bilinear_place([w00, w10, w01, w11]: [f64; 4], u: DVec2) -> DVec2 {
    let y = linear_place(w00 + w10, w01 + w11, u.y);
    let x = linear_place(w00 + y * (w01 - w00), w10 + y * (w11 - w10), u.x);
    DVec2::new(x, y)
}

/// Where the integral of the line from `a` to `b` reaches the share `u` of the whole.
fn linear_place(a: f64, b: f64, u: f64) -> f64 {
    u * (a + b) / (a + (a * a + u * (b - a) * (b + a)).sqrt())
}
