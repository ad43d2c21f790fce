#![expect(
    unsafe_code,
    reason = "intrinsics; the portable form is the same to the bit and about half as fast"
)]

use std::arch::x86_64::{
    __m256, _CMP_EQ_OQ, _CMP_LE_OQ, _CMP_LT_OQ, _mm_loadu_ps, _mm256_add_ps, _mm256_and_ps,
    _mm256_andnot_ps, _mm256_blend_ps, _mm256_blendv_ps, _mm256_broadcast_ss, _mm256_castps_si256,
    _mm256_castsi256_ps, _mm256_cmp_ps, _mm256_cmpeq_epi32, _mm256_cvtepi32_ps, _mm256_div_ps,
    _mm256_loadu_ps, _mm256_max_ps, _mm256_min_ps, _mm256_movemask_ps, _mm256_mul_ps, _mm256_or_ps,
    _mm256_permute2f128_ps, _mm256_set_m128, _mm256_shuffle_ps, _mm256_sqrt_ps, _mm256_storeu_ps,
    _mm256_sub_ps, _mm256_unpackhi_ps, _mm256_unpacklo_ps,
};

use super::avx2_doubles::Avx2Doubles;
use super::avx2_ints::Avx2Ints;
use super::registers::{float_methods, register_operators};
use super::{FOUR, IntLanes, LANES, LaneKernel, Lanes, ROW};
use crate::math::{Isa, Ray};

/// Eight lanes in one register. Used only by kernels that [`run`] or the
/// traversal's own dispatch has started, which check that AVX2 is there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx2Lanes(pub(super) __m256);

/// A truth value for each of [`Avx2Lanes`], in all bits of the lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx2Mask(__m256);

/// Runs `kernel`, compiled for AVX2.
///
/// # Panics
/// On a processor without it.
pub(super) fn run<K: LaneKernel>(kernel: K) -> K::Answer {
    #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
    fn compiled<K: LaneKernel>(kernel: K) -> K::Answer {
        kernel.run::<Avx2Lanes>()
    }
    assert!(Isa::Avx2.is_available(), "this processor has no AVX2");
    // SAFETY: the features were just checked.
    unsafe { compiled(kernel) }
}

register_operators! {
    Avx2Lanes:
    Add add _mm256_add_ps;
    Sub sub _mm256_sub_ps;
    Mul mul _mm256_mul_ps;
    Div div _mm256_div_ps;
}
register_operators! { Avx2Mask: BitAnd bitand _mm256_and_ps; BitOr bitor _mm256_or_ps; }

impl Lanes for Avx2Lanes {
    type Mask = Avx2Mask;
    type Ints = Avx2Ints;
    type Doubles = Avx2Doubles;

    const N: usize = LANES;

    float_methods! {
        ints: Avx2Ints,
        load: _mm256_loadu_ps,
        store: _mm256_storeu_ps,
        min: _mm256_min_ps,
        max: _mm256_max_ps,
        sqrt: _mm256_sqrt_ps,
        to_ints: _mm256_castps_si256,
        from_ints: _mm256_castsi256_ps,
        of_ints: _mm256_cvtepi32_ps,
    }

    #[inline(always)]
    fn splat(value: f32) -> Self {
        // SAFETY: AVX2 is there (see `Avx2Lanes`).
        Self(unsafe { _mm256_broadcast_ss(&value) })
    }

    #[inline(always)]
    fn repeat(from: &[f32; FOUR]) -> Self {
        // SAFETY: AVX2 is there (see `Avx2Lanes`); the array has four numbers.
        unsafe {
            let four = _mm_loadu_ps(from.as_ptr());
            Self(_mm256_set_m128(four, four))
        }
    }

    #[inline(always)]
    fn alternate(even: Self, odd: Self) -> Self {
        // SAFETY: AVX2 is there (see `Avx2Lanes`).
        Self(unsafe { _mm256_blend_ps::<0xF0>(even.0, odd.0) })
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

    #[inline(always)]
    fn ints_eq(a: Avx2Ints, b: Avx2Ints) -> Avx2Mask {
        // SAFETY: AVX2 is there (see `Avx2Lanes`).
        Avx2Mask(unsafe { _mm256_castsi256_ps(_mm256_cmpeq_epi32(a.0, b.0)) })
    }

    #[inline(always)]
    fn mask_of_bits(bits: u32) -> Avx2Mask {
        let lane = Avx2Ints::load(&[1, 2, 4, 8, 16, 32, 64, 128, 0, 0, 0, 0, 0, 0, 0, 0]);
        Self::ints_eq(lane & Avx2Ints::splat(bits), lane)
    }

    #[inline(always)]
    fn of_rays(rays: &[&Ray; ROW]) -> [Self; 8] {
        let [a, b, c, d, e, f, g, h, ..] = *rays;
        transpose([
            load_ray(a),
            load_ray(b),
            load_ray(c),
            load_ray(d),
            load_ray(e),
            load_ray(f),
            load_ray(g),
            load_ray(h),
        ])
    }

    #[inline(always)]
    fn to_rays(numbers: [Self; 8], rays: &mut [Ray; ROW]) {
        let [a, b, c, d, e, f, g, h] = transpose(numbers);
        store_ray(a, &mut rays[0]);
        store_ray(b, &mut rays[1]);
        store_ray(c, &mut rays[2]);
        store_ray(d, &mut rays[3]);
        store_ray(e, &mut rays[4]);
        store_ray(f, &mut rays[5]);
        store_ray(g, &mut rays[6]);
        store_ray(h, &mut rays[7]);
    }
}

/// The numbers of a ray.
#[inline(always)]
pub(super) fn load_ray(ray: &Ray) -> Avx2Lanes {
    // SAFETY: AVX2 is there (see `Avx2Lanes`); a ray is eight numbers in this order (`repr(C)`).
    Avx2Lanes(unsafe { _mm256_loadu_ps(std::ptr::from_ref(ray).cast()) })
}

/// The ray with these numbers.
#[inline(always)]
pub(super) fn store_ray(numbers: Avx2Lanes, ray: &mut Ray) {
    // SAFETY: AVX2 is there (see `Avx2Lanes`); a ray is eight numbers in this order (`repr(C)`).
    unsafe { _mm256_storeu_ps(std::ptr::from_mut(ray).cast(), numbers.0) }
}

/// Rows and columns exchanged.
#[inline(always)]
pub(super) fn transpose(rows: [Avx2Lanes; 8]) -> [Avx2Lanes; 8] {
    // SAFETY: AVX2 is there (see `Avx2Lanes`).
    unsafe {
        // Pairs of rows, then fours, then halves.
        macro_rules! four {
            ($a:literal, $b:literal) => {{
                let (top, bottom) = (
                    _mm256_unpacklo_ps(rows[$a].0, rows[$a + 1].0),
                    _mm256_unpackhi_ps(rows[$a].0, rows[$a + 1].0),
                );
                let (next, last) = (
                    _mm256_unpacklo_ps(rows[$b].0, rows[$b + 1].0),
                    _mm256_unpackhi_ps(rows[$b].0, rows[$b + 1].0),
                );
                [
                    _mm256_shuffle_ps::<0b01_00_01_00>(top, next),
                    _mm256_shuffle_ps::<0b11_10_11_10>(top, next),
                    _mm256_shuffle_ps::<0b01_00_01_00>(bottom, last),
                    _mm256_shuffle_ps::<0b11_10_11_10>(bottom, last),
                ]
            }};
        }
        let (upper, lower) = (four!(0, 2), four!(4, 6));
        [
            Avx2Lanes(_mm256_permute2f128_ps::<0x20>(upper[0], lower[0])),
            Avx2Lanes(_mm256_permute2f128_ps::<0x20>(upper[1], lower[1])),
            Avx2Lanes(_mm256_permute2f128_ps::<0x20>(upper[2], lower[2])),
            Avx2Lanes(_mm256_permute2f128_ps::<0x20>(upper[3], lower[3])),
            Avx2Lanes(_mm256_permute2f128_ps::<0x31>(upper[0], lower[0])),
            Avx2Lanes(_mm256_permute2f128_ps::<0x31>(upper[1], lower[1])),
            Avx2Lanes(_mm256_permute2f128_ps::<0x31>(upper[2], lower[2])),
            Avx2Lanes(_mm256_permute2f128_ps::<0x31>(upper[3], lower[3])),
        ]
    }
}
