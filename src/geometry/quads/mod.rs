//! Quads: two triangles that share an edge are one primitive of the hierarchy.
//!
//! That halves the leaves of most meshes, and four vertices are fetched and sheared instead of six.
//! Triangles are tested as `a b c` and `a c d`, from the vertices in their own order, so that no hit
//! depends on what goes together; two whose vertices begin elsewhere stay apart. Whoever makes
//! shapes turns them first ([`quad_turns`]).

mod matching;
mod turns;

use std::ops::Range;

use super::Shapes;
use super::leaf::bounds;
use crate::bvh::{Bvh, BvhKind, BvhSettings, LeafBlocks, Progress, map_stretches};
use crate::math::Aabb;
use matching::{CHUNK, Quad, Turning, quads};

pub use turns::quad_turns;

/// What a leaf holds: a quad, a triangle or a sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LeafPrimitive {
    first: u32,
    /// [`NONE`] if there is only one.
    second: u32,
}

const NONE: u32 = u32::MAX;

impl LeafPrimitive {
    /// A shape, and the other one of a quad: a triangle whose first two vertices are the first and
    /// the last of the other.
    pub(super) fn new(first: u32, second: Option<u32>) -> Self {
        let second = second.unwrap_or(NONE);
        Self { first, second }
    }

    pub(super) fn first(self) -> u32 {
        self.first
    }

    pub(super) fn second(self) -> Option<u32> {
        (self.second != NONE).then_some(self.second)
    }
}

/// The primitives of a hierarchy over shapes.
#[derive(Debug)]
pub(super) struct LeafPrimitives<'a> {
    shapes: &'a Shapes,
    /// With their boxes; `None` if every shape is one.
    list: Option<Vec<(LeafPrimitive, Aabb)>>,
}

impl<'a> LeafPrimitives<'a> {
    /// Quads are for the kind that is there to be fast.
    pub(super) fn new(shapes: &'a Shapes, kind: BvhKind) -> Self {
        let list = (kind == BvhKind::Sah).then(|| list(shapes));
        Self { shapes, list }
    }

    pub(super) fn shapes(&self) -> &'a Shapes {
        self.shapes
    }

    pub(super) fn len(&self) -> usize {
        match &self.list {
            Some(list) => list.len(),
            None => self.shapes.len(),
        }
    }

    pub(super) fn get(&self, index: u32) -> LeafPrimitive {
        match &self.list {
            Some(list) => list[index as usize].0,
            None => LeafPrimitive::new(index, None),
        }
    }

    /// The hierarchy over them, as [`Bvh::build_with`].
    pub(super) fn build(
        &self,
        settings: &BvhSettings,
        progress: &Progress<'_>,
    ) -> Option<(Bvh, LeafBlocks)> {
        Bvh::build_with(self.len(), &|id| self.bounds(id), settings, progress)
    }

    /// The box of a primitive; empty if nothing can hit it.
    pub(super) fn bounds(&self, index: u32) -> Aabb {
        match &self.list {
            Some(list) => list[index as usize].1,
            None => bounds(self.shapes, index),
        }
    }
}

/// Chunk by chunk the quads, then what is left; the spheres at the end.
fn list(shapes: &Shapes) -> Vec<(LeafPrimitive, Aabb)> {
    let count = shapes.triangles.len();
    let mut list = map_stretches(count, CHUNK, |triangles| chunk(shapes, triangles));
    let spheres = count as u32..shapes.len() as u32;
    let spheres = spheres.map(|id| (LeafPrimitive::new(id, None), bounds(shapes, id)));
    list.extend(spheres);
    list
}

/// The primitives of some of the triangles.
fn chunk(shapes: &Shapes, triangles: Range<usize>) -> Vec<(LeafPrimitive, Aabb)> {
    let id = |number: u32| triangles.start as u32 + number;
    let ids = triangles.clone().map(|triangle| triangle as u32);
    let boxes: Vec<_> = ids.map(|id| bounds(shapes, id)).collect();
    let quads = quads(&shapes.triangles[triangles.clone()], &boxes, Turning::Never);
    let mut list = Vec::with_capacity(boxes.len());
    let mut is_left = vec![true; boxes.len()];
    for Quad { triangles, .. } in quads {
        let [first, second] = triangles;
        let both = boxes[first as usize].union(boxes[second as usize]);
        list.push((LeafPrimitive::new(id(first), Some(id(second))), both));
        triangles
            .into_iter()
            .for_each(|number| is_left[number as usize] = false);
    }
    let left = (0..)
        .zip(boxes)
        .zip(is_left)
        .filter(|(_, is_left)| *is_left);
    list.extend(left.map(|((number, own), _)| (LeafPrimitive::new(id(number), None), own)));
    list
}
