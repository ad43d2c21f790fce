use glam::{DVec3, Vec3};

/// One corner of a mesh triangle: index of its position and, where the file has them, its normal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corner {
    /// Index into [`Mesh::positions`].
    pub position: u32,
    /// Index into [`Mesh::normals`], or [`Corner::NO_NORMAL`].
    pub normal: u32,
}

impl Corner {
    /// The file gave no normal for this corner.
    pub const NO_NORMAL: u32 = u32::MAX;
}

/// A triangle of a [`Mesh`], counter-clockwise seen from its front.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshTriangle {
    /// The three corners.
    pub corners: [Corner; 3],
    /// Which of the instance's materials it has.
    pub material_slot: u16,
}

/// Triangles as a file holds them, in object space and double precision.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Name or id in the file.
    pub name: String,
    /// Vertices, in the file's units, before any node transform.
    pub positions: Vec<DVec3>,
    /// Unit normals in object space; may be empty.
    pub normals: Vec<Vec3>,
    /// Triangles; every index is in range.
    pub triangles: Vec<MeshTriangle>,
}

impl Mesh {
    /// The positions that triangles have, each once.
    pub fn used_positions(&self) -> Vec<DVec3> {
        let mut is_used = vec![false; self.positions.len()];
        for corner in self.triangles.iter().flat_map(|t| t.corners) {
            is_used[corner.position as usize] = true;
        }
        let positions = self.positions.iter().zip(is_used);
        positions
            .filter(|(_, used)| *used)
            .map(|(p, _)| *p)
            .collect()
    }
}
