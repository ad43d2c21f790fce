use std::collections::{HashMap, HashSet};
use std::ops::ControlFlow;
use std::sync::Arc;

use glam::{DMat4, DVec3};

use super::shading_normals::NormalRule;
use super::shared_mesh::{MeshTables, share_mesh};
use super::{Geometry, PreparedScene, Scene};
use crate::bvh::BvhSettings;
use crate::geometry::{Aggregate, Mesh, Shapes};
use crate::math::Normalization;

/// In a tracing space that is kept, half the size of the scene is above this (a new one has ½ to 1) …
const SMALLEST_HALF: f64 = 0.25;
/// … and no coordinate is larger.
const FARTHEST_CORNER: f64 = 2.0;

/// What one scene's preparation leaves for the next, so that an edit that moves objects builds no
/// hierarchy again. Holds the memory of what the last scene used, and nothing else.
///
/// A mesh that an edit has moved is shared from then on, even if it is used once: it gets a
/// hierarchy of its own, which later moves leave as it is. So the picture of an edited scene may
/// differ from that of the same scene, opened anew, by rounding. Its tracing space stays, too, as long
/// as that is of about the scene's size: otherwise every hierarchy that is not shared would change
/// when an object moves the bounds of the scene.
#[derive(Debug, Default)]
pub struct PrepareCache {
    meshes: HashMap<MeshKey, KeptMesh>,
    /// The hierarchy over everything that is not shared.
    own: Option<(BvhSettings, Aggregate)>,
    /// Geometry and place of each instance of the last scene.
    placed: Vec<(Arc<Geometry>, DMat4)>,
    moved: Vec<Arc<Geometry>>,
    /// That of the last scene.
    normalization: Option<Normalization>,
    counts: PrepareCounts,
}

/// Hierarchies that were made, and that were there already.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PrepareCounts {
    /// Hierarchies over shared meshes that were built.
    pub meshes_built: u64,
    /// Hierarchies over shared meshes that scenes took over from the one before.
    pub meshes_reused: u64,
    /// Hierarchies over what is not shared that were built.
    pub own_built: u64,
    /// Hierarchies over what is not shared that scenes took over from the one before.
    pub own_reused: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct MeshKey {
    /// Address of the geometry, which is kept as long as the key.
    geometry: usize,
    bvh: BvhSettings,
    rule: NormalRule,
}

#[derive(Debug)]
struct KeptMesh {
    _geometry: Arc<Geometry>,
    tables: Arc<MeshTables>,
    tree: Arc<Aggregate>,
    /// The scene that is being prepared uses it.
    is_used: bool,
}

impl PrepareCache {
    /// What was built and what was not, since the cache was made.
    pub fn counts(&self) -> PrepareCounts {
        self.counts
    }

    /// Takes over the hierarchies of `scene`, a refined form of the last one that was prepared.
    pub fn adopt(&mut self, scene: &PreparedScene) {
        if let Some((_, own)) = &mut self.own {
            *own = scene.aggregate.without_instances();
        }
        let Some(instances) = scene.aggregate.instances() else {
            return;
        };
        let refined: HashMap<_, _> = (scene.tables.shared.iter())
            .zip(instances.list())
            .map(|(shared, instance)| (Arc::as_ptr(&shared.tables), instance.mesh()))
            .collect();
        for kept in self.meshes.values_mut() {
            if let Some(tree) = refined.get(&Arc::as_ptr(&kept.tables)) {
                kept.tree = Arc::clone(tree);
            }
        }
    }

    /// Finds out which geometries `scene` has moved.
    pub(super) fn begin(&mut self, scene: &Scene) {
        for kept in self.meshes.values_mut() {
            kept.is_used = false;
        }
        let used: HashSet<_> = (scene.geometries.iter()).map(Arc::as_ptr).collect();
        self.moved
            .retain(|moved| used.contains(&Arc::as_ptr(moved)));
        for ((geometry, place), instance) in self.placed.iter().zip(&scene.instances) {
            let is_same = Arc::ptr_eq(geometry, &scene.geometries[instance.geometry]);
            if is_same && *place != instance.world_from_object && !was_moved(&self.moved, geometry)
            {
                self.moved.push(Arc::clone(geometry));
            }
        }
    }

    /// True when an edit has moved `geometry`.
    pub(super) fn was_moved(&self, geometry: &Arc<Geometry>) -> bool {
        was_moved(&self.moved, geometry)
    }

    /// The tracing space of a scene with the bounds `min` and `max` in the file: that of the scene
    /// before an edit if it is still good, else the one that fits.
    pub(super) fn normalization(&self, min: DVec3, max: DVec3) -> Normalization {
        let is_good = |known: &Normalization| {
            let half = (max - min).max_element() * 0.5 * known.scale;
            let corners = [min, max].map(|p| known.point_to_scene_f64(p).abs().max_element());
            half > SMALLEST_HALF && corners.into_iter().all(|c| c < FARTHEST_CORNER)
        };
        let known = self.normalization.filter(|_| !self.moved.is_empty());
        known
            .filter(is_good)
            .unwrap_or_else(|| Normalization::fit(min, max))
    }

    /// The tables and the hierarchy of `mesh`, which is `geometry`; `None` when `progress` breaks.
    pub(super) fn mesh(
        &mut self,
        (geometry, mesh): (&Arc<Geometry>, &Mesh),
        rule: NormalRule,
        bvh: BvhSettings,
        progress: &(dyn Fn(f32) -> ControlFlow<()> + Sync),
    ) -> Option<(Arc<MeshTables>, Arc<Aggregate>)> {
        let key = MeshKey {
            geometry: Arc::as_ptr(geometry) as usize,
            bvh,
            rule,
        };
        if let Some(kept) = self.meshes.get_mut(&key) {
            self.counts.meshes_reused += u64::from(!kept.is_used);
            kept.is_used = true;
            return Some((Arc::clone(&kept.tables), Arc::clone(&kept.tree)));
        }
        let (tables, tree) = share_mesh(mesh, rule, bvh, progress)?;
        self.counts.meshes_built += 1;
        let (tables, tree) = (Arc::new(tables), Arc::new(tree));
        let kept = KeptMesh {
            _geometry: Arc::clone(geometry),
            tables: Arc::clone(&tables),
            tree: Arc::clone(&tree),
            is_used: true,
        };
        self.meshes.insert(key, kept);
        Some((tables, tree))
    }

    /// The hierarchy over `shapes`; `None` when `progress` breaks.
    pub(super) fn own(
        &mut self,
        shapes: Shapes,
        bvh: BvhSettings,
        progress: &(dyn Fn(f32) -> ControlFlow<()> + Sync),
    ) -> Option<Aggregate> {
        let kept = self.own.take();
        let own = match kept.filter(|(built, own)| *built == bvh && *own.shapes() == shapes) {
            Some((_, own)) => {
                self.counts.own_reused += 1;
                own
            }
            None => {
                self.counts.own_built += 1;
                Aggregate::build_with(shapes, bvh, progress)?
            }
        };
        self.own = Some((bvh, own.clone()));
        Some(own)
    }

    /// Forgets what `scene`, which is prepared now, does not use.
    pub(super) fn end(&mut self, scene: &Scene, normalization: Normalization) {
        self.normalization = Some(normalization);
        self.meshes.retain(|_, kept| kept.is_used);
        let geometry = |i: &super::Instance| Arc::clone(&scene.geometries[i.geometry]);
        self.placed = (scene.instances.iter())
            .map(|instance| (geometry(instance), instance.world_from_object))
            .collect();
    }
}

fn was_moved(moved: &[Arc<Geometry>], geometry: &Arc<Geometry>) -> bool {
    moved.iter().any(|moved| Arc::ptr_eq(moved, geometry))
}
