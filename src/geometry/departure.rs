use glam::Vec3;

use super::triangle_point_and_error;
use crate::math::{Lanes, Vec3Lanes};

/// Rays leave this many bounds of the error of a coordinate away from the edges. Enough for faces
/// that meet at 10 degrees: an origin is lifted by less than two of these bounds.
const CLEARANCE: f32 = 8.0;

/// But hardly more than this many bounds away from the point, where the triangle is narrower.
const MOST_MOVE: f32 = 64.0;

/// Nor is a weight raised above this, in triangles of the size of the error.
const LARGEST_WEIGHT: f32 = 0.125;

/// The point of a triangle from where rays leave that scatter at its point with barycentric weights
/// 1 − `b1` − `b2`, `b1`, `b2`, and a bound of the absolute error of each of its coordinates: to be
/// lifted off the triangle by [`crate::math::offset_origin`].
///
/// It is `at`, what [`triangle_point_and_error`] gives for these weights, but for points on an edge
/// or within rounding of one. Lifted off this triangle they would lie on the very plane of the
/// neighbour, as often behind it as before it; so they move inwards by a few error bounds first.
/// Over the inside of this triangle a ray starts on the right side of both, whether the two form a
/// ridge or a valley.
pub fn triangle_departure(
    vertices: &[Vec3; 3],
    b1: f32,
    b2: f32,
    at: (Vec3, Vec3),
) -> (Vec3, Vec3) {
    let (_, error) = at;
    match departure_weights(vertices, b1, b2, error.max_element()) {
        Some([b1, b2]) => triangle_point_and_error(vertices, b1, b2),
        None => at,
    }
}

/// Where [`triangle_departure`] would leave eight points alone, given their weights, the squares of the
/// longest sides of their triangles and the bounds of their errors.
#[inline(always)]
pub fn is_clear_of_edges<L: Lanes>(weights: [L; 3], longest: L, error: Vec3Lanes<L>) -> L::Mask {
    let least = weights[0].min(weights[1]).min(weights[2]);
    let most = L::splat(MOST_MOVE) * error.max_element();
    least.gt(L::splat(0.0)) & (least * least * longest).ge(most * most)
}

/// `b1` and `b2` of a point close by that keeps clear of the edges, given the bound of the error of
/// a coordinate; `None` if the point of these weights does already.
pub(super) fn departure_weights(
    vertices: &[Vec3; 3],
    b1: f32,
    b2: f32,
    error: f32,
) -> Option<[f32; 2]> {
    let weights = [1.0 - b1 - b2, b1, b2];
    let [a, b, c] = *vertices;
    let (ab, ac, bc) = (b - a, c - a, c - b);
    let longest = ab
        .length_squared()
        .max(ac.length_squared())
        .max(bc.length_squared());
    let least = weights[0].min(weights[1]).min(weights[2]);
    let most = MOST_MOVE * error;
    // Nearly all points end here.
    if least > 0.0 && least * least * longest >= most * most {
        return None;
    }
    let longest = longest.sqrt();
    let height = ab.cross(ac).length() / longest;
    let enough = (CLEARANCE * error / height)
        .min(most / longest)
        .min(LARGEST_WEIGHT);
    if least >= enough {
        return None;
    }
    let [b0, b1, b2] = weights.map(|weight| weight.max(enough));
    let sum = b0 + b1 + b2;
    Some([b1 / sum, b2 / sum])
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: [Vec3; 3] = [Vec3::ZERO, Vec3::X, Vec3::Y];
    const NARROW: [Vec3; 3] = [Vec3::ZERO, Vec3::X, Vec3::new(0.5, 1e-4, 0.0)];

    #[test]
    fn points_on_edges_and_corners_move_inwards_a_little() {
        for (vertices, clearance) in [(UNIT, CLEARANCE), (NARROW, 0.0)] {
            let [a, b, c] = vertices;
            for (b1, b2) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.5), (0.25, 0.0)] {
                let exact = a * (1.0 - b1 - b2) + b * b1 + c * b2;
                let at = triangle_point_and_error(&vertices, b1, b2);
                let (point, error) = triangle_departure(&vertices, b1, b2, at);
                let error = error.max_element();
                for (p, q) in [(a, b), (b, c), (c, a)] {
                    let inner = Vec3::Z.cross(q - p).normalize();
                    let away = (point - p).dot(inner);
                    assert!(away > 0.9 * clearance * error, "{b1} {b2}: {away} {error}");
                }
                assert!(point.distance(exact) < 2.0 * MOST_MOVE * error);
            }
        }
    }

    #[test]
    fn other_points_are_left_alone() {
        for (b1, b2) in [(0.25, 0.5), (1e-4, 0.5), (0.5, 0.4999)] {
            let at = triangle_point_and_error(&UNIT, b1, b2);
            assert_eq!(triangle_departure(&UNIT, b1, b2, at), at);
        }
    }
}
