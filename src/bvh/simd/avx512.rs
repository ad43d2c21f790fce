#![expect(
    unsafe_code,
    reason = "checked features; packets are a twentieth to a tenth faster than with AVX2"
)]

use std::arch::x86_64::__m256;

use super::super::node::{WIDTH, WideNode};
use super::super::slab::SlabRay;
use super::avx2::Avx2;
use super::{Kernel, NodeTest};
use crate::math::{Avx2Lanes, Avx512Lanes, Isa};

/// Sixteen rays at once; the eight children of a node as with [`Avx2`]. Used only inside
/// [`with_avx512`].
#[derive(Debug)]
pub(in super::super) struct Avx512;

/// Runs `kernel`, compiled for AVX-512.
///
/// # Panics
/// On a processor without it.
pub(super) fn with_avx512<K: Kernel>(kernel: K) -> K::Answer {
    #[target_feature(
        enable = "avx512f,avx512bw,avx512cd,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,lzcnt,popcnt"
    )]
    fn compiled<K: Kernel>(kernel: K) -> K::Answer {
        kernel.run::<Avx512>()
    }
    assert!(Isa::Avx512.is_available(), "this processor has no AVX-512");
    // SAFETY: the features were just checked.
    unsafe { compiled(kernel) }
}

impl NodeTest for Avx512 {
    type PerSlot = __m256;

    type Eight = Avx2Lanes;

    type Rays = Avx512Lanes;

    #[inline(always)]
    fn enter(node: &WideNode, ray: &SlabRay, limit: f32) -> (__m256, u32) {
        Avx2::enter(node, ray, limit)
    }

    #[inline(always)]
    fn at_most(values: &[f32; WIDTH], limit: f32) -> (__m256, u32) {
        Avx2::at_most(values, limit)
    }

    #[inline(always)]
    fn arrange_near(order: u64, values: __m256, to: &mut [f32; WIDTH]) {
        Avx2::arrange_near(order, values, to);
    }

    #[inline(always)]
    fn arrange(order: u64, values: &[u32; WIDTH], to: &mut [u32; WIDTH]) {
        Avx2::arrange(order, values, to);
    }
}
