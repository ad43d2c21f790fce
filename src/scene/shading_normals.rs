//! Normals at the corners of mesh triangles.

use glam::{DMat3, DVec3, Vec3};

use crate::geometry::{Corner, Mesh};

/// Edges that bend by less than this are shaded smooth where the file has no normals.
const CREASE_COSINE: f64 = 0.5;
/// Corner normals this near to the face normal (cosine) make no visible difference: the triangle
/// is flat.
const FLAT_COSINE: f32 = 0.999_999;

/// Which corner normals a mesh gets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum NormalRule {
    /// The file's where it has them, else smooth across edges below 60 degrees, else flat.
    File,
    /// The course's: always smooth, weighted by area.
    AlwaysSmooth,
}

/// World-space unit normals at the corners of each triangle of `mesh`, `None` for a flat one.
///
/// `face_normals` are the area-weighted world-space normals of the triangles (length twice the
/// area); `normal_to_world` is the inverse transpose of the placement's linear part.
pub(super) fn corner_normals(
    mesh: &Mesh,
    face_normals: &[DVec3],
    normal_to_world: DMat3,
    rule: NormalRule,
) -> Vec<Option<[Vec3; 3]>> {
    let needs_smoothing = rule == NormalRule::AlwaysSmooth
        || mesh
            .triangles
            .iter()
            .any(|t| t.corners.iter().any(|c| !has_normal(mesh, *c)));
    let around = needs_smoothing.then(|| FacesAroundVertices::new(mesh));
    mesh.triangles
        .iter()
        .zip(face_normals)
        .map(|(triangle, face)| {
            let flat = face.try_normalize()?;
            let corners = triangle.corners.map(|corner| {
                if rule == NormalRule::File && has_normal(mesh, corner) {
                    let world = normal_to_world * mesh.normals[corner.normal as usize].as_dvec3();
                    return world.try_normalize().unwrap_or(flat);
                }
                around.as_ref().map_or(flat, |around| {
                    around.smooth(corner.position, face_normals, flat, rule)
                })
            });
            // Files whose winding contradicts their normals mean the side of their normals to be
            // shaded; the geometric normal keeps the winding, so the shading normal follows it.
            let corners = corners.map(|n| if n.dot(flat) < 0.0 { -n } else { n }.as_vec3());
            let flat = flat.as_vec3();
            corners
                .iter()
                .any(|n| n.dot(flat) < FLAT_COSINE)
                .then_some(corners)
        })
        .collect()
}

/// True when the file gives the normal of a corner.
pub(super) fn has_normal(mesh: &Mesh, corner: Corner) -> bool {
    (corner.normal as usize) < mesh.normals.len()
}

/// The triangles around each vertex, as one array cut by offsets.
struct FacesAroundVertices {
    offsets: Vec<u32>,
    faces: Vec<u32>,
}

impl FacesAroundVertices {
    fn new(mesh: &Mesh) -> Self {
        let mut offsets = vec![0_u32; mesh.positions.len() + 1];
        let corners = || {
            mesh.triangles
                .iter()
                .enumerate()
                .flat_map(|(face, t)| t.corners.map(|c| (face as u32, c.position as usize)))
        };
        for (_, vertex) in corners() {
            offsets[vertex + 1] += 1;
        }
        for i in 1..offsets.len() {
            offsets[i] += offsets[i - 1];
        }
        let mut next = offsets.clone();
        let mut faces = vec![0_u32; mesh.triangles.len() * 3];
        for (face, vertex) in corners() {
            faces[next[vertex] as usize] = face;
            next[vertex] += 1;
        }
        Self { offsets, faces }
    }

    fn smooth(&self, vertex: u32, face_normals: &[DVec3], flat: DVec3, rule: NormalRule) -> DVec3 {
        let vertex = vertex as usize;
        let faces = &self.faces[self.offsets[vertex] as usize..self.offsets[vertex + 1] as usize];
        let sum: DVec3 = faces
            .iter()
            .map(|&face| face_normals[face as usize])
            .filter(|n| {
                rule == NormalRule::AlwaysSmooth || n.dot(flat) >= CREASE_COSINE * n.length()
            })
            .sum();
        sum.try_normalize().unwrap_or(flat)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::MeshTriangle;

    /// Two triangles that share the edge from the origin along z and bend by `degrees`.
    fn hinge(degrees: f64) -> Mesh {
        let corner = |position| Corner {
            position,
            normal: Corner::NO_NORMAL,
        };
        let (sin, cos) = degrees.to_radians().sin_cos();
        Mesh {
            positions: vec![DVec3::ZERO, DVec3::Z, DVec3::X, DVec3::new(-cos, sin, 0.0)],
            triangles: vec![
                MeshTriangle {
                    corners: [0, 1, 2].map(corner),
                    material_slot: 0,
                },
                MeshTriangle {
                    corners: [1, 0, 3].map(corner),
                    material_slot: 0,
                },
            ],
            ..Mesh::default()
        }
    }

    fn normals(mesh: &Mesh, rule: NormalRule) -> Vec<Option<[Vec3; 3]>> {
        let faces: Vec<DVec3> = mesh
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.corners.map(|c| mesh.positions[c.position as usize]);
                (b - a).cross(c - a)
            })
            .collect();
        corner_normals(mesh, &faces, DMat3::IDENTITY, rule)
    }

    #[test]
    fn edges_below_sixty_degrees_are_smooth_and_others_flat() {
        let smooth = normals(&hinge(50.0), NormalRule::File);
        let (first, second) = (smooth[0].expect("smooth"), smooth[1].expect("smooth"));
        assert!(
            (first[0] - second[1]).length() < 1e-6,
            "one normal at the shared vertex"
        );
        assert_eq!(normals(&hinge(70.0), NormalRule::File), vec![None, None]);
        assert!(normals(&hinge(70.0), NormalRule::AlwaysSmooth)[0].is_some());
    }

    #[test]
    fn the_files_normals_win_and_flat_ones_cost_nothing() {
        let mut mesh = hinge(50.0);
        mesh.normals = vec![Vec3::Y, Vec3::new(0.6, 0.8, 0.0)];
        mesh.triangles[0].corners[0].normal = 1;
        mesh.triangles[0].corners[1].normal = 0;
        mesh.triangles[0].corners[2].normal = 0;
        let result = normals(&mesh, NormalRule::File);
        let first = result[0].expect("one corner is tilted");
        assert!((first[0] - Vec3::new(0.6, 0.8, 0.0)).length() < 1e-6 && first[1] == Vec3::Y);
        mesh.triangles[0].corners[0].normal = 0;
        assert_eq!(normals(&mesh, NormalRule::File)[0], None);
    }
}
