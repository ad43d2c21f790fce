use std::collections::HashMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use super::shading_normals::NormalRule;
use super::shared_mesh::{MeshTables, share_mesh};
use super::{Geometry, PreparedScene};
use crate::bvh::BvhSettings;
use crate::geometry::{Aggregate, Mesh, Shapes};

/// A hierarchy that fits moved shapes and costs rays up to this much more than before is kept.
const MOST_GROWTH: f64 = 1.3;

/// What one scene's preparation leaves for the next, so that an edit builds as little as possible: a
/// shared mesh keeps its hierarchy wherever its instances go, and what is not shared keeps its own,
/// fitted to the vertices where these have moved. Never changes a hit. Holds the memory of what the
/// last scene used, and nothing else.
#[derive(Debug, Default)]
pub struct PrepareCache {
    meshes: HashMap<MeshKey, KeptMesh>,
    own: Option<KeptOwn>,
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
    /// Hierarchies over what is not shared that were fitted to moved vertices.
    pub own_refitted: u64,
}

/// The hierarchy over everything that is not shared.
#[derive(Debug)]
struct KeptOwn {
    settings: BvhSettings,
    tree: Aggregate,
    /// Nodes and blocks that a ray was expected to visit when it was built.
    built_cost: f64,
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
        if let Some(own) = &mut self.own {
            own.tree = scene.aggregate.without_instances();
            own.built_cost = own.tree.expected_visits();
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

    /// Begins to prepare another scene.
    pub(super) fn begin(&mut self) {
        for kept in self.meshes.values_mut() {
            kept.is_used = false;
        }
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
        let kept = self.own.take().filter(|own| own.settings == bvh);
        let own = match kept.and_then(|own| self.keep(own, &shapes)) {
            Some(own) => own,
            None => {
                self.counts.own_built += 1;
                let tree = Aggregate::build_with(shapes, bvh, progress)?;
                KeptOwn {
                    settings: bvh,
                    built_cost: tree.expected_visits(),
                    tree,
                }
            }
        };
        let tree = own.tree.clone();
        self.own = Some(own);
        Some(tree)
    }

    /// `own` for `shapes`, fitted if they have moved; `None` if they are others or have moved too far.
    fn keep(&mut self, own: KeptOwn, shapes: &Shapes) -> Option<KeptOwn> {
        let old = own.tree.shapes();
        if old.triangles != shapes.triangles || old.spheres != shapes.spheres {
            return None;
        }
        if old.positions == shapes.positions {
            self.counts.own_reused += 1;
            return Some(own);
        }
        if old.positions.len() != shapes.positions.len() {
            return None;
        }
        let mut tree = own.tree;
        let cost = tree.refit(shapes.positions.clone())?;
        (cost <= own.built_cost * MOST_GROWTH).then(|| {
            self.counts.own_refitted += 1;
            KeptOwn { tree, ..own }
        })
    }

    /// Forgets what the scene that is prepared now does not use.
    pub(super) fn end(&mut self) {
        self.meshes.retain(|_, kept| kept.is_used);
    }
}
