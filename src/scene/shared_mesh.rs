use std::ops::ControlFlow;
use std::sync::Arc;

use glam::{DAffine3, DMat4, DVec3, Vec3};

use super::placed_mesh::PlacedMesh;
use super::prepared::FLAT;
use super::shading_normals::NormalRule;
use crate::bvh::BvhSettings;
use crate::geometry::{Aggregate, Mesh, Placement, Shapes};
use crate::math::Normalization;

/// What is known about the triangles of a mesh that instances share, but where rays meet them.
#[derive(Debug)]
pub(super) struct MeshTables {
    /// From the mesh's coordinates in the file to those of its hierarchy.
    normalization: Normalization,
    /// Material slot of each triangle; empty when all are 0.
    slots: Vec<u16>,
    /// As in the tables of a scene, in the space of the mesh.
    smooth: Vec<u32>,
    corner_normals: Vec<[Vec3; 3]>,
}

/// Makes the tables of a mesh and its hierarchy; `None` when `progress` breaks.
pub(super) fn share_mesh(
    mesh: &Mesh,
    rule: NormalRule,
    settings: BvhSettings,
    progress: &(dyn Fn(f32) -> ControlFlow<()> + Sync),
) -> Option<(MeshTables, Aggregate)> {
    let placed = PlacedMesh::new(mesh, DMat4::IDENTITY, rule);
    let used = mesh.used_positions().into_iter();
    let (min, max) = used
        .filter(|p| p.is_finite())
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| {
            (min.min(p), max.max(p))
        });
    let normalization = if min.x <= max.x {
        Normalization::fit(min, max)
    } else {
        Normalization::IDENTITY
    };
    let slots: Vec<u16> = mesh.triangles.iter().map(|t| t.material_slot).collect();
    let mut tables = MeshTables {
        normalization,
        slots: if slots.iter().all(|slot| *slot == 0) {
            Vec::new()
        } else {
            slots
        },
        smooth: Vec::new(),
        corner_normals: Vec::new(),
    };
    for normals in &placed.corner_normals {
        tables.smooth.push(match normals {
            Some(_) => tables.corner_normals.len() as u32,
            None => FLAT,
        });
        tables.corner_normals.extend(*normals);
    }
    if tables.corner_normals.is_empty() {
        tables.smooth = Vec::new();
    }
    let shapes = Shapes {
        positions: (placed.positions.iter())
            .map(|&p| normalization.point_to_scene(p))
            .collect(),
        triangles: placed.triangles,
        spheres: Vec::new(),
    };
    let tree = Aggregate::build_with(shapes, settings, progress)?;
    Some((tables, tree))
}

impl MeshTables {
    /// Where the hierarchy stands in tracing space for a mesh that the file places with
    /// `world_from_object`.
    pub(super) fn placement(
        &self,
        world_from_object: DMat4,
        normalization: &Normalization,
    ) -> Option<Placement> {
        let to_file = DAffine3::from_translation(self.normalization.center)
            * DAffine3::from_scale(DVec3::splat(1.0 / self.normalization.scale));
        let to_scene = DAffine3::from_scale(DVec3::splat(normalization.scale))
            * DAffine3::from_translation(-normalization.center);
        Placement::new(to_scene * DAffine3::from_mat4(world_from_object) * to_file)
    }

    pub(super) fn slot(&self, triangle: usize) -> u16 {
        self.slots.get(triangle).copied().unwrap_or(0)
    }

    pub(super) fn corner_normals(&self, triangle: usize) -> Option<&[Vec3; 3]> {
        let index = *self.smooth.get(triangle)?;
        (index != FLAT).then(|| &self.corner_normals[index as usize])
    }

    /// Memory in bytes.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.slots.as_slice())
            + size_of_val(self.smooth.as_slice())
            + size_of_val(self.corner_normals.as_slice())
    }
}

/// What an instance adds to the tables of its mesh.
#[derive(Clone, Debug)]
pub(super) struct SharedMesh {
    pub(super) tables: Arc<MeshTables>,
    /// Owner of the triangles with material slot 0; those of the other slots follow.
    pub(super) first_owner: u32,
    /// Number of slots, at least 1; triangles with a larger one have the last.
    pub(super) slots: u16,
}

impl SharedMesh {
    /// The owner of a triangle of the mesh.
    pub(super) fn owner(&self, triangle: usize) -> usize {
        let slot = self.tables.slot(triangle).min(self.slots - 1);
        self.first_owner as usize + usize::from(slot)
    }
}
