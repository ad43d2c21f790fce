use super::super::{Shapes, leaf};
use super::{Bounds, padded_bounds};

/// Two triangles in one plane with a common edge, or one.
///
/// The corners go round: the triangles are `a b c` and `a c d`, each turned by some corners. The
/// edge function of the common edge has opposite signs for both; for one alone `d` is `c`, so that
/// the second has no inside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    /// Numbers of the vertices `a`, `b`, `c`, `d`.
    pub(super) corners: [u8; 4],
    /// The second is never asked for if there is one only.
    pub(super) triangles: [Triangle; 2],
    /// Whether there are two.
    pub(super) is_pair: bool,
    /// Whether both have the same box.
    pub(super) share_bounds: bool,
    /// No hit lies outside; flat where the triangles are.
    pub(super) extent: Bounds,
}

/// What a hit needs to know of a triangle.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Triangle {
    /// Not of unit length; see [`super::super::block::Block::normals`].
    pub(super) normal: [f32; 4],
    /// The first vertex.
    pub(super) first: [f32; 4],
    /// Padded.
    pub(super) bounds: Bounds,
    /// As a number.
    pub(super) id: f32,
    /// By how many corners the triangle is turned in its patch.
    pub(super) turn: u8,
}

/// A triangle with the numbers of its vertices.
type Numbered = (u32, [usize; 3]);

/// Pairs `triangles` up where they lie in one plane and share an edge that they run through in
/// opposite directions; a triangle goes with the next one if it can.
pub(super) fn patches(shapes: &Shapes, triangles: &[Numbered]) -> Vec<Patch> {
    let mut is_taken = vec![false; triangles.len()];
    let mut patches = Vec::new();
    for (i, first) in triangles.iter().enumerate() {
        if std::mem::replace(&mut is_taken[i], true) {
            continue;
        }
        let found = (i + 1..triangles.len())
            .filter(|&j| !is_taken[j])
            .filter(|&j| is_flat(shapes, [first.0, triangles[j].0]))
            .find_map(|j| Some((j, round(first.1, triangles[j].1)?)));
        if let Some((j, (corners, turns))) = found {
            is_taken[j] = true;
            let pair = [first.0, triangles[j].0];
            patches.push(patch(shapes, corners, (pair, turns)));
        } else {
            let [a, b, c] = first.1;
            patches.push(patch(shapes, [a, b, c, c], ([first.0; 2], [0; 2])));
        }
    }
    patches
}

/// Whether two triangles face nearly the same way. If they share an edge too, no ray meets both.
fn is_flat(shapes: &Shapes, ids: [u32; 2]) -> bool {
    let [a, b] = ids.map(|id| {
        let [a, b, c] = shapes.vertices(id as usize).map(|v| v.as_dvec3());
        (b - a).cross(c - a)
    });
    a.dot(b) > 0.9999 * a.length() * b.length()
}

/// The corners of a patch of two triangles, and by how much each is turned; `None` if they share no
/// edge in opposite directions.
fn round(first: [usize; 3], second: [usize; 3]) -> Option<([usize; 4], [u8; 2])> {
    (0..9).find_map(|turns| {
        let turns = [turns % 3, turns / 3];
        let [a, b, c] = turned(first, turns[0]);
        let [p, q, r] = turned(second, turns[1]);
        (p == a && q == c).then_some(([a, b, c, r], turns))
    })
}

fn turned(mut corners: [usize; 3], by: u8) -> [usize; 3] {
    corners.rotate_left(by.into());
    corners
}

/// The patch of two triangles, or of one that is given twice.
fn patch(shapes: &Shapes, corners: [usize; 4], (ids, turns): ([u32; 2], [u8; 2])) -> Patch {
    let prepare = |id: u32, turn: u8| {
        let [a, b, c] = shapes.vertices(id as usize);
        Triangle {
            normal: (b - a).cross(c - a).extend(0.0).to_array(),
            first: a.extend(0.0).to_array(),
            bounds: padded_bounds(leaf::bounds(shapes, id)),
            id: id as f32,
            turn,
        }
    };
    let own = ids.map(|id| leaf::bounds(shapes, id));
    let both = own[0].union(own[1]);
    let mut extent = padded_bounds(both);
    for (axis, extent) in extent.iter_mut().enumerate() {
        // The ray parameter of the plane itself says on which side of it the origin is.
        if both.min[axis] == both.max[axis] {
            *extent = [both.min[axis], both.max[axis]];
        }
    }
    Patch {
        corners: corners.map(|i| u8::try_from(i).expect("there are 256 vertices at most")),
        triangles: [prepare(ids[0], turns[0]), prepare(ids[1], turns[1])],
        is_pair: ids[0] != ids[1],
        share_bounds: own[0] == own[1],
        extent,
    }
}
