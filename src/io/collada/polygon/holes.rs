use std::ops::Range;

use glam::DVec2;

use super::turn;

/// The holes as clockwise rings that start at their rightmost corner, the rightmost hole first.
pub(super) fn from_right_to_left(points: &[DVec2], holes: &[Range<usize>]) -> Vec<Vec<usize>> {
    let mut rings: Vec<Vec<usize>> = holes
        .iter()
        .filter(|hole| hole.len() >= 3)
        .map(|hole| {
            let mut ring: Vec<usize> = hole.clone().collect();
            let area: f64 = (0..ring.len())
                .map(|i| points[ring[i]].perp_dot(points[ring[(i + 1) % ring.len()]]))
                .sum();
            if area > 0.0 {
                ring.reverse();
            }
            let rightmost = (0..ring.len())
                .max_by(|&a, &b| points[ring[a]].x.total_cmp(&points[ring[b]].x))
                .unwrap_or(0);
            ring.rotate_left(rightmost);
            ring
        })
        .collect();
    rings.sort_by(|a, b| points[b[0]].x.total_cmp(&points[a[0]].x));
    rings
}

/// Joins a hole to the ring around it by a bridge between two corners that see each other; false
/// when the hole lies outside.
///
/// Source: David Eberly, "Triangulation by Ear Clipping" (2002), section 3.
pub(super) fn bridge(points: &[DVec2], ring: &mut Vec<usize>, hole: Vec<usize>) -> bool {
    let start = points[hole[0]];
    let Some(place) = visible_corner(points, ring, start) else {
        return false;
    };
    let corner = ring[place];
    let mut detour = hole;
    detour.push(detour[0]);
    detour.push(corner);
    ring.splice(place + 1..place + 1, detour);
    true
}

/// The place of a ring corner that `from`, inside the ring, can see.
fn visible_corner(points: &[DVec2], ring: &[usize], from: DVec2) -> Option<usize> {
    let n = ring.len();
    let at = |place: usize| points[ring[place % n]];
    // The nearest edge to the right; inside an anticlockwise ring it goes up.
    let (mut nearest, mut best) = (f64::INFINITY, None);
    for place in 0..n {
        let (a, b) = (at(place), at(place + 1));
        if a.y <= from.y && from.y <= b.y && a.y < b.y {
            let x = a.x + (from.y - a.y) / (b.y - a.y) * (b.x - a.x);
            if x >= from.x && x < nearest {
                nearest = x;
                best = Some(if a.x > b.x { place } else { (place + 1) % n });
            }
        }
    }
    let end = best?;
    let (hit, corner) = (DVec2::new(nearest, from.y), at(end));
    // A corner inside the triangle from, hit, corner hides the latter: take the one that is least
    // off the horizontal.
    let sign = if corner.y > from.y { 1.0 } else { -1.0 };
    let slope = |p: DVec2| (p.y - from.y).abs() / (p.x - from.x);
    let hides = |place: usize| {
        let p = at(place);
        p != corner
            && p.x > from.x
            && sign * turn(from, hit, p) >= 0.0
            && sign * turn(hit, corner, p) >= 0.0
            && sign * turn(corner, from, p) >= 0.0
            && sees(points, ring, place, from)
    };
    let hidden_by = (0..n).filter(|&place| hides(place)).min_by(|&a, &b| {
        let (pa, pb) = (at(a), at(b));
        slope(pa).total_cmp(&slope(pb)).then(pa.x.total_cmp(&pb.x))
    });
    Some(hidden_by.unwrap_or(end))
}

/// True when `from` lies within the inner angle of a ring corner.
fn sees(points: &[DVec2], ring: &[usize], place: usize, from: DVec2) -> bool {
    let n = ring.len();
    let [a, p, b] = [place + n - 1, place, place + 1].map(|at| points[ring[at % n]]);
    let (is_left_of_first, is_left_of_second) = (turn(a, p, from) >= 0.0, turn(p, b, from) >= 0.0);
    if turn(a, p, b) >= 0.0 {
        is_left_of_first && is_left_of_second
    } else {
        is_left_of_first || is_left_of_second
    }
}
