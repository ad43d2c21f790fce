//! softbox: a progressive path tracer for the CPU, without a window.

pub mod bvh;
pub mod color;
pub mod geometry;
pub mod image;
pub mod io;
pub mod math;
pub mod sampling;
pub mod scene;
pub mod settings;
