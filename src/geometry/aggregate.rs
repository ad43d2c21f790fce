use std::ops::{ControlFlow, Range};
use std::sync::Arc;

use super::block::ID_LIMIT;
use super::leaf::LeafOrder;
use super::packet_leaf::PacketHits;
use super::quads::LeafPrimitives;
use super::refine::{refine, refine_meshes};
use super::sweep::Sweep;
use super::{Hit, Instance, InstanceStats, Instances, Placement, Shapes};
use crate::bvh::{BLOCK, Bvh, BvhKind, BvhQuality, BvhSettings, BvhStats, NodeId, Progress, Work};
use crate::math::{Aabb, Isa, Ray};

/// Up to this many shapes a tree of high quality is built at once: it takes some 25 ms.
const SMALL: usize = 16_384;

/// Work done by traversal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TraceCounts {
    /// Rays traced.
    pub rays: u64,
    /// Boxes tested; a node counts all its eight, whether or not it is full.
    pub box_tests: u64,
    /// Primitives tested, a quad as one; a block counts four, whether or not it is full.
    pub primitive_tests: u64,
}

impl TraceCounts {
    fn add(&mut self, rays: usize, work: Work) {
        self.rays += rays as u64;
        self.box_tests += work.nodes * 8;
        self.primitive_tests += work.blocks * BLOCK as u64;
    }
}

/// Shapes under a bounding volume hierarchy, and meshes that stand beside them without being
/// copied: the batch tracing interface.
///
/// Primitive ids count the shapes first, then the triangles of each instance.
///
/// In a hierarchy of kind [`BvhKind::Sah`] two triangles that share an edge are one primitive, a quad, if
/// their vertices are in the order for it: [`Shapes::turn_to_quads`].
///
/// The answer to a ray does not depend on the tree: every kind of [`BvhSettings`] gives the same
/// bits. Triangles are watertight and have two sides; those without area or with a vertex that is
/// not finite are never hit. A ray with a number that is not finite (other than `t_max`) hits
/// nothing, and nothing is hit at or beyond [`crate::bvh::T_FAR`].
///
/// A clone shares everything.
#[derive(Clone, Debug)]
pub struct Aggregate {
    pub(super) shapes: Arc<Shapes>,
    pub(super) bvh: Arc<Bvh>,
    pub(super) leaves: Arc<LeafOrder>,
    /// What small scenes are traced by instead of the tree.
    pub(super) sweep: Option<Arc<Sweep>>,
    /// What rays can meet besides; `None` for most.
    instances: Option<Arc<Instances>>,
    leaf_size: u32,
    pub(super) is_refined: bool,
    isa: Isa,
}

impl Aggregate {
    /// Builds the hierarchy over `shapes`, on all threads of the current pool.
    pub fn build(shapes: Shapes, settings: BvhSettings) -> Self {
        Self::build_with(shapes, settings, &|_| ControlFlow::Continue(()))
            .expect("nothing asks this build to stop")
    }

    /// Like [`Self::build`]; reports the finished fraction (0 to 1, from any thread, not in order)
    /// to `progress`, which may stop the build. `None` if it did. High quality begins with the
    /// standard tree, unless there are few shapes; see [`Self::refined`].
    pub fn build_with(
        shapes: Shapes,
        settings: BvhSettings,
        progress: &Progress<'_>,
    ) -> Option<Self> {
        assert!(shapes.len() < ID_LIMIT as usize, "too many primitives");
        let is_refined = settings.quality == BvhQuality::High && shapes.len() <= SMALL;
        let quality = match settings.quality {
            BvhQuality::High if !is_refined => BvhQuality::Standard,
            quality => quality,
        };
        let first = BvhSettings {
            quality,
            ..settings
        };
        let primitives = LeafPrimitives::new(&shapes, settings.kind);
        let (mut bvh, ids) = primitives.build(&first, progress)?;
        let leaves = LeafOrder::new(&primitives, &mut bvh, &ids);
        // The other kinds are there to be compared.
        let is_best = settings.kind == BvhKind::Sah;
        let sweep = is_best.then(|| Sweep::new(&shapes)).flatten();
        Some(Self {
            shapes: Arc::new(shapes),
            bvh: Arc::new(bvh),
            leaves: Arc::new(leaves),
            sweep: sweep.map(Arc::new),
            instances: None,
            leaf_size: settings.leaf_size,
            is_refined: is_refined || settings.kind != BvhKind::Sah,
            isa: Isa::best(),
        })
    }

    /// True when [`Self::refined`] would gain nothing.
    pub fn is_refined(&self) -> bool {
        let meshes = self.instances().map(Instances::meshes);
        self.is_refined && meshes.is_none_or(|all| all.iter().all(|mesh| mesh.is_refined()))
    }

    /// Places meshes beside the shapes, in the place of those that were; ids go on after the
    /// shapes.
    ///
    /// # Panics
    /// If a mesh has spheres or instances itself, or the ids do not fit in 32 bits.
    #[must_use]
    pub fn with_instances(self, placed: Vec<(Arc<Self>, Placement)>) -> Self {
        let instances = (!placed.is_empty()).then(|| Arc::new(Instances::new(&self, placed)));
        Self { instances, ..self }
    }

    /// The shapes alone; nothing is copied.
    #[must_use]
    pub fn without_instances(&self) -> Self {
        Self {
            instances: None,
            ..self.clone()
        }
    }

    /// Another hierarchy over the same (shared) shapes that costs rays less and takes longer to
    /// make; `progress` as in [`Self::build_with`].
    pub fn refined(&self, progress: &Progress<'_>) -> Option<Self> {
        match &self.instances {
            None => self.refined_alone(progress),
            Some(instances) => refine_meshes(self, instances, progress),
        }
    }

    /// [`Self::refined`] without the instances.
    pub(super) fn refined_alone(&self, progress: &Progress<'_>) -> Option<Self> {
        let primitives = LeafPrimitives::new(&self.shapes, BvhKind::Sah);
        let (mut bvh, ids) = refine(&primitives, self.leaf_size, progress)?;
        let leaves = LeafOrder::new(&primitives, &mut bvh, &ids);
        Some(Self {
            shapes: Arc::clone(&self.shapes),
            bvh: Arc::new(bvh),
            leaves: Arc::new(leaves),
            sweep: self.sweep.clone(),
            instances: None,
            leaf_size: self.leaf_size,
            is_refined: true,
            isa: self.isa,
        })
    }

    /// The same, traced with `isa`.
    ///
    /// # Panics
    /// When tracing, if this processor does not have it.
    #[must_use]
    pub fn with_isa(self, isa: Isa) -> Self {
        Self { isa, ..self }
    }

    /// The same, traced by the tree alone, however small the scene is; never changes a hit.
    #[must_use]
    pub fn without_sweep(self) -> Self {
        Self {
            sweep: None,
            ..self
        }
    }

    /// True if batches of rays are traced by a sweep over all shapes instead of the tree, as in small
    /// scenes.
    pub fn is_swept(&self) -> bool {
        self.sweep.is_some()
    }

    /// The instruction set that traces; never changes a hit.
    pub fn isa(&self) -> Isa {
        self.isa
    }

    /// The instances; `None` if there are none.
    pub fn instances(&self) -> Option<&Instances> {
        self.instances.as_deref()
    }

    /// The instance that holds `primitive`, and the triangle of its mesh; `None` if `primitive` is
    /// one of the shapes.
    #[inline]
    pub fn find_instance(&self, primitive: u32) -> Option<(&Instance, usize)> {
        let instances = self.instances.as_deref()?;
        let (number, triangle) = instances.find(primitive)?;
        Some((&instances.list()[number], triangle))
    }

    /// What the instances share and what that saves; all zero without instances.
    pub fn instance_stats(&self) -> InstanceStats {
        let stats = self.instances().map(Instances::stats);
        stats.unwrap_or_default()
    }

    /// Number of primitive ids: the shapes, and the triangles of each instance.
    pub fn primitive_count(&self) -> usize {
        self.shapes.len() + self.instances().map_or(0, Instances::primitive_count)
    }

    /// The box around the shapes, without the instances.
    pub(super) fn own_bounds(&self) -> Aabb {
        let root = self.bvh.root();
        root.map_or(Aabb::EMPTY, |root| self.bvh.bounds(root))
    }

    /// Ids of all shapes below a node of [`Self::bvh`].
    pub fn primitives(&self, node: NodeId) -> impl Iterator<Item = u32> + '_ {
        let places = self.bvh.leaves(node).flatten();
        places.flat_map(|place| self.ids_at(place))
    }

    /// The shapes in a place, as in [`Bvh::leaves`].
    fn ids_at(&self, place: usize) -> impl Iterator<Item = u32> + '_ {
        self.leaves.blocks()[place / BLOCK].ids_of(place % BLOCK)
    }

    /// Whether some of these places hold a shape.
    pub(super) fn holds(&self, mut places: Range<usize>, id: u32) -> bool {
        places.any(|place| self.ids_at(place).any(|found| found == id))
    }

    /// The shapes, without those of instances.
    pub fn shapes(&self) -> &Shapes {
        &self.shapes
    }

    /// The hierarchy over the shapes; what it counts as one primitive may be a quad.
    pub fn bvh(&self) -> &Bvh {
        &self.bvh
    }

    /// Shape, cost and memory of the hierarchy over the shapes, the vertices gathered for its leaves
    /// included.
    pub fn stats(&self) -> BvhStats {
        let mut stats = self.bvh.stats();
        stats.quads = self.leaves.quads();
        stats.set_bytes(stats.bytes + self.leaves.bytes());
        stats
    }

    /// Writes the closest hit of each ray; the smaller primitive id wins at equal `t`.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn closest_hit(&self, rays: &[Ray], hits: &mut [Hit], counts: &mut TraceCounts) {
        assert_eq!(rays.len(), hits.len());
        self.trace::<false>(rays, counts, |i, hit| hits[i] = hit);
        if let Some(instances) = &self.instances {
            instances.closest_hit(self.isa, rays, hits, counts);
        }
    }

    /// The same as [`Self::closest_hit`], several times as fast if every 32 rays in a row (the first
    /// 32, the next, and so on) take nearly the same way: those through 8 x 4 pixels, or several
    /// samples of fewer pixels. Best of all if they start at one point. Rays that part go on one by
    /// one; rays that never agreed in the signs and the longest axis of their directions cost a little
    /// more than there.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn closest_hit_coherent(&self, rays: &[Ray], hits: &mut [Hit], counts: &mut TraceCounts) {
        assert_eq!(rays.len(), hits.len());
        let (isa, leaves) = (self.isa, &*self.leaves);
        let answers = &mut PacketHits(hits);
        let work = self.bvh.traverse_coherent(isa, leaves, rays, answers);
        counts.add(rays.len(), work);
        if let Some(instances) = &self.instances {
            instances.closest_hit(isa, rays, hits, counts);
        }
    }

    /// Writes for each ray whether anything lies on it.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn any_hit(&self, rays: &[Ray], occluded: &mut [bool], counts: &mut TraceCounts) {
        assert_eq!(rays.len(), occluded.len());
        self.trace::<true>(rays, counts, |i, hit| occluded[i] = !hit.is_miss());
        if let Some(instances) = &self.instances {
            instances.any_hit(self.isa, rays, occluded, counts);
        }
    }

    /// The closest hit of one ray.
    pub fn closest(&self, ray: &Ray) -> Hit {
        let mut hits = [Hit::MISS];
        self.closest_hit(&[*ray], &mut hits, &mut TraceCounts::default());
        hits[0]
    }

    /// Gives `answer` the number of each ray and its hit with the shapes, without the instances; in
    /// any order.
    pub(super) fn trace_shapes<const ANY: bool>(
        &self,
        isa: Isa,
        rays: &[Ray],
        mut answer: impl FnMut(usize, Hit),
    ) -> Work {
        let leaves = &*self.leaves;
        self.bvh.traverse::<ANY, _>(isa, leaves, rays, |i, query| {
            answer(i, query.map_or(Hit::MISS, |query| query.hit));
        })
    }

    fn trace<const ANY: bool>(
        &self,
        rays: &[Ray],
        counts: &mut TraceCounts,
        mut answer: impl FnMut(usize, Hit),
    ) {
        let isa = self.isa;
        let sweep = self
            .sweep
            .as_ref()
            .filter(|sweep| sweep.is_for::<ANY>(rays.len()));
        let Some(sweep) = sweep else {
            let work = self.trace_shapes::<ANY>(isa, rays, answer);
            counts.add(rays.len(), work);
            return;
        };
        let rest = sweep.trace::<ANY>(isa, rays, &mut answer, counts);
        let left: Vec<_> = rest.iter().map(|&i| rays[i as usize]).collect();
        let work = self.trace_shapes::<ANY>(isa, &left, |i, hit| answer(rest[i] as usize, hit));
        counts.add(rays.len(), work);
    }
}
