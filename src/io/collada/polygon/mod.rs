//! Polygons with any corners and holes to triangles.

mod ears;
mod holes;

use std::ops::Range;

use glam::{DVec2, DVec3};

/// How a polygon came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quality {
    /// Its triangles cover it exactly.
    Clean,
    /// It crosses itself (where that was in the way) or a hole lies outside; the triangles are a
    /// guess.
    SelfCrossing,
    /// It has no area; no triangles.
    NoArea,
    /// Too much work; the rest of it became a fan.
    TooComplex,
}

/// Cuts polygons into triangles in their own plane, in double precision.
///
/// The work over its whole life is bounded, so that no file can hold the reader up.
#[derive(Debug)]
pub(super) struct Triangulator {
    /// Point tests left.
    budget: u64,
}

impl Default for Triangulator {
    fn default() -> Self {
        Self {
            budget: 1_000_000_000,
        }
    }
}

impl Triangulator {
    /// Triangles of a polygon as indices into `points`, wound like its outline. `rings` are
    /// ranges of `points`: the outline, then the holes in any winding.
    pub(super) fn triangulate(
        &mut self,
        points: &[DVec3],
        rings: &[Range<usize>],
        triangles: &mut Vec<[usize; 3]>,
    ) -> Quality {
        triangles.clear();
        let Some((outline, holes)) = rings.split_first() else {
            return Quality::NoArea;
        };
        let Some(flat) = project(points, &points[outline.clone()]) else {
            return Quality::NoArea;
        };
        if holes.is_empty() && is_strictly_convex(&flat[outline.clone()]) {
            let start = outline.start;
            triangles.extend((start + 1..outline.end - 1).map(|i| [start, i, i + 1]));
            return Quality::Clean;
        }
        let mut ring: Vec<usize> = outline.clone().collect();
        let mut quality = Quality::Clean;
        for hole in holes::from_right_to_left(&flat, holes) {
            self.budget = self.budget.saturating_sub(ring.len() as u64);
            if self.budget == 0 || !holes::bridge(&flat, &mut ring, hole) {
                quality = Quality::SelfCrossing;
            }
        }
        match ears::clip(&flat, &ring, &mut self.budget, triangles) {
            Quality::Clean => quality,
            worse => worse,
        }
    }
}

/// All points in the plane of the outline, which turns anticlockwise there; `None` without area.
///
/// Normal by Newell's method (Sutherland, Sproull and Schumacker, 1974).
fn project(points: &[DVec3], outline: &[DVec3]) -> Option<Vec<DVec2>> {
    let origin = *outline.first()?;
    let mut normal = DVec3::ZERO;
    let mut longest = 0.0_f64;
    for (i, p) in outline.iter().enumerate() {
        let (a, b) = (*p - origin, outline[(i + 1) % outline.len()] - origin);
        normal += a.cross(b);
        longest = longest.max(a.length_squared());
    }
    if normal.length() <= 1e-15 * longest {
        return None;
    }
    let normal = normal.try_normalize()?;
    let (u, v) = normal.any_orthonormal_pair();
    let (u, v) = if u.cross(v).dot(normal) > 0.0 {
        (u, v)
    } else {
        (v, u)
    };
    let flat = |p: &DVec3| DVec2::new((*p - origin).dot(u), (*p - origin).dot(v));
    Some(points.iter().map(flat).collect())
}

/// Twice the signed area of a triangle, positive when anticlockwise.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// True when every corner turns left and a fan from the first corner covers the ring.
fn is_strictly_convex(ring: &[DVec2]) -> bool {
    let n = ring.len();
    let corner = |i: usize| turn(ring[i], ring[(i + 1) % n], ring[(i + 2) % n]) > 0.0;
    let fan = |i: usize| turn(ring[0], ring[i], ring[i + 1]) > 0.0;
    (0..n).all(corner) && (1..n - 1).all(fan)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Total area of the triangles along `normal`, and of those that are turned the wrong way.
    fn areas(points: &[DVec3], triangles: &[[usize; 3]], normal: DVec3) -> (f64, f64) {
        let mut sums = (0.0, 0.0);
        for &[a, b, c] in triangles {
            let area = 0.5
                * (points[b] - points[a])
                    .cross(points[c] - points[a])
                    .dot(normal);
            sums.0 += area;
            sums.1 += area.min(0.0);
        }
        sums
    }

    fn on_tilted_plane(points: &[[f64; 2]]) -> (Vec<DVec3>, DVec3) {
        let (u, v) = (DVec3::new(0.6, 0.0, 0.8), DVec3::Y);
        let to_space = |p: &[f64; 2]| DVec3::new(5.0, 6.0, 7.0) + u * p[0] + v * p[1];
        (points.iter().map(to_space).collect(), u.cross(v))
    }

    fn check(points: &[[f64; 2]], rings: &[Range<usize>], area: f64, count: usize) {
        let (points, normal) = on_tilted_plane(points);
        let mut triangles = Vec::new();
        let quality = Triangulator::default().triangulate(&points, rings, &mut triangles);
        let (sum, wrong) = areas(&points, &triangles, normal);
        assert_eq!((quality, triangles.len()), (Quality::Clean, count));
        assert!(
            (sum - area).abs() < 1e-12 && wrong > -1e-12,
            "{sum} {wrong}"
        );
    }

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];

    #[test]
    fn convex_and_concave_outlines_are_covered() {
        check(&SQUARE, &[0..4], 16.0, 2);
        let arrow = [[0.0, 0.0], [2.0, 1.0], [4.0, 0.0], [2.0, 4.0]];
        check(&arrow, &[0..4], 6.0, 2);
        let comb = [
            [0.0, 0.0],
            [5.0, 0.0],
            [5.0, 3.0],
            [4.0, 1.0],
            [3.0, 3.0],
            [2.0, 1.0],
            [1.0, 3.0],
            [0.0, 1.0],
        ];
        check(&comb, &[0..8], 10.0, 6);
        // A corner on a straight edge stays a corner of real triangles.
        let straight = [[0.0, 0.0], [2.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        check(&straight, &[0..5], 16.0, 3);
    }

    #[test]
    fn holes_stay_open_whatever_their_winding() {
        let mut points = SQUARE.to_vec();
        points.extend([[1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0]]);
        check(&points, &[0..4, 4..8], 15.0, 8);
        points[4..8].reverse();
        check(&points, &[0..4, 4..8], 15.0, 8);
        points.extend([[2.5, 1.0], [3.5, 1.5], [3.0, 3.0]]);
        check(&points, &[0..4, 4..8, 8..11], 15.0 - 0.875, 13);
        points.extend([[0.5, 2.5], [2.0, 2.5], [2.0, 3.5], [0.5, 3.5]]);
        check(
            &points,
            &[0..4, 4..8, 8..11, 11..15],
            15.0 - 0.875 - 1.5,
            19,
        );
    }

    #[test]
    fn faulty_polygons_are_named() {
        let mut triangulator = Triangulator::default();
        let mut triangles = Vec::new();
        let mut run = |points: &[[f64; 2]], rings: &[Range<usize>]| {
            let points = on_tilted_plane(points).0;
            triangulator.triangulate(&points, rings, &mut triangles)
        };
        let line = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 3.0]];
        assert_eq!(run(&line, &[0..4]), Quality::NoArea);
        let bow_tie = [[0.0, 0.0], [4.0, 0.0], [1.0, 3.0], [4.0, 3.0]];
        assert_eq!(run(&bow_tie, &[0..4]), Quality::SelfCrossing);
        let mut outside = SQUARE.to_vec();
        outside.extend([[9.0, 1.0], [9.5, 1.0], [9.0, 2.0]]);
        assert_eq!(run(&outside, &[0..4, 4..7]), Quality::SelfCrossing);
        assert_eq!(run(&[], &[]), Quality::NoArea);
        let mut tired = Triangulator { budget: 3 };
        let arrow = [[0.0, 0.0], [2.0, 1.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        let points = on_tilted_plane(&arrow).0;
        let quality = tired.triangulate(&points, &[0..5], &mut triangles);
        assert_eq!((quality, triangles.len()), (Quality::TooComplex, 3));
    }

    proptest! {
        /// Rings around a centre with random radii: simple, mostly concave.
        #[test]
        fn star_shaped_rings_with_a_hole_are_covered(
            radii in prop::collection::vec(1.0..5.0_f64, 3..60),
            hole in prop::collection::vec(0.1..0.4_f64, 3..12),
        ) {
            let ring = |radii: &[f64]| -> Vec<[f64; 2]> {
                let step = std::f64::consts::TAU / radii.len() as f64;
                let polar = |(i, r): (usize, &f64)| [r * (i as f64 * step).cos(), r * (i as f64 * step).sin()];
                radii.iter().enumerate().map(polar).collect()
            };
            let area = |ring: &[[f64; 2]]| -> f64 {
                (0..ring.len())
                    .map(|i| {
                        let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
                        0.5 * (a[0] * b[1] - a[1] * b[0])
                    })
                    .sum()
            };
            let (outline, hole) = (ring(&radii), ring(&hole));
            let expected = area(&outline) - area(&hole);
            let n = outline.len();
            let all: Vec<[f64; 2]> = outline.into_iter().chain(hole).collect();
            let (points, normal) = on_tilted_plane(&all);
            let mut triangles = Vec::new();
            Triangulator::default().triangulate(&points, &[0..n, n..points.len()], &mut triangles);
            let (sum, wrong) = areas(&points, &triangles, normal);
            prop_assert!((sum - expected).abs() < 1e-9 && wrong > -1e-9, "{} {} {}", sum, expected, wrong);
            prop_assert!(triangles.len() <= points.len());
        }
    }
}
