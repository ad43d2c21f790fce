//! Floor 1: random numbers as pure functions, warps with their densities, discrete and tabulated
//! distributions, multiple-importance weights.

mod path_sampler;

pub use path_sampler::{PathSampler, Slot};
