//! The SIMD room of the traversal, for each instruction set: one node against one ray, and eight
//! or sixteen numbers at once.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod portable;
mod prefetch;

pub(super) use prefetch::prefetch;

use super::node::{WIDTH, WideNode};
use super::slab::SlabRay;
use crate::math::{Isa, Lanes};

/// One node against one ray. Implementations differ in speed only, never in a bit.
pub(super) trait NodeTest {
    /// A number for each slot.
    type PerSlot: Copy;

    /// A number for each slot, or of eight rays, to calculate with.
    type Eight: Lanes;

    /// A number for each of some rays, as many as are fastest.
    type Rays: Lanes;

    /// Entry parameters of the boxes, and a bit for each slot whose box the ray meets before
    /// `limit`; the same numbers as [`SlabRay::enter`].
    fn enter(node: &WideNode, ray: &SlabRay, limit: f32) -> (Self::PerSlot, u32);

    /// `values` as they are, and a bit for each that is at most `limit`.
    fn at_most(values: &[f32; WIDTH], limit: f32) -> (Self::PerSlot, u32);

    /// Writes `values` in the `order` of [`super::octant::FAR_TO_NEAR`]; past the end of the set
    /// anything may be written.
    fn arrange_near(order: u64, values: Self::PerSlot, to: &mut [f32; WIDTH]);

    /// The same for references.
    fn arrange(order: u64, values: &[u32; WIDTH], to: &mut [u32; WIDTH]);
}

/// Work that is compiled once for each instruction set.
pub(super) trait Kernel {
    /// What it gives.
    type Answer;

    /// Does it. Must be inlined, with all that it calls often.
    fn run<N: NodeTest>(self) -> Self::Answer;
}

/// Runs `kernel` with the code for `isa`.
///
/// # Panics
/// When the processor does not have it.
pub(super) fn dispatch<K: Kernel>(isa: Isa, kernel: K) -> K::Answer {
    match isa {
        #[cfg(target_arch = "x86_64")]
        Isa::Avx512 => avx512::with_avx512(kernel),
        #[cfg(target_arch = "x86_64")]
        Isa::Avx2 => avx2::with_avx2(kernel),
        _ => {
            assert!(isa.is_available(), "this processor has no {isa}");
            kernel.run::<portable::Portable>()
        }
    }
}
