use std::collections::HashMap;
use std::sync::Arc;

use serde::Serialize;

use super::{Aggregate, Instance, Placement};
use crate::bvh::{BLOCK, Bvh, BvhSettings, NO_PRIMITIVE, NodeId, padded};
use crate::math::Aabb;

/// Rays that start farther away than this many times the largest coordinate of anything may miss an
/// instance along its silhouette, by as much as their origin is rounded.
const FARTHEST_ORIGIN: f32 = 16.0;

/// Instances under a hierarchy over their boxes.
#[derive(Clone, Debug)]
pub struct Instances {
    list: Vec<Instance>,
    /// The meshes, each once, in the order of their first instances.
    meshes: Vec<Arc<Aggregate>>,
    /// For each instance the place of its mesh in `meshes`.
    mesh_of: Vec<u32>,
    /// The box of each instance, as it stands in the hierarchy.
    boxes: Vec<Aabb>,
    bvh: Bvh,
    blocks: Vec<InstanceBlock>,
    /// One after the last id.
    end: u32,
}

/// Some instances of a leaf.
#[derive(Clone, Copy, Debug)]
pub(super) struct InstanceBlock {
    ids: [u32; BLOCK],
    /// The leaf goes on in the next block.
    pub(super) has_more: bool,
}

/// What the instances of an aggregate share.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct InstanceStats {
    /// Instances.
    pub instances: usize,
    /// Meshes that they place.
    pub meshes: usize,
    /// Triangles in memory.
    pub unique_triangles: usize,
    /// Triangles that rays meet.
    pub virtual_triangles: usize,
    /// Memory of instances, meshes and hierarchies, in bytes.
    pub bytes: usize,
}

impl InstanceBlock {
    /// The instances.
    #[inline]
    pub(super) fn ids(&self) -> impl Iterator<Item = usize> + '_ {
        let used = self.ids.iter().filter(|&&id| id != NO_PRIMITIVE);
        used.map(|&id| id as usize)
    }
}

impl Instances {
    /// Places meshes beside `beside`; ids go on after its own.
    pub(super) fn new(beside: &Aggregate, placed: Vec<(Arc<Aggregate>, Placement)>) -> Self {
        let mut end = u32::try_from(beside.shapes().len()).expect("the build checked the number");
        let mut list = Vec::with_capacity(placed.len());
        let (mut meshes, mut mesh_of) = (Vec::new(), Vec::with_capacity(placed.len()));
        let mut known = HashMap::new();
        for (mesh, placement) in placed {
            mesh_of.push(*known.entry(Arc::as_ptr(&mesh)).or_insert_with(|| {
                meshes.push(Arc::clone(&mesh));
                meshes.len() as u32 - 1
            }));
            assert!(
                mesh.instances().is_none() && mesh.shapes().spheres.is_empty(),
                "an instance places triangles"
            );
            let size = u32::try_from(mesh.shapes().len()).expect("the build checked the number");
            list.push(Instance::new(mesh, placement, end));
            end = end.checked_add(size).expect("too many primitives");
        }
        assert!(end < u32::MAX, "too many primitives");
        let own = beside.own_bounds();
        let tight: Vec<Aabb> = list.iter().map(|i| bounds(i, 0.0)).collect();
        let all = tight.iter().fold(own, |all, one| all.union(*one));
        let reach = all.min.abs().max(all.max.abs()).max_element() * FARTHEST_ORIGIN;
        let reach = if reach.is_finite() { reach } else { 0.0 };
        let boxes: Vec<Aabb> = list.iter().map(|i| bounds(i, reach)).collect();
        let settings = BvhSettings {
            leaf_size: 1,
            ..BvhSettings::default()
        };
        let (bvh, ids) = Bvh::build(&boxes, &settings);
        let blocks = bvh.map_blocks(&ids, |&ids, has_more| InstanceBlock { ids, has_more });
        Self {
            boxes: boxes.into_iter().map(padded).collect(),
            list,
            meshes,
            mesh_of,
            bvh,
            blocks,
            end,
        }
    }

    /// The instances, in the order of their ids.
    pub fn list(&self) -> &[Instance] {
        &self.list
    }

    /// The hierarchy over their boxes.
    pub fn bvh(&self) -> &Bvh {
        &self.bvh
    }

    /// Numbers of all instances below a node of [`Self::bvh`].
    pub fn below(&self, node: NodeId) -> impl Iterator<Item = usize> + '_ {
        self.blocks[self.bvh.blocks(node)]
            .iter()
            .flat_map(InstanceBlock::ids)
    }

    /// The number of the instance that holds `primitive`, and the triangle of its mesh; `None` if
    /// the primitive is not one of an instance.
    pub fn find(&self, primitive: u32) -> Option<(usize, usize)> {
        let after = self
            .list
            .partition_point(|i| i.first_primitive() <= primitive);
        let number = after.checked_sub(1)?;
        let triangle = (primitive - self.list[number].first_primitive()) as usize;
        (primitive < self.end).then_some((number, triangle))
    }

    /// Number of primitives of all instances.
    pub fn primitive_count(&self) -> usize {
        let start = self
            .list
            .first()
            .map_or(self.end, Instance::first_primitive);
        (self.end - start) as usize
    }

    /// The meshes, each once, in the order of their first instances.
    pub fn meshes(&self) -> &[Arc<Aggregate>] {
        &self.meshes
    }

    /// The place of the mesh of instance `number` in [`Self::meshes`].
    pub(super) fn mesh_of(&self, number: usize) -> u32 {
        self.mesh_of[number]
    }

    /// What they share, and what that takes.
    pub(super) fn stats(&self) -> InstanceStats {
        let meshes = &self.meshes;
        let own = size_of_val(self.list.as_slice())
            + size_of_val(self.mesh_of.as_slice())
            + size_of_val(self.boxes.as_slice())
            + size_of_val(self.blocks.as_slice())
            + self.bvh.bytes();
        let mesh_bytes = meshes.iter().map(|mesh| {
            let shapes = mesh.shapes();
            mesh.stats().bytes
                + size_of_val(shapes.positions.as_slice())
                + size_of_val(shapes.triangles.as_slice())
        });
        InstanceStats {
            instances: self.list.len(),
            meshes: meshes.len(),
            unique_triangles: meshes.iter().map(|mesh| mesh.shapes().len()).sum(),
            virtual_triangles: self.primitive_count(),
            bytes: own + mesh_bytes.sum::<usize>(),
        }
    }

    pub(super) fn boxes(&self) -> &[Aabb] {
        &self.boxes
    }

    pub(super) fn blocks(&self) -> &[InstanceBlock] {
        &self.blocks
    }
}

/// The box of an instance for rays from within `reach`.
fn bounds(instance: &Instance, reach: f32) -> Aabb {
    let object = instance.mesh().own_bounds();
    instance.placement().bounds_in_world(&object, reach)
}
