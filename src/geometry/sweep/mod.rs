//! The sweep: how small scenes are traced. No tree and no stack: eight rays in lanes meet one
//! primitive after the other.
//!
//! Rays are first sorted by the signs and the longest axis of their directions ([`bins`]), so that
//! the eight of a packet are sheared along one axis, and what lies behind all rays of an octant is
//! left out. A packet shears every vertex once, then tests pairs of triangles that share an edge
//! ([`patch`]). What is computed for a ray and a primitive is what the leaves of the tree compute
//! ([`super::leaf`]), so the hits are the same to the bit. A ray that runs exactly along an edge, or
//! starts absurdly far away, is left to the tree, which has the exact test for it.

mod bins;
mod packet;
mod patch;
mod sphere;
mod trace;

use glam::Vec3;

use super::{Hit, Shapes, Sphere, TraceCounts, leaf};
use crate::bvh::padded;
use crate::math::{Aabb, Isa, Ray, run_lanes};
use patch::Patch;
use trace::Trace;

/// Scenes of up to so many triangles are swept for any hit. Measured: at 64 that is 1.4 times as fast
/// as the tree in boxes full of blocks.
const MOST_TRIANGLES: usize = 64;

/// The same for closest hits: at 32 triangles 1.15 times, at 64 slower.
const MOST_FOR_CLOSEST: usize = 40;

/// The same for spheres, each of which is tried by itself. Measured in a room of ten triangles: 3.4
/// times as fast as the tree with 12 spheres, 2.3 times (any hit: 2.6) with 16; more were not tried.
const MOST_SPHERES: usize = 16;

/// Vertices that a packet has room for; their numbers are bytes.
const VERTICES: usize = 256;

/// Largest coordinate of a vertex or origin, in units of the prepared scene. Below it the product of
/// three edge functions cannot overflow.
const REACH: f32 = 1e5;

/// Least radius of a sphere: its discriminants keep their signs in single precision.
const SMALLEST: f32 = 1e-6;

/// Batches of fewer rays are left to the tree: too few would share a packet. Measured: with rays in all
/// directions 0.75 times as fast at 32 rays, 0.93 (any hit: 1.15) at 64, 1.4 at 128.
const FEWEST_RAYS: usize = 64;

/// The primitives of a small scene, prepared for sweeps.
#[derive(Clone, Debug)]
pub(super) struct Sweep {
    vertices: Box<Vertices>,
    patches: Vec<Patch>,
    spheres: Vec<Ball>,
    /// Whether closest hits are faster here than in the tree.
    is_for_closest: bool,
}

/// The vertices without repetitions, and room for more; the last coordinate is not used.
type Vertices = [[f32; 4]; VERTICES];

/// A sphere, its id and its box.
#[derive(Clone, Copy, Debug)]
struct Ball {
    sphere: Sphere,
    /// As a number.
    id: f32,
    bounds: Bounds,
}

impl Ball {
    /// Whether products of its numbers neither vanish nor overflow.
    fn is_plain(&self) -> bool {
        let Sphere { center, radius } = self.sphere;
        center.abs().max_element() <= REACH && (SMALLEST..=REACH).contains(&radius)
    }
}

/// Minimum and maximum per axis.
type Bounds = [[f32; 2]; 3];

/// The box that a hit must lie in.
fn padded_bounds(bounds: Aabb) -> Bounds {
    let Aabb { min, max } = padded(bounds);
    [[min.x, max.x], [min.y, max.y], [min.z, max.z]]
}

impl Sweep {
    /// `None` if the scene is not small, or its numbers are too large.
    pub(super) fn new(shapes: &Shapes) -> Option<Self> {
        if shapes.triangles.len() > MOST_TRIANGLES || shapes.spheres.len() > MOST_SPHERES {
            return None;
        }
        let all = 0..shapes.len() as u32;
        let ids: Vec<u32> = all
            .filter(|&id| !leaf::bounds(shapes, id).is_empty())
            .collect();
        let mut vertices: Vec<Vec3> = Vec::new();
        let mut triangles = Vec::new();
        let mut spheres = Vec::new();
        for id in ids {
            if let Some(&sphere) = shapes.sphere(id) {
                let bounds = padded_bounds(sphere.bounds());
                let id = id as f32;
                spheres.push(Ball { sphere, id, bounds });
                continue;
            }
            let corners = shapes.vertices(id as usize);
            let numbers = corners.map(|vertex| number_of(&mut vertices, vertex));
            triangles.push((id, numbers));
        }
        let fits = vertices.len() <= VERTICES;
        let is_near = vertices.iter().all(|v| v.abs().max_element() <= REACH)
            && spheres.iter().all(Ball::is_plain);
        (fits && is_near && !vertices.is_empty()).then(|| Self {
            patches: patch::patches(shapes, &triangles),
            vertices: Box::new(table(&vertices)),
            spheres,
            is_for_closest: triangles.len() <= MOST_FOR_CLOSEST,
        })
    }

    /// Whether the sweep is faster than the tree for a batch of so many rays.
    pub(super) fn is_for<const ANY: bool>(&self, rays: usize) -> bool {
        rays >= FEWEST_RAYS && (ANY || self.is_for_closest)
    }

    /// Gives `answer` the number of each ray and its hit, in any order; `ANY`: some hit, and only its
    /// being there counts. Returns the numbers of the rays that the tree must answer, whatever was
    /// said of them before.
    pub(super) fn trace<const ANY: bool>(
        &self,
        isa: Isa,
        rays: &[Ray],
        answer: impl FnMut(usize, Hit),
        counts: &mut TraceCounts,
    ) -> Vec<u32> {
        let mut rest = Vec::new();
        let trace = Trace::<_, ANY> {
            sweep: self,
            rays,
            answer,
            rest: &mut rest,
            counts,
        };
        run_lanes(isa, trace);
        rest
    }
}

fn table(vertices: &[Vec3]) -> Vertices {
    let mut table = [[0.0; 4]; VERTICES];
    for (to, vertex) in table.iter_mut().zip(vertices) {
        *to = vertex.extend(0.0).to_array();
    }
    table
}

/// The number of `vertex` among `vertices`, where it is put if it is new. Zeros of both signs are
/// one: none of them reaches a result.
fn number_of(vertices: &mut Vec<Vec3>, vertex: Vec3) -> usize {
    let found = vertices.iter().position(|old| *old == vertex);
    found.unwrap_or_else(|| {
        vertices.push(vertex);
        vertices.len() - 1
    })
}
