//! Floor 2: the bounding volume hierarchy over boxes. Knows no shape: leaves are tested through a
//! trait that the caller implements.
//!
//! A [`Bvh`] is built, stored and walked in nodes of eight children; seen from outside, and counted,
//! it is the binary tree between them. It never loses a primitive to rounding: boxes are padded
//! ([`padded`]), the box test has a margin, and every operation in it rounds monotonically, so that a
//! ray that meets a padded box also meets, in floating point, every box around it. A caller that
//! keeps a hit only if the ray meets the primitive's own padded box, and never reports it in front of
//! that box ([`SlabRay::enter`]), gets the same answer from every tree, bit for bit.

mod blocks;
mod build;
mod entrance;
mod expected;
mod flight;
mod leaves;
mod memory;
mod node;
mod octant;
mod overlap;
mod packet;
mod refit;
mod settings;
mod share;
mod simd;
mod single;
mod slab;
mod stack;
mod stats;
mod stream;
mod stretches;
mod traverse;
mod tree;

pub use build::Progress;
pub use leaves::{Leaves, PacketAnswers, PacketLeaves, Work};
pub use packet::{PACKET, PacketRays, PerRay, groups};
pub use settings::{BvhKind, BvhQuality, BvhSettings};
pub use slab::{FAR_MARGIN, SlabRay, T_FAR, padded, padded_each};
pub use stats::BvhStats;
pub use stretches::map_stretches;
pub use tree::{BLOCK, Bvh, LeafBlocks, NO_PRIMITIVE, NodeId};
