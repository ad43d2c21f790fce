#![expect(unsafe_code, reason = "intrinsics; see `avx512`")]

use std::arch::x86_64::{
    __m512d, _CMP_EQ_OQ, _CMP_GT_OQ, _CMP_LT_OQ, _mm512_add_pd, _mm512_castps256_ps512,
    _mm512_castps512_ps256, _mm512_cmp_pd_mask, _mm512_cvtpd_ps, _mm512_cvtps_pd, _mm512_div_pd,
    _mm512_extractf32x8_ps, _mm512_insertf32x8, _mm512_mask_blend_pd, _mm512_maskz_mov_pd,
    _mm512_mul_pd, _mm512_set1_pd, _mm512_setzero_pd, _mm512_sqrt_pd, _mm512_sub_pd,
};

use super::DoubleLanes;
use super::avx512::Avx512Lanes;
use super::registers::pair_operators;

/// Sixteen numbers of double precision in two registers. Used only by kernels that
/// [`super::avx512::run`] has started.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx512Doubles(__m512d, __m512d);

pair_operators! {
    Avx512Doubles:
    Add add _mm512_add_pd;
    Sub sub _mm512_sub_pd;
    Mul mul _mm512_mul_pd;
    Div div _mm512_div_pd;
}

impl DoubleLanes for Avx512Doubles {
    type Singles = Avx512Lanes;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: AVX-512 is there (see `Avx512Doubles`).
        let value = unsafe { _mm512_set1_pd(value) };
        Self(value, value)
    }

    #[inline(always)]
    fn widen(from: Avx512Lanes) -> Self {
        // SAFETY: AVX-512 is there (see `Avx512Doubles`).
        unsafe {
            Self(
                _mm512_cvtps_pd(_mm512_castps512_ps256(from.0)),
                _mm512_cvtps_pd(_mm512_extractf32x8_ps::<1>(from.0)),
            )
        }
    }

    #[inline(always)]
    fn narrow(self) -> Avx512Lanes {
        // SAFETY: AVX-512 is there (see `Avx512Doubles`).
        unsafe {
            let low = _mm512_castps256_ps512(_mm512_cvtpd_ps(self.0));
            Avx512Lanes(_mm512_insertf32x8::<1>(low, _mm512_cvtpd_ps(self.1)))
        }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: AVX-512 is there (see `Avx512Doubles`).
        unsafe { Self(_mm512_sqrt_pd(self.0), _mm512_sqrt_pd(self.1)) }
    }

    #[inline(always)]
    fn is_positive_and_finite(self) -> Self {
        Self(flag(self.0), flag(self.1))
    }

    #[inline(always)]
    fn or_where_zero(self, flag: Self, other: Self) -> Self {
        Self(pick(flag.0, self.0, other.0), pick(flag.1, self.1, other.1))
    }
}

/// 1 where the number is finite and above 0, else 0.
#[inline(always)]
fn flag(value: __m512d) -> __m512d {
    // SAFETY: AVX-512 is there (see `Avx512Doubles`).
    unsafe {
        let above = _mm512_cmp_pd_mask::<_CMP_GT_OQ>(value, _mm512_setzero_pd());
        let finite = _mm512_cmp_pd_mask::<_CMP_LT_OQ>(value, _mm512_set1_pd(f64::INFINITY));
        _mm512_maskz_mov_pd(above & finite, _mm512_set1_pd(1.0))
    }
}

/// `no` where `flag` is 0, else `yes`.
#[inline(always)]
fn pick(flag: __m512d, yes: __m512d, no: __m512d) -> __m512d {
    // SAFETY: AVX-512 is there (see `Avx512Doubles`).
    unsafe {
        let zero = _mm512_cmp_pd_mask::<_CMP_EQ_OQ>(flag, _mm512_setzero_pd());
        _mm512_mask_blend_pd(zero, yes, no)
    }
}
