//! The path tracer once more, in double precision: the oracle for the one in single precision.
//!
//! It draws the same random numbers for the same purposes, so that a path can be held against its
//! twin sample by sample. All else is written again, plainly and from the formulas: its own
//! search through the tree, its own intersections, warps, scattering models and lights. Only
//! what is stored in single precision is shared: vertices, normals, parameters, and the choices
//! that tables make (which light, which of its triangles, which texel).
//!
//! Paths differ where rounding decides: at edges, at the rim of a shadow, at total reflection.
//! They drift apart where light bounces between curved mirrors, which magnify every error.

mod area_light;
mod bilinear;
mod bsdf;
mod delta;
mod direct;
mod environment;
mod error_function;
mod frame;
mod guided;
mod light;
mod light_choice;
mod microfacet;
mod path;
mod sphere_light;
mod surface;
mod trace;
mod triangle_light;
mod warp;

pub use path::reference_f64;
