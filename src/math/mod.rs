//! Floor 0: what glam lacks. Rays, boxes, shading frames, robust ray origins, instruction sets, sets of bits,
//! lanes.

mod aabb;
mod bits;
mod frame;
mod isa;
mod lanes;
mod normalization;
mod offset;
mod ray;

pub use aabb::Aabb;
pub use bits::{set_bits, take_lowest};
pub use frame::Frame;
pub use isa::{Isa, IsaError};
pub(crate) use lanes::PortableLanes;
#[cfg(target_arch = "x86_64")]
pub(crate) use lanes::{Avx2Lanes, Avx512Lanes};
pub use lanes::{
    DoubleLanes, FrameLanes, IntLanes, LANES, LaneKernel, Lanes, ROW, Vec3Array, Vec3Lanes,
    offset_origin_lanes, run_lanes,
};
pub use normalization::Normalization;
pub use offset::{SHADOW_T_MAX, gamma, offset_origin};
pub use ray::Ray;
