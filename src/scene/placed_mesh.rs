use glam::{DMat3, DMat4, DVec3, Vec3};

use super::shading_normals::{NormalRule, corner_normals};
use crate::geometry::{Mesh, quad_turns};

/// A mesh in world space, still in file units and double precision.
pub(super) struct PlacedMesh {
    pub(super) positions: Vec<DVec3>,
    /// Area-weighted, on the side that the file means as front.
    pub(super) face_normals: Vec<DVec3>,
    /// Indices of the vertices of each triangle, turned so that neighbours can be one primitive of
    /// the hierarchy. The same wherever the mesh stands.
    pub(super) triangles: Vec<[u32; 3]>,
    /// In the order of those vertices.
    pub(super) corner_normals: Vec<Option<[Vec3; 3]>>,
    /// The placement turns triangles inside out, so their winding must be turned back.
    pub(super) is_mirrored: bool,
}

impl PlacedMesh {
    pub(super) fn new(mesh: &Mesh, world_from_object: DMat4, rule: NormalRule) -> Self {
        let linear = DMat3::from_mat4(world_from_object);
        let determinant = linear.determinant();
        let is_mirrored = determinant < 0.0;
        let positions: Vec<DVec3> = mesh
            .positions
            .iter()
            .map(|&p| world_from_object.transform_point3(p))
            .collect();
        let side = if is_mirrored { -1.0 } else { 1.0 };
        let face_normals: Vec<DVec3> = mesh
            .triangles
            .iter()
            .map(|triangle| {
                let [a, b, c] = triangle
                    .corners
                    .map(|corner| positions[corner.position as usize]);
                (b - a).cross(c - a) * side
            })
            .collect();
        let normal_to_world = if determinant == 0.0 {
            linear
        } else {
            linear.inverse().transpose()
        };
        let mut corner_normals = corner_normals(mesh, &face_normals, normal_to_world, rule);
        let corners = mesh.triangles.iter().map(|triangle| triangle.corners);
        let mut triangles: Vec<_> = corners.map(|of| of.map(|corner| corner.position)).collect();
        let in_object: Vec<_> = mesh.positions.iter().map(|p| p.as_vec3()).collect();
        let turns = quad_turns(&in_object, &triangles);
        let turned = triangles.iter_mut().zip(&mut corner_normals).zip(turns);
        for ((triangle, normals), by) in turned {
            triangle.rotate_left(by.into());
            if let Some(normals) = normals {
                normals.rotate_left(by.into());
            }
        }
        Self {
            positions,
            face_normals,
            triangles,
            corner_normals,
            is_mirrored,
        }
    }
}
