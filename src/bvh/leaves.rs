use super::packet::{PacketRays, PerRay};
use super::slab::SlabRay;
use crate::math::{Lanes, Ray};

/// The primitives in the leaves of a tree, as the caller holds them.
pub trait Leaves: Sync {
    /// A ray prepared for primitive tests, and the best hit so far.
    type Query: Copy;

    /// Prepares a ray.
    fn query(&self, ray: &Ray, slab: &SlabRay) -> Self::Query;

    /// Tests the leaf that begins with `block`, with eight lanes; `ANY`: until the first hit.
    ///
    /// Returns the ray parameter beyond which nothing matters any more: the closest hit so far, or
    /// negative infinity to stop at once. Adds the number of blocks to `blocks`.
    fn visit<V: Lanes, const ANY: bool>(
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

/// Leaves that can be tested with a whole packet. Every answer is the one of [`Leaves`], bit for bit.
pub trait PacketLeaves: Leaves {
    /// The queries of the rays of a packet, side by side.
    type Packet: Default;

    /// Prepares the rays of a packet; false if they must be traced one by one.
    fn set_packet<V: Lanes>(&self, rays: &PacketRays, packet: &mut Self::Packet) -> bool;

    /// For each ray the parameter beyond which nothing matters any more.
    fn limit(packet: &Self::Packet) -> &PerRay;

    /// Tests the leaf that begins with `block`, at least for the rays with a bit in `active`. If
    /// `SHARED`, all rays start at one point. Returns the number of blocks.
    fn visit_packet<V: Lanes, const SHARED: bool>(
        &self,
        block: u32,
        rays: (&[Ray], &PacketRays),
        packet: &mut Self::Packet,
        active: u32,
    ) -> u64;

    /// Lets ray `i` want nothing more: its limit becomes negative infinity.
    fn drop_ray(packet: &mut Self::Packet, i: usize);

    /// The query of ray `i` by itself.
    fn of_packet(&self, packet: &Self::Packet, i: usize) -> Self::Query;
}

/// Takes the answers to rays that were traced in packets.
pub trait PacketAnswers<L: PacketLeaves> {
    /// The answer to ray `number`; `None` if the ray can meet nothing.
    fn one(&mut self, number: usize, query: Option<&L::Query>);

    /// The answers to all rays of a packet, of which the first has number `first`.
    fn all(&mut self, first: usize, packet: &L::Packet);
}

/// Work done by traversal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Wide nodes visited, of eight boxes each.
    pub nodes: u64,
    /// Blocks of primitives tested.
    pub blocks: u64,
}
