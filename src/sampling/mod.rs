//! Floor 1: random numbers as pure functions, warps with their densities, discrete and tabulated
//! distributions, multiple-importance weights.

mod bilinear;
mod digital_net;
mod distribution_1d;
mod distribution_2d;
mod heuristic;
mod lanes;
mod path_sampler;
mod scramble;
mod turns;
mod warp;

pub use bilinear::Bilinear;
pub use distribution_1d::Distribution1d;
pub use distribution_2d::Distribution2d;
pub use heuristic::power_heuristic;
pub use lanes::{BilinearLanes, cosine_hemisphere_lanes};
pub use path_sampler::{Member, PathSampler, PathSamplerLanes, Slot};
pub use warp::{
    UNIFORM_HEMISPHERE_PDF, UNIFORM_SPHERE_PDF, cosine_hemisphere, cosine_hemisphere_pdf,
    uniform_cone, uniform_cone_pdf, uniform_disk, uniform_hemisphere, uniform_sphere,
    uniform_triangle,
};

/// The largest `f32` below 1, the end of the half-open unit interval.
pub const ONE_MINUS_EPSILON: f32 = 1.0 - f32::EPSILON * 0.5;
