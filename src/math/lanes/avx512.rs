#![expect(
    unsafe_code,
    reason = "intrinsics; shading is about a quarter faster than with AVX2"
)]

use std::arch::x86_64::{
    __m512, __mmask16, _CMP_EQ_OQ, _CMP_LE_OQ, _CMP_LT_OQ, _mm_loadu_ps, _mm256_maskz_loadu_ps,
    _mm256_storeu_ps, _mm512_add_ps, _mm512_broadcast_f32x4, _mm512_castps_si512,
    _mm512_castps256_ps512, _mm512_castps512_ps256, _mm512_castsi512_ps, _mm512_cmp_ps_mask,
    _mm512_cmpeq_epi32_mask, _mm512_cvtepi32_ps, _mm512_div_ps, _mm512_extractf32x8_ps,
    _mm512_insertf32x8, _mm512_loadu_ps, _mm512_mask_blend_ps, _mm512_max_ps, _mm512_min_ps,
    _mm512_mul_ps, _mm512_set1_ps, _mm512_sqrt_ps, _mm512_storeu_ps, _mm512_sub_ps,
    _mm512_zextps256_ps512,
};
use std::ops::{BitAnd, BitOr};

use super::avx2::{Avx2Lanes, load_ray, store_ray, transpose};
use super::avx512_doubles::Avx512Doubles;
use super::avx512_ints::Avx512Ints;
use super::registers::{float_methods, register_operators};
use super::{FOUR, LANES, LaneKernel, Lanes, ROW};
use crate::math::{Isa, Ray};

/// Sixteen lanes in one register. Used only by kernels that [`run`] has started, which checks that
/// AVX-512 is there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx512Lanes(pub(super) __m512);

/// A truth value for each of [`Avx512Lanes`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx512Mask(__mmask16);

/// Runs `kernel`, compiled for AVX-512.
///
/// # Panics
/// On a processor without it.
pub(super) fn run<K: LaneKernel>(kernel: K) -> K::Answer {
    #[target_feature(
        enable = "avx512f,avx512bw,avx512cd,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,lzcnt,popcnt"
    )]
    fn compiled<K: LaneKernel>(kernel: K) -> K::Answer {
        kernel.run::<Avx512Lanes>()
    }
    assert!(Isa::Avx512.is_available(), "this processor has no AVX-512");
    // SAFETY: the features were just checked.
    unsafe { compiled(kernel) }
}

register_operators! {
    Avx512Lanes:
    Add add _mm512_add_ps;
    Sub sub _mm512_sub_ps;
    Mul mul _mm512_mul_ps;
    Div div _mm512_div_ps;
}

impl BitAnd for Avx512Mask {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl BitOr for Avx512Mask {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

/// Two halves as a whole.
#[inline(always)]
fn join(low: Avx2Lanes, high: Avx2Lanes) -> Avx512Lanes {
    // SAFETY: AVX-512 is there (see `Avx512Lanes`).
    Avx512Lanes(unsafe { _mm512_insertf32x8::<1>(_mm512_castps256_ps512(low.0), high.0) })
}

#[inline(always)]
fn low(whole: Avx512Lanes) -> Avx2Lanes {
    // SAFETY: AVX-512 is there (see `Avx512Lanes`).
    Avx2Lanes(unsafe { _mm512_castps512_ps256(whole.0) })
}

#[inline(always)]
fn high(whole: Avx512Lanes) -> Avx2Lanes {
    // SAFETY: AVX-512 is there (see `Avx512Lanes`).
    Avx2Lanes(unsafe { _mm512_extractf32x8_ps::<1>(whole.0) })
}

/// Eight rays, row by row.
#[inline(always)]
fn eight(rays: &[&Ray; ROW], first: usize) -> [Avx2Lanes; 8] {
    transpose([
        load_ray(rays[first]),
        load_ray(rays[first + 1]),
        load_ray(rays[first + 2]),
        load_ray(rays[first + 3]),
        load_ray(rays[first + 4]),
        load_ray(rays[first + 5]),
        load_ray(rays[first + 6]),
        load_ray(rays[first + 7]),
    ])
}

/// Eight rays to eight places from `first` on.
#[inline(always)]
fn put_eight(columns: [Avx2Lanes; 8], rays: &mut [Ray; ROW], first: usize) {
    let [a, b, c, d, e, f, g, h] = transpose(columns);
    store_ray(a, &mut rays[first]);
    store_ray(b, &mut rays[first + 1]);
    store_ray(c, &mut rays[first + 2]);
    store_ray(d, &mut rays[first + 3]);
    store_ray(e, &mut rays[first + 4]);
    store_ray(f, &mut rays[first + 5]);
    store_ray(g, &mut rays[first + 6]);
    store_ray(h, &mut rays[first + 7]);
}

impl Lanes for Avx512Lanes {
    type Mask = Avx512Mask;
    type Ints = Avx512Ints;
    type Doubles = Avx512Doubles;

    const N: usize = ROW;

    float_methods! {
        ints: Avx512Ints,
        load: _mm512_loadu_ps,
        store: _mm512_storeu_ps,
        min: _mm512_min_ps,
        max: _mm512_max_ps,
        sqrt: _mm512_sqrt_ps,
        to_ints: _mm512_castps_si512,
        from_ints: _mm512_castsi512_ps,
        of_ints: _mm512_cvtepi32_ps,
    }

    #[inline(always)]
    fn splat(value: f32) -> Self {
        // SAFETY: AVX-512 is there (see `Avx512Lanes`).
        Self(unsafe { _mm512_set1_ps(value) })
    }

    #[inline(always)]
    fn repeat(from: &[f32; FOUR]) -> Self {
        // SAFETY: AVX-512 is there (see `Avx512Lanes`); the array has four numbers.
        Self(unsafe { _mm512_broadcast_f32x4(_mm_loadu_ps(from.as_ptr())) })
    }

    #[inline(always)]
    fn alternate(even: Self, odd: Self) -> Self {
        // SAFETY: AVX-512 is there (see `Avx512Lanes`).
        Self(unsafe { _mm512_mask_blend_ps(0xF0F0, even.0, odd.0) })
    }

    #[inline(always)]
    fn load(from: &[f32; LANES]) -> Self {
        // SAFETY: AVX-512 is there (see `Avx512Lanes`); the array has eight numbers.
        Self(unsafe { _mm512_zextps256_ps512(_mm256_maskz_loadu_ps(0xFF, from.as_ptr())) })
    }

    #[inline(always)]
    fn store(self, to: &mut [f32; LANES]) {
        // SAFETY: AVX-512 is there (see `Avx512Lanes`); there is room for eight numbers.
        unsafe { _mm256_storeu_ps(to.as_mut_ptr(), low(self).0) }
    }

    #[inline(always)]
    fn lt(self, other: Self) -> Avx512Mask {
        // SAFETY: AVX-512 is there (see `Avx512Lanes`).
        Avx512Mask(unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0) })
    }

    #[inline(always)]
    fn le(self, other: Self) -> Avx512Mask {
        // SAFETY: AVX-512 is there (see `Avx512Lanes`).
        Avx512Mask(unsafe { _mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, other.0) })
    }

    #[inline(always)]
    fn eq(self, other: Self) -> Avx512Mask {
        // SAFETY: AVX-512 is there (see `Avx512Lanes`).
        Avx512Mask(unsafe { _mm512_cmp_ps_mask::<_CMP_EQ_OQ>(self.0, other.0) })
    }

    #[inline(always)]
    fn select(mask: Avx512Mask, yes: Self, no: Self) -> Self {
        // SAFETY: AVX-512 is there (see `Avx512Lanes`).
        Self(unsafe { _mm512_mask_blend_ps(mask.0, no.0, yes.0) })
    }

    #[inline(always)]
    fn without(mask: Avx512Mask, other: Avx512Mask) -> Avx512Mask {
        Avx512Mask(mask.0 & !other.0)
    }

    #[inline(always)]
    fn bits(mask: Avx512Mask) -> u32 {
        u32::from(mask.0)
    }

    #[inline(always)]
    fn ints_eq(a: Avx512Ints, b: Avx512Ints) -> Avx512Mask {
        // SAFETY: AVX-512 is there (see `Avx512Lanes`).
        Avx512Mask(unsafe { _mm512_cmpeq_epi32_mask(a.0, b.0) })
    }

    #[inline(always)]
    fn mask_of_bits(bits: u32) -> Avx512Mask {
        Avx512Mask(bits as __mmask16)
    }

    #[inline(always)]
    fn of_rays(rays: &[&Ray; ROW]) -> [Self; 8] {
        let (a, b) = (eight(rays, 0), eight(rays, 8));
        [
            join(a[0], b[0]),
            join(a[1], b[1]),
            join(a[2], b[2]),
            join(a[3], b[3]),
            join(a[4], b[4]),
            join(a[5], b[5]),
            join(a[6], b[6]),
            join(a[7], b[7]),
        ]
    }

    #[inline(always)]
    fn to_rays(numbers: [Self; 8], rays: &mut [Ray; ROW]) {
        let [a, b, c, d, e, f, g, h] = numbers;
        put_eight(
            [
                low(a),
                low(b),
                low(c),
                low(d),
                low(e),
                low(f),
                low(g),
                low(h),
            ],
            rays,
            0,
        );
        put_eight(
            [
                high(a),
                high(b),
                high(c),
                high(d),
                high(e),
                high(f),
                high(g),
                high(h),
            ],
            rays,
            8,
        );
    }
}
