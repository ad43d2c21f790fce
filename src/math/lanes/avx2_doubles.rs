#![expect(unsafe_code, reason = "intrinsics; see `avx2`")]

use std::arch::x86_64::{
    __m256d, _CMP_EQ_OQ, _CMP_GT_OQ, _CMP_LT_OQ, _mm256_add_pd, _mm256_and_pd, _mm256_blendv_pd,
    _mm256_castps256_ps128, _mm256_cmp_pd, _mm256_cvtpd_ps, _mm256_cvtps_pd, _mm256_div_pd,
    _mm256_extractf128_ps, _mm256_mul_pd, _mm256_set_m128, _mm256_set1_pd, _mm256_setzero_pd,
    _mm256_sqrt_pd, _mm256_sub_pd,
};

use super::registers::pair_operators;
use super::{Avx2Lanes, DoubleLanes};

/// Eight numbers of double precision in two registers. Used only by kernels that
/// [`super::avx2::run`] has started.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx2Doubles(__m256d, __m256d);

pair_operators! {
    Avx2Doubles:
    Add add _mm256_add_pd;
    Sub sub _mm256_sub_pd;
    Mul mul _mm256_mul_pd;
    Div div _mm256_div_pd;
}

impl DoubleLanes for Avx2Doubles {
    type Singles = Avx2Lanes;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: AVX2 is there (see `Avx2Doubles`).
        let value = unsafe { _mm256_set1_pd(value) };
        Self(value, value)
    }

    #[inline(always)]
    fn widen(from: Avx2Lanes) -> Self {
        // SAFETY: AVX2 is there (see `Avx2Doubles`).
        unsafe {
            Self(
                _mm256_cvtps_pd(_mm256_castps256_ps128(from.0)),
                _mm256_cvtps_pd(_mm256_extractf128_ps::<1>(from.0)),
            )
        }
    }

    #[inline(always)]
    fn narrow(self) -> Avx2Lanes {
        // SAFETY: AVX2 is there (see `Avx2Doubles`).
        Avx2Lanes(unsafe { _mm256_set_m128(_mm256_cvtpd_ps(self.1), _mm256_cvtpd_ps(self.0)) })
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: AVX2 is there (see `Avx2Doubles`).
        unsafe { Self(_mm256_sqrt_pd(self.0), _mm256_sqrt_pd(self.1)) }
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
fn flag(value: __m256d) -> __m256d {
    // SAFETY: AVX2 is there (see `Avx2Doubles`).
    unsafe {
        let above = _mm256_cmp_pd::<_CMP_GT_OQ>(value, _mm256_setzero_pd());
        let finite = _mm256_cmp_pd::<_CMP_LT_OQ>(value, _mm256_set1_pd(f64::INFINITY));
        _mm256_and_pd(_mm256_and_pd(above, finite), _mm256_set1_pd(1.0))
    }
}

/// `no` where `flag` is 0, else `yes`.
#[inline(always)]
fn pick(flag: __m256d, yes: __m256d, no: __m256d) -> __m256d {
    // SAFETY: AVX2 is there (see `Avx2Doubles`).
    unsafe {
        let zero = _mm256_cmp_pd::<_CMP_EQ_OQ>(flag, _mm256_setzero_pd());
        _mm256_blendv_pd(yes, no, zero)
    }
}
