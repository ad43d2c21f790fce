//! Eight or sixteen numbers side by side, for kernels that are written once and compiled for each instruction
//! set. Implementations differ in speed only, never in a bit.
//!
//! A [`LaneKernel`] is generic over [`Lanes`]; [`run_lanes`] compiles it for the instruction set that
//! is asked for. All that a kernel calls often must be inlined into it.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx2_doubles;
#[cfg(target_arch = "x86_64")]
mod avx2_ints;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "x86_64")]
mod avx512_doubles;
#[cfg(target_arch = "x86_64")]
mod avx512_ints;
mod doubles;
mod floats;
mod ints;
mod portable;
mod portable_doubles;
mod portable_ints;
#[cfg(target_arch = "x86_64")]
mod registers;
mod surface;
#[cfg(test)]
mod tests;
mod vec3;
mod vec3_array;

#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::Avx2Lanes;
#[cfg(target_arch = "x86_64")]
pub(crate) use avx512::Avx512Lanes;
pub use doubles::DoubleLanes;
use floats::FOUR;
pub use floats::{LANES, Lanes, ROW};
pub use ints::IntLanes;
pub(crate) use portable::PortableLanes;
pub use surface::{FrameLanes, offset_origin_lanes};
pub use vec3::Vec3Lanes;
pub use vec3_array::Vec3Array;

use super::Isa;

/// Work that is compiled once for each instruction set.
pub trait LaneKernel {
    /// What it gives.
    type Answer;

    /// Does it. Must be inlined, with all that it calls often.
    fn run<L: Lanes>(self) -> Self::Answer;
}

/// Runs `kernel` with the code for `isa`.
///
/// # Panics
/// When the processor does not have it.
pub fn run_lanes<K: LaneKernel>(isa: Isa, kernel: K) -> K::Answer {
    match isa {
        #[cfg(target_arch = "x86_64")]
        Isa::Avx2 => avx2::run(kernel),
        #[cfg(target_arch = "x86_64")]
        Isa::Avx512 => avx512::run(kernel),
        _ => {
            assert!(isa.is_available(), "this processor has no {isa}");
            kernel.run::<PortableLanes>()
        }
    }
}
