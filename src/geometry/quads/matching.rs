use std::collections::HashMap;

use crate::math::Aabb;

/// Triangles of one chunk may go together: neighbours mostly follow each other, and a chunk of this
/// size stays in the cache.
pub(super) const CHUNK: usize = 4096;

/// Two triangles are one quad only if its box has no more than this many times the surface of both
/// their boxes together: a small triangle at the end of a long one is better left alone.
const MOST_SURFACE: f32 = 1.0;

/// So small is the box of two triangles that make a rectangle, or nearly: no other is sought.
const CLOSE_SURFACE: f32 = 0.95;

/// Two triangles `a b c` and `a c d` of a chunk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Quad {
    /// Their numbers in the chunk.
    pub(super) triangles: [u32; 2],
    /// By how many vertices each must be turned to the left to be that.
    pub(super) turns: [u32; 2],
}

/// Whether triangles may begin with another of their vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Turning {
    Allowed,
    Never,
}

impl Turning {
    /// The edges across which a triangle can find another: the one from its vertex 0 on, and so on.
    fn edges(self) -> &'static [u32] {
        match self {
            Self::Allowed => &[0, 1, 2],
            Self::Never => &[0, 2],
        }
    }
}

/// The vertices at both ends of an edge, as one number: the one that the triangle comes from, and the
/// one that it goes to.
fn ends(vertices: [u32; 3], edge: u32) -> [u64; 2] {
    let at = |i: u32| u64::from(vertices[(i % 3) as usize]);
    let (from, to) = (at(edge), at(edge + 1));
    [from << 32 | to, to << 32 | from]
}

/// The quads of a chunk. Triangles that follow each other come first, if their box is small; then each
/// that is left, in turn, goes with the neighbour across the edge that gives the smallest box.
/// `boxes` are those of the triangles; what has an empty one stays alone.
pub(super) fn quads(triangles: &[[u32; 3]], boxes: &[Aabb], turning: Turning) -> Vec<Quad> {
    let mut search = Search {
        triangles,
        boxes,
        turning,
        is_free: boxes.iter().map(|own| !own.is_empty()).collect(),
        quads: Vec::with_capacity(triangles.len() / 2),
    };
    search.take_followers();
    search.take_neighbours();
    search.quads
}

/// A chunk in which quads are looked for.
struct Search<'a> {
    triangles: &'a [[u32; 3]],
    boxes: &'a [Aabb],
    turning: Turning,
    /// Which triangles are in no quad yet.
    is_free: Vec<bool>,
    quads: Vec<Quad>,
}

impl Search<'_> {
    fn take_followers(&mut self) {
        let mut number = 0;
        while number + 1 < self.triangles.len() as u32 {
            let found = self.follower(number);
            let found = found.filter(|quad| self.surface(quad) <= CLOSE_SURFACE);
            number += if found.is_some() { 2 } else { 1 };
            found.into_iter().for_each(|quad| self.take(quad));
        }
    }

    /// The quad of a triangle and the next one, if it can be.
    fn follower(&self, number: u32) -> Option<Quad> {
        let both = [number, number + 1];
        let edges = common_edge(both.map(|i| self.triangles[i as usize]))?;
        self.possible(quad(both, edges))
    }

    fn take_neighbours(&mut self) {
        let edges = self.turning.edges();
        // By both ends the number of the triangle and of its edge.
        let mut half_edges = HashMap::new();
        for number in (0..self.triangles.len() as u32).filter(|&i| self.is_free[i as usize]) {
            for &edge in edges {
                let ends = ends(self.triangles[number as usize], edge);
                half_edges.entry(ends[0]).or_insert([number, edge]);
            }
        }
        for number in 0..self.triangles.len() as u32 {
            if !self.is_free[number as usize] {
                continue;
            }
            let vertices = self.triangles[number as usize];
            let across = |&edge: &u32| {
                let [other, its_edge] = *half_edges.get(&ends(vertices, edge)[1])?;
                let quad = self.possible(quad([number, other], [edge, its_edge]))?;
                let surface = self.surface(&quad);
                (surface <= MOST_SURFACE).then_some((surface, quad))
            };
            let found = edges.iter().filter_map(across);
            if let Some((_, quad)) = found.min_by(|a, b| a.0.total_cmp(&b.0)) {
                self.take(quad);
            }
        }
    }

    /// `quad`, if it is of two triangles that are free, and that need not be turned where they may
    /// not.
    fn possible(&self, quad: Quad) -> Option<Quad> {
        let [first, second] = quad.triangles;
        let are_free = self.is_free[first as usize] && self.is_free[second as usize];
        let is_allowed = self.turning == Turning::Allowed || quad.turns == [0, 0];
        (first != second && are_free && is_allowed).then_some(quad)
    }

    /// The surface of the box of a quad by that of the boxes of its triangles.
    fn surface(&self, quad: &Quad) -> f32 {
        let [first, second] = quad.triangles.map(|i| self.boxes[i as usize]);
        first.union(second).half_area() / (first.half_area() + second.half_area())
    }

    fn take(&mut self, quad: Quad) {
        for triangle in quad.triangles {
            self.is_free[triangle as usize] = false;
        }
        self.quads.push(quad);
    }
}

/// The edge that two triangles run along in opposite directions, by number in each.
fn common_edge([one, other]: [[u32; 3]; 2]) -> Option<[u32; 2]> {
    for i in 0..3 {
        for j in 0..3 {
            if ends(one, i)[0] == ends(other, j)[1] {
                return Some([i, j]);
            }
        }
    }
    None
}

/// The quad of two triangles that run along an edge, by number in each, in opposite directions. None
/// is turned if that can be.
fn quad([one, other]: [u32; 2], edges: [u32; 2]) -> Quad {
    // The edge is the last of the first triangle, and the first of the second.
    if edges == [0, 2] {
        return Quad {
            triangles: [other, one],
            turns: [0, 0],
        };
    }
    Quad {
        triangles: [one, other],
        turns: [(edges[0] + 1) % 3, edges[1]],
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::super::super::triangle;
    use super::*;

    /// A unit square with the diagonal from 0 to 2, and what lies about it.
    const POSITIONS: [Vec3; 7] = [
        Vec3::ZERO,
        Vec3::X,
        Vec3::new(1.0, 1.0, 0.0),
        Vec3::Y,
        Vec3::new(50.0, 60.0, 70.0),
        Vec3::new(2.0, 2.0, 0.0),
        Vec3::NAN,
    ];

    fn found_of(triangles: &[[u32; 3]], positions: &[Vec3], turning: Turning) -> Vec<Quad> {
        let boxes = triangles
            .iter()
            .map(|vertices| vertices.map(|i| positions[i as usize]));
        let boxes: Vec<_> = boxes.map(|vertices| triangle::bounds(&vertices)).collect();
        quads(triangles, &boxes, turning)
    }

    fn found(triangles: &[[u32; 3]], turning: Turning) -> Vec<Quad> {
        found_of(triangles, &POSITIONS, turning)
    }

    fn turned(mut vertices: [u32; 3], by: u32) -> [u32; 3] {
        vertices.rotate_left(by as usize);
        vertices
    }

    #[test]
    fn the_halves_of_a_square_are_a_quad_whichever_vertices_come_first() {
        for (i, j) in (0..9).map(|i| (i % 3, i / 3)) {
            let triangles = [turned([0, 1, 2], i), turned([0, 2, 3], j)];
            let quads = found(&triangles, Turning::Allowed);
            let [quad] = quads[..] else {
                panic!("{triangles:?}: {quads:?}")
            };
            let [[a, b, c], second] =
                [0, 1].map(|k| turned(triangles[quad.triangles[k] as usize], quad.turns[k]));
            assert!(
                second[..2] == [a, c] && ![a, b, c].contains(&second[2]),
                "{quad:?}"
            );
            let as_they_are = found(&triangles, Turning::Never);
            assert_eq!(as_they_are == quads, quad.turns == [0, 0]);
            assert_eq!(as_they_are.is_empty(), quad.turns != [0, 0]);
        }
    }

    #[test]
    fn nothing_else_is_one() {
        for (why, other) in [
            ("it runs along the edge in the same direction", [2, 0, 3]),
            ("one vertex alone is common", [0, 3, 5]),
            ("the box would be much larger", [0, 2, 4]),
            ("it has no area", [0, 2, 5]),
            ("it is not finite", [0, 2, 6]),
        ] {
            let mut positions = POSITIONS;
            if why == "the box would be much larger" {
                positions[1].x = -1e3;
            }
            let triangles = [[0, 1, 2], other];
            assert_eq!(
                found_of(&triangles, &positions, Turning::Allowed),
                [],
                "{why}"
            );
        }
        // Of three at one edge, the third stays alone.
        let fan = [[0, 1, 2], [0, 2, 3], [0, 2, 3]];
        assert_eq!(found(&fan, Turning::Allowed).len(), 1);
    }
}
