use std::ops::ControlFlow;
use std::sync::Arc;

use super::block::{Block, ID_LIMIT};
use super::leaf::{LeafOrder, Query, boxes};
use super::refine::refine;
use super::{Hit, Shapes};
use crate::bvh::{BLOCK, Bvh, BvhSettings, BvhStats, NodeId, Work};
use crate::math::{Isa, Ray};

/// Work done by traversal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TraceCounts {
    /// Rays traced.
    pub rays: u64,
    /// Boxes tested; a node counts all its eight, whether or not it is full.
    pub box_tests: u64,
    /// Primitives tested; a block counts four, whether or not it is full.
    pub primitive_tests: u64,
}

impl TraceCounts {
    fn add(&mut self, rays: &[Ray], work: Work) {
        self.rays += rays.len() as u64;
        self.box_tests += work.nodes * 8;
        self.primitive_tests += work.blocks * BLOCK as u64;
    }
}

/// Shapes under a bounding volume hierarchy: the batch tracing interface.
///
/// The answer to a ray does not depend on the tree: every kind of [`BvhSettings`] gives the same
/// bits. Triangles are watertight and have two sides; those without area or with a vertex that is
/// not finite are never hit. A ray with a number that is not finite (other than `t_max`) hits
/// nothing, and nothing is hit at or beyond [`crate::bvh::T_FAR`].
#[derive(Clone, Debug)]
pub struct Aggregate {
    shapes: Arc<Shapes>,
    bvh: Bvh,
    leaves: LeafOrder,
    isa: Isa,
}

impl Aggregate {
    /// Builds the hierarchy over `shapes`, on all threads of the current pool.
    pub fn build(shapes: Shapes, settings: BvhSettings) -> Self {
        Self::build_with(shapes, settings, &|_| ControlFlow::Continue(()))
            .expect("nothing asks this build to stop")
    }

    /// Like [`Self::build`]; reports the finished fraction (0 to 1, from any thread, not in order)
    /// to `progress`, which may stop the build. `None` if it did.
    pub fn build_with(
        shapes: Shapes,
        settings: BvhSettings,
        progress: &(dyn Fn(f32) -> ControlFlow<()> + Sync),
    ) -> Option<Self> {
        assert!(shapes.len() < ID_LIMIT as usize, "too many primitives");
        let (bvh, ids) = Bvh::build_with(&boxes(&shapes), &settings, progress)?;
        let leaves = LeafOrder::new(&shapes, &bvh, &ids);
        Some(Self {
            shapes: Arc::new(shapes),
            bvh,
            leaves,
            isa: Isa::best(),
        })
    }

    /// Another hierarchy over the same (shared) shapes that costs rays less and takes longer to
    /// make; `progress` as in [`Self::build_with`].
    pub fn refined(&self, progress: &(dyn Fn(f32) -> ControlFlow<()> + Sync)) -> Option<Self> {
        let (bvh, ids) = refine(&self.shapes, progress)?;
        let leaves = LeafOrder::new(&self.shapes, &bvh, &ids);
        Some(Self {
            shapes: Arc::clone(&self.shapes),
            bvh,
            leaves,
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

    /// Ids of all primitives below a node of [`Self::bvh`].
    pub fn primitives(&self, node: NodeId) -> impl Iterator<Item = u32> + '_ {
        let blocks = &self.leaves.blocks()[self.bvh.blocks(node)];
        blocks.iter().flat_map(Block::ids)
    }

    /// The shapes.
    pub fn shapes(&self) -> &Shapes {
        &self.shapes
    }

    /// The hierarchy; its primitive ids are those of the shapes.
    pub fn bvh(&self) -> &Bvh {
        &self.bvh
    }

    /// Shape, cost and memory of the hierarchy, the vertices gathered for its leaves included.
    pub fn stats(&self) -> BvhStats {
        let mut stats = self.bvh.stats();
        stats.bytes += self.leaves.bytes();
        stats
    }

    /// Writes the closest hit of each ray; the smaller primitive id wins at equal `t`.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn closest_hit(&self, rays: &[Ray], hits: &mut [Hit], counts: &mut TraceCounts) {
        assert_eq!(rays.len(), hits.len());
        self.trace::<false>(rays, counts, |i, hit| hits[i] = hit);
    }

    /// The same as [`Self::closest_hit`], two to four times as fast if every 32 rays in a row (the first
    /// 32, the next, and so on) take nearly the same way: those through 8 x 4 pixels, or several
    /// samples of fewer pixels. Best of all if they start at one point. Rays that part go on one by
    /// one; rays that never agreed in the signs and the longest axis of their directions cost a little
    /// more than there.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn closest_hit_coherent(&self, rays: &[Ray], hits: &mut [Hit], counts: &mut TraceCounts) {
        assert_eq!(rays.len(), hits.len());
        let (isa, leaves) = (self.isa, &self.leaves);
        let answer = |i: usize, query: Option<&Query>| {
            hits[i] = query.map_or(Hit::MISS, |query| query.hit);
        };
        let work = self.bvh.traverse_coherent(isa, leaves, rays, answer);
        counts.add(rays, work);
    }

    /// Writes for each ray whether anything lies on it.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn any_hit(&self, rays: &[Ray], occluded: &mut [bool], counts: &mut TraceCounts) {
        assert_eq!(rays.len(), occluded.len());
        self.trace::<true>(rays, counts, |i, hit| occluded[i] = !hit.is_miss());
    }

    /// The closest hit of one ray.
    pub fn closest(&self, ray: &Ray) -> Hit {
        let mut hits = [Hit::MISS];
        self.closest_hit(&[*ray], &mut hits, &mut TraceCounts::default());
        hits[0]
    }

    fn trace<const ANY: bool>(
        &self,
        rays: &[Ray],
        counts: &mut TraceCounts,
        mut answer: impl FnMut(usize, Hit),
    ) {
        let (isa, leaves) = (self.isa, &self.leaves);
        let work = self.bvh.traverse::<ANY, _>(isa, leaves, rays, |i, query| {
            answer(i, query.map_or(Hit::MISS, |query| query.hit));
        });
        counts.add(rays, work);
    }
}
