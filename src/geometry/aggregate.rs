use std::ops::ControlFlow;
use std::sync::Arc;

use super::leaf::{LeafOrder, Search, boxes};
use super::refine::refine;
use super::{Hit, Shapes};
use crate::bvh::{Bvh, BvhSettings, BvhStats, SlabRay, Stack};
use crate::math::Ray;

/// Work done by traversal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TraceCounts {
    /// Rays traced.
    pub rays: u64,
    /// Boxes tested.
    pub box_tests: u64,
    /// Primitives tested.
    pub primitive_tests: u64,
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
        let bvh = Bvh::build_with(&boxes(&shapes), &settings, progress)?;
        let leaves = LeafOrder::new(&shapes, bvh.order());
        Some(Self {
            shapes: Arc::new(shapes),
            bvh,
            leaves,
        })
    }

    /// Another hierarchy over the same (shared) shapes that costs rays less and takes longer to
    /// make; `progress` as in [`Self::build_with`].
    pub fn refined(&self, progress: &(dyn Fn(f32) -> ControlFlow<()> + Sync)) -> Option<Self> {
        let bvh = refine(&self.shapes, progress)?;
        let leaves = LeafOrder::new(&self.shapes, bvh.order());
        Some(Self {
            shapes: Arc::clone(&self.shapes),
            bvh,
            leaves,
        })
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
        self.trace::<false, _>(rays, hits, counts, |hit| hit);
    }

    /// Writes for each ray whether anything lies on it.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn any_hit(&self, rays: &[Ray], occluded: &mut [bool], counts: &mut TraceCounts) {
        assert_eq!(rays.len(), occluded.len());
        self.trace::<true, _>(rays, occluded, counts, |hit| !hit.is_miss());
    }

    /// The closest hit of one ray.
    pub fn closest(&self, ray: &Ray) -> Hit {
        let mut hits = [Hit::MISS];
        self.closest_hit(&[*ray], &mut hits, &mut TraceCounts::default());
        hits[0]
    }

    fn trace<const ANY: bool, T>(
        &self,
        rays: &[Ray],
        out: &mut [T],
        counts: &mut TraceCounts,
        answer: impl Fn(Hit) -> T,
    ) {
        let mut stack = Stack::new();
        for (ray, out) in rays.iter().zip(out) {
            let mut hit = Hit::MISS;
            if let Some(slab) = SlabRay::new(ray) {
                let mut search = Search::<ANY>::new(&self.leaves, ray, &slab);
                let work = self.bvh.traverse(&slab, &mut stack, &mut search);
                counts.box_tests += u64::from(work.boxes);
                counts.primitive_tests += u64::from(work.primitives);
                hit = search.hit;
            }
            *out = answer(hit);
        }
        counts.rays += rays.len() as u64;
    }
}
