//! softbox: a progressive path tracer for the CPU, without a window.

pub mod bsdf;
pub mod bvh;
pub mod camera;
pub mod color;
pub mod display;
pub mod film;
pub mod geometry;
pub mod image;
pub mod integrator;
pub mod io;
pub mod light;
pub mod math;
pub mod sampling;
pub mod scene;
pub mod session;
pub mod settings;
