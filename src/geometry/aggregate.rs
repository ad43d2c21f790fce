use super::{Hit, Shapes};
use crate::bvh::BvhSettings;
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
#[derive(Debug)]
pub struct Aggregate {
    shapes: Shapes,
}

impl Aggregate {
    /// Builds the hierarchy over `shapes`.
    pub fn build(shapes: Shapes, _settings: BvhSettings) -> Self {
        Self { shapes }
    }

    /// tmp
    pub fn build_with(
        shapes: Shapes,
        settings: BvhSettings,
        _progress: &(dyn Fn(f32) -> std::ops::ControlFlow<()> + Sync),
    ) -> Option<Self> {
        Some(Self::build(shapes, settings))
    }

    /// The shapes.
    pub fn shapes(&self) -> &Shapes {
        &self.shapes
    }

    /// Writes the closest hit of each ray; the smaller primitive id wins at equal `t`.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn closest_hit(&self, rays: &[Ray], hits: &mut [Hit], _counts: &mut TraceCounts) {
        assert_eq!(rays.len(), hits.len());
        hits.fill(Hit::MISS);
    }

    /// Writes for each ray whether anything lies on it.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn any_hit(&self, rays: &[Ray], occluded: &mut [bool], _counts: &mut TraceCounts) {
        assert_eq!(rays.len(), occluded.len());
        occluded.fill(false);
    }
}
