use std::ops::Range;

use glam::Vec3;

use super::triangle::{self, Shear};
use super::{Hit, Shapes, Sphere};
use crate::bvh::{Leaf, SlabRay, padded};
use crate::math::{Aabb, Ray};

/// The primitives in the order of the leaves, with their vertices at hand.
#[derive(Clone, Debug)]
pub(super) struct LeafOrder {
    ids: Vec<u32>,
    /// Vertices of a triangle; nothing useful for a sphere.
    vertices: Vec<[Vec3; 3]>,
    /// Ids from here on are spheres.
    first_sphere: u32,
    spheres: Vec<Sphere>,
}

impl LeafOrder {
    pub(super) fn new(shapes: &Shapes, order: &[u32]) -> Self {
        let triangles = shapes.triangles.len();
        let vertices = order.iter().map(|&id| {
            let id = id as usize;
            if id < triangles {
                shapes.vertices(id)
            } else {
                [Vec3::ZERO; 3]
            }
        });
        Self {
            ids: order.to_vec(),
            vertices: vertices.collect(),
            first_sphere: u32::try_from(triangles).expect("the build checked the number"),
            spheres: shapes.spheres.clone(),
        }
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.ids.as_slice()) + size_of_val(self.vertices.as_slice())
    }
}

/// Boxes of all primitives; empty for those that nothing can hit.
pub(super) fn boxes(shapes: &Shapes) -> Vec<Aabb> {
    let triangles = (0..shapes.triangles.len()).map(|i| triangle::bounds(&shapes.vertices(i)));
    triangles
        .chain(shapes.spheres.iter().map(Sphere::bounds))
        .collect()
}

/// One ray among the leaves. `ANY`: stop at the first hit.
#[derive(Debug)]
pub(super) struct Search<'a, const ANY: bool> {
    leaves: &'a LeafOrder,
    ray: &'a Ray,
    slab: &'a SlabRay,
    shear: Shear,
    /// The best hit so far.
    pub(super) hit: Hit,
}

impl<'a, const ANY: bool> Search<'a, ANY> {
    pub(super) fn new(leaves: &'a LeafOrder, ray: &'a Ray, slab: &'a SlabRay) -> Self {
        Self {
            leaves,
            ray,
            slab,
            shear: Shear::new(ray),
            hit: Hit::MISS,
        }
    }

    /// Takes a hit if it is valid and better than the best so far.
    ///
    /// Every test depends on the primitive and the ray alone, so the result depends neither on the
    /// tree nor on the order of visits: the hit counts only if the ray meets the primitive's own
    /// box, and lies no nearer than that box.
    fn offer(&mut self, t: f32, id: u32, weights: (f32, f32), bounds: impl FnOnce() -> Aabb) {
        // Moving to the front of the box only ever enlarges t, and must not carry it past t_min.
        // A t that is NaN, from numbers too large for f32, fails here too.
        let possible = t > self.slab.t_min() && t < self.slab.t_max() && t <= self.hit.t;
        if !possible {
            return;
        }
        let Some(front) = self.slab.enter(&padded(bounds())) else {
            return;
        };
        let t = t.max(front);
        let better = t < self.hit.t || t == self.hit.t && id < self.hit.primitive;
        if t < self.slab.t_max() && better {
            self.hit = Hit {
                t,
                primitive: id,
                b1: weights.0,
                b2: weights.1,
            };
        }
    }

    #[inline(always)]
    fn triangles<const Z: usize>(&mut self, slots: Range<usize>) {
        let leaves = self.leaves;
        for (vertices, &id) in leaves.vertices[slots.clone()]
            .iter()
            .zip(&leaves.ids[slots])
        {
            if id >= leaves.first_sphere {
                self.sphere(id);
            } else if let Some(hit) = self.shear.meet::<Z>(vertices) {
                let bounds = || Aabb::from_points(*vertices);
                self.offer(hit.t, id, (hit.b1, hit.b2), bounds);
            }
        }
    }

    #[cold]
    fn sphere(&mut self, id: u32) {
        let sphere = self.leaves.spheres[(id - self.leaves.first_sphere) as usize];
        for t in sphere.meet(self.ray).into_iter().flatten() {
            self.offer(t, id, (0.0, 0.0), || sphere.bounds());
        }
    }
}

impl<const ANY: bool> Leaf for Search<'_, ANY> {
    #[inline]
    fn visit(&mut self, slots: Range<usize>) -> f32 {
        match self.shear.axis {
            0 => self.triangles::<0>(slots),
            1 => self.triangles::<1>(slots),
            _ => self.triangles::<2>(slots),
        }
        if ANY && !self.hit.is_miss() {
            f32::NEG_INFINITY
        } else {
            self.hit.t.min(self.slab.t_max())
        }
    }
}
