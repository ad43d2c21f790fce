//! Floor 0: what glam lacks. Rays, boxes, shading frames, robust ray origins, instruction sets.

mod aabb;
mod frame;
mod isa;
mod normalization;
mod offset;
mod ray;

pub use aabb::Aabb;
pub use frame::Frame;
pub use isa::{Isa, IsaError};
pub use normalization::Normalization;
pub use offset::{SHADOW_T_MAX, gamma, offset_origin};
pub use ray::Ray;
