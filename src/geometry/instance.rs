use std::sync::Arc;

use glam::DVec3;

use super::{Aggregate, Placement};

/// A mesh that stands somewhere: it shares the triangles and the hierarchy of the mesh.
#[derive(Clone, Debug)]
pub struct Instance {
    mesh: Arc<Aggregate>,
    placement: Placement,
    first_primitive: u32,
}

impl Instance {
    /// `mesh` placed; the primitives of the instance are numbered from `first_primitive` on.
    pub(super) fn new(mesh: Arc<Aggregate>, placement: Placement, first_primitive: u32) -> Self {
        Self {
            mesh,
            placement,
            first_primitive,
        }
    }

    /// The mesh, in its own space.
    pub fn mesh(&self) -> &Arc<Aggregate> {
        &self.mesh
    }

    /// Where it stands.
    pub fn placement(&self) -> &Placement {
        &self.placement
    }

    /// The id of its first primitive; triangle i of the mesh has the id i after it.
    pub fn first_primitive(&self) -> u32 {
        self.first_primitive
    }

    /// The vertices of a triangle of the mesh in its own space, in the order that they have in the
    /// world.
    pub(super) fn object_vertices(&self, triangle: usize) -> [DVec3; 3] {
        let [a, b, c] = self
            .mesh
            .shapes()
            .vertices(triangle)
            .map(|vertex| vertex.as_dvec3());
        if self.placement.is_mirrored() {
            [a, c, b]
        } else {
            [a, b, c]
        }
    }

    /// The vertices of a triangle of the mesh in the space of the rays, counter-clockwise seen from
    /// the front.
    pub fn vertices(&self, triangle: usize) -> [DVec3; 3] {
        let to_world = self.placement.world_from_object();
        self.object_vertices(triangle)
            .map(|vertex| to_world.transform_point3(vertex))
    }
}
