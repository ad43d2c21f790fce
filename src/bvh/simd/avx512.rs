#![expect(
    unsafe_code,
    reason = "checked features; packets are a twentieth to a tenth faster than with AVX2"
)]

use super::Kernel;
use super::avx2::Avx2;
use crate::math::{Avx512Lanes, Isa};

/// Runs `kernel`, compiled for AVX-512: sixteen rays at once; the eight children of a node as with
/// AVX2.
///
/// # Panics
/// On a processor without it.
pub(super) fn with_avx512<K: Kernel>(kernel: K) -> K::Answer {
    #[target_feature(
        enable = "avx512f,avx512bw,avx512cd,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,lzcnt,popcnt"
    )]
    fn compiled<K: Kernel>(kernel: K) -> K::Answer {
        kernel.run::<Avx2<Avx512Lanes>>()
    }
    assert!(Isa::Avx512.is_available(), "this processor has no AVX-512");
    // SAFETY: the features were just checked.
    unsafe { compiled(kernel) }
}
