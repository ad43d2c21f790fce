use std::collections::HashMap;

use glam::Vec3;

use super::parallelogram::Parallelogram;

/// The fourth corner may lie this many units of the last place of the largest coordinate off: every
/// coordinate was rounded on its own.
const ROUNDING: f32 = 4.0 * f32::EPSILON;
/// … and this share of the shorter edge, so that the light's shape and area stay what they are.
const SHAPE: f32 = 1e-4;

/// For each triangle the place of its partner and what they make together, or nothing.
///
/// A triangle that could go with several goes with the one that makes the parallelogram nearest to a
/// rectangle, of equal ones with the first. Corners are the same when their coordinates are.
pub(super) fn parallelograms(triangles: &[[Vec3; 3]]) -> Vec<Option<(usize, Parallelogram)>> {
    let mut by_edge: HashMap<[[u32; 3]; 2], Vec<usize>> = HashMap::new();
    for (index, corners) in triangles.iter().enumerate() {
        for side in 0..3 {
            by_edge.entry(edge(corners, side)).or_default().push(index);
        }
    }
    let mut partners = vec![None; triangles.len()];
    for index in 0..triangles.len() {
        if partners[index].is_some() {
            continue;
        }
        let best = (0..3)
            .flat_map(|side| {
                let [from, to] = edge(&triangles[index], side);
                let others = by_edge.get(&[to, from]).map_or(&[][..], Vec::as_slice);
                others.iter().map(move |&other| (side, other))
            })
            .filter(|&(_, other)| other > index && partners[other].is_none())
            .filter_map(|(side, other)| {
                let whole = joined(&triangles[index], side, &triangles[other])?;
                Some((slant(&whole), other, whole))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        if let Some((_, other, whole)) = best {
            partners[index] = Some((other, whole));
            partners[other] = Some((index, whole));
        }
    }
    partners
}

/// |cos| of the angle between the edges: 0 for rectangles.
fn slant(whole: &Parallelogram) -> f32 {
    let lengths = whole.edge_1.length() * whole.edge_2.length();
    (whole.edge_1.dot(whole.edge_2) / lengths).abs()
}

/// Start and end of side `side`, to be compared bit for bit but for the sign of zero.
fn edge(corners: &[Vec3; 3], side: usize) -> [[u32; 3]; 2] {
    [corners[side], corners[(side + 1) % 3]].map(|p| (p + 0.0).to_array().map(f32::to_bits))
}

/// What `first` makes together with `second` across side `side` of the first, whose reverse is a side
/// of the second.
fn joined(first: &[Vec3; 3], side: usize, second: &[Vec3; 3]) -> Option<Parallelogram> {
    let [from, to, corner] = [0, 1, 2].map(|i| first[(side + i) % 3]);
    let opposite = *second.iter().find(|&&p| p != from && p != to)?;
    let (edge_1, edge_2) = (from - corner, to - corner);
    let largest = [corner, from, to, opposite]
        .iter()
        .fold(0.0_f32, |most, p| most.max(p.abs().max_element()));
    let shorter = edge_1.length().min(edge_2.length());
    let gap = (opposite - (from + edge_2)).abs().max_element();
    let fits = gap <= ROUNDING * largest && gap <= SHAPE * shorter;
    fits.then(|| Parallelogram::new(corner, edge_1, edge_2))?
}
