use glam::Vec3;

use super::parallelogram::Parallelogram;

/// The fourth corner may lie this many units of the last place of the largest coordinate off: every
/// coordinate was rounded on its own.
const ROUNDING: f32 = 4.0 * f32::EPSILON;
/// … and this share of the shorter edge, so that the light's shape and area stay what they are.
const SHAPE: f32 = 1e-4;

/// What becomes of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) enum Partner {
    /// It stays alone.
    None,
    /// It makes this together with a later one.
    Later(Parallelogram),
    /// It is part of what the triangle at this place makes.
    Earlier(usize),
}

/// For each triangle its partner.
///
/// A triangle that could go with several goes with the one that makes the parallelogram nearest to a
/// rectangle, of equal ones with the first. Corners are the same when their coordinates are.
pub(super) fn parallelograms(triangles: &[[Vec3; 3]]) -> Vec<Partner> {
    let by_edge = by_edge(triangles);
    let mut partners = vec![Partner::None; triangles.len()];
    for index in 0..triangles.len() {
        if !matches!(partners[index], Partner::None) {
            continue;
        }
        let best = (0..3)
            .flat_map(|side| {
                let [from, to] = edge(&triangles[index], side);
                let reverse = [to, from];
                let first = by_edge.partition_point(|entry| entry.0 < reverse);
                let others = by_edge[first..].iter();
                let others = others.take_while(move |entry| entry.0 == reverse);
                others.map(move |entry| (side, entry.1))
            })
            .filter(|&(_, other)| other > index && matches!(partners[other], Partner::None))
            .filter_map(|(side, other)| {
                let whole = joined(&triangles[index], side, &triangles[other])?;
                Some((slant(&whole), other, whole))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        if let Some((_, other, whole)) = best {
            partners[index] = Partner::Later(whole);
            partners[other] = Partner::Earlier(index);
        }
    }
    partners
}

/// Every side with its triangle, in order. Sides without length are left out: what they join has no
/// area.
fn by_edge(triangles: &[[Vec3; 3]]) -> Vec<([[u32; 3]; 2], usize)> {
    let sides = triangles.iter().enumerate().flat_map(|(index, corners)| {
        let sides = (0..3).map(move |side| (edge(corners, side), index));
        sides.filter(|([from, to], _)| from != to)
    });
    let mut sides: Vec<_> = sides.collect();
    sides.sort_unstable();
    sides
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
