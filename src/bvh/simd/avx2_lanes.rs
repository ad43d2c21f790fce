#![expect(
    unsafe_code,
    reason = "intrinsics; the portable form is the same to the bit and about half as fast"
)]

use std::arch::x86_64::{
    __m256, _CMP_EQ_OQ, _CMP_LE_OQ, _CMP_LT_OQ, _mm256_add_ps, _mm256_and_ps, _mm256_andnot_ps,
    _mm256_blendv_ps, _mm256_broadcast_ss, _mm256_cmp_ps, _mm256_div_ps, _mm256_loadu_ps,
    _mm256_max_ps, _mm256_min_ps, _mm256_movemask_ps, _mm256_mul_ps, _mm256_or_ps,
    _mm256_storeu_ps, _mm256_sub_ps,
};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Sub};

use super::lanes::{LANES, Lanes};

/// Eight lanes in one register. Used only inside [`super::avx2::with_avx2`].
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Avx2Lanes(__m256);

/// A truth value for each of [`Avx2Lanes`], in all bits of the lane.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Avx2Mask(__m256);

macro_rules! operators {
    ($type:ty: $($trait:ident $name:ident $intrinsic:ident;)*) => {
        $(impl $trait for $type {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                // SAFETY: AVX2 is there (see `Avx2Lanes`).
                Self(unsafe { $intrinsic(self.0, other.0) })
            }
        })*
    };
}

operators! {
    Avx2Lanes:
    Add add _mm256_add_ps;
    Sub sub _mm256_sub_ps;
    Mul mul _mm256_mul_ps;
    Div div _mm256_div_ps;
}
operators! { Avx2Mask: BitAnd bitand _mm256_and_ps; BitOr bitor _mm256_or_ps; }

impl Lanes for Avx2Lanes {
    type Mask = Avx2Mask;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        // SAFETY: AVX2 is there (see `Avx2Lanes`).
        Self(unsafe { _mm256_broadcast_ss(&value) })
    }

    #[inline(always)]
    fn load(from: &[f32; LANES]) -> Self {
        // SAFETY: AVX2 is there (see `Avx2Lanes`); the array has eight numbers.
        Self(unsafe { _mm256_loadu_ps(from.as_ptr()) })
    }

    #[inline(always)]
    fn store(self, to: &mut [f32; LANES]) {
        // SAFETY: AVX2 is there (see `Avx2Lanes`); there is room for eight numbers.
        unsafe { _mm256_storeu_ps(to.as_mut_ptr(), self.0) }
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: AVX2 is there (see `Avx2Lanes`).
        Self(unsafe { _mm256_min_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: AVX2 is there (see `Avx2Lanes`).
        Self(unsafe { _mm256_max_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn lt(self, other: Self) -> Avx2Mask {
        // SAFETY: AVX2 is there (see `Avx2Lanes`).
        Avx2Mask(unsafe { _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0) })
    }

    #[inline(always)]
    fn le(self, other: Self) -> Avx2Mask {
        // SAFETY: AVX2 is there (see `Avx2Lanes`).
        Avx2Mask(unsafe { _mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0) })
    }

    #[inline(always)]
    fn eq(self, other: Self) -> Avx2Mask {
        // SAFETY: AVX2 is there (see `Avx2Lanes`).
        Avx2Mask(unsafe { _mm256_cmp_ps::<_CMP_EQ_OQ>(self.0, other.0) })
    }

    #[inline(always)]
    fn select(mask: Avx2Mask, yes: Self, no: Self) -> Self {
        // SAFETY: AVX2 is there (see `Avx2Lanes`).
        Self(unsafe { _mm256_blendv_ps(no.0, yes.0, mask.0) })
    }

    #[inline(always)]
    fn without(mask: Avx2Mask, other: Avx2Mask) -> Avx2Mask {
        // SAFETY: AVX2 is there (see `Avx2Lanes`).
        Avx2Mask(unsafe { _mm256_andnot_ps(other.0, mask.0) })
    }

    #[inline(always)]
    fn bits(mask: Avx2Mask) -> u32 {
        // SAFETY: AVX2 is there (see `Avx2Lanes`).
        unsafe { _mm256_movemask_ps(mask.0) }.cast_unsigned()
    }
}
