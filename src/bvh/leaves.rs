use super::slab::SlabRay;
use crate::math::Ray;

/// The primitives in the leaves of a tree, as the caller holds them.
pub trait Leaves: Sync {
    /// A ray prepared for primitive tests, and the best hit so far.
    type Query: Copy;

    /// Prepares a ray.
    fn query(&self, ray: &Ray, slab: &SlabRay) -> Self::Query;

    /// Tests the leaf that begins with `block`; `ANY`: until the first hit.
    ///
    /// Returns the ray parameter beyond which nothing matters any more: the closest hit so far, or
    /// negative infinity to stop at once. Adds the number of blocks to `blocks`.
    fn visit<const ANY: bool>(
        &self,
        block: u32,
        ray: (&Ray, &SlabRay),
        query: &mut Self::Query,
        blocks: &mut u64,
    ) -> f32;

    /// One block in memory.
    type Block;

    /// All blocks, so that they can be fetched before they are visited.
    fn blocks(&self) -> &[Self::Block];
}

/// Work done by traversal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Wide nodes visited, of eight boxes each.
    pub nodes: u64,
    /// Blocks of primitives tested.
    pub blocks: u64,
}
