use glam::{DMat3, DMat4, DVec3, Vec3};

use super::shading_normals::{NormalRule, corner_normals};
use crate::geometry::Mesh;

/// A mesh in world space, still in file units and double precision.
pub(super) struct PlacedMesh {
    pub(super) positions: Vec<DVec3>,
    /// Area-weighted, on the side that the file means as front.
    pub(super) face_normals: Vec<DVec3>,
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
        let corner_normals = corner_normals(mesh, &face_normals, normal_to_world, rule);
        Self {
            positions,
            face_normals,
            corner_normals,
            is_mirrored,
        }
    }
}
