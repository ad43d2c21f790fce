#![expect(
    unsafe_code,
    reason = "intrinsics; the portable form is the same to the bit and about half as fast"
)]

use std::arch::x86_64::{
    __m256, __m256i, _CMP_LE_OQ, _mm_cvtsi64_si128, _mm256_broadcast_ss, _mm256_cmp_ps,
    _mm256_cvtepu8_epi32, _mm256_loadu_ps, _mm256_loadu_si256, _mm256_max_ps, _mm256_min_ps,
    _mm256_movemask_ps, _mm256_mul_ps, _mm256_permutevar8x32_epi32, _mm256_permutevar8x32_ps,
    _mm256_set1_ps, _mm256_storeu_ps, _mm256_storeu_si256, _mm256_sub_ps,
};
use std::marker::PhantomData;

use super::super::node::{WIDTH, WideNode};
use super::super::slab::{FAR_MARGIN, PLANES, SlabRay};
use super::{Kernel, NodeTest};
use crate::math::{Avx2Lanes, Isa, Lanes};

/// Eight children at once, and as many rays as `R` has lanes. Used only inside [`with_avx2`] and
/// [`super::avx512::with_avx512`].
#[derive(Debug)]
pub(in super::super) struct Avx2<R>(PhantomData<R>);

/// Runs `kernel`, compiled for AVX2.
///
/// # Panics
/// On a processor without it.
pub(super) fn with_avx2<K: Kernel>(kernel: K) -> K::Answer {
    #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
    fn compiled<K: Kernel>(kernel: K) -> K::Answer {
        kernel.run::<Avx2<Avx2Lanes>>()
    }
    assert!(Isa::Avx2.is_available(), "this processor has no AVX2");
    // SAFETY: the features were just checked.
    unsafe { compiled(kernel) }
}

#[inline(always)]
fn load(values: &[f32; WIDTH]) -> __m256 {
    // SAFETY: AVX2 is there (see `Avx2`); the array has eight numbers.
    unsafe { _mm256_loadu_ps(values.as_ptr()) }
}

#[inline(always)]
fn splat(value: &f32) -> __m256 {
    // SAFETY: AVX2 is there (see `Avx2`).
    unsafe { _mm256_broadcast_ss(value) }
}

#[inline(always)]
fn permutation(order: u64) -> __m256i {
    // SAFETY: AVX2 is there (see `Avx2`).
    unsafe { _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(order.cast_signed())) }
}

impl<R: Lanes> NodeTest for Avx2<R> {
    type PerSlot = __m256;

    type Eight = Avx2Lanes;

    type Rays = R;

    #[inline(always)]
    fn enter(node: &WideNode, ray: &SlabRay, limit: f32) -> (__m256, u32) {
        let first: *const u8 = (&raw const node.planes).cast();
        let t = |axis: usize, planes: u32| {
            debug_assert!(planes.is_multiple_of(PLANES) && planes < 6 * PLANES);
            // SAFETY: a prepared ray has the places of the six rows of planes only.
            let planes = load(unsafe { &*first.add(planes as usize).cast() });
            let (origin, inverse) = (splat(&ray.origin[axis]), splat(&ray.inverse[axis]));
            // SAFETY: AVX2 is there (see `Avx2`).
            unsafe { _mm256_mul_ps(_mm256_sub_ps(planes, origin), inverse) }
        };
        let [x, y, z] = ray.near;
        // SAFETY: AVX2 is there (see `Avx2`).
        unsafe {
            let near = _mm256_max_ps(
                _mm256_max_ps(t(0, x), t(1, y)),
                _mm256_max_ps(t(2, z), splat(&ray.origin[3])),
            );
            let far = _mm256_min_ps(
                _mm256_min_ps(t(0, x ^ PLANES), t(1, y ^ PLANES)),
                _mm256_min_ps(t(2, z ^ PLANES), splat(&limit)),
            );
            let far = _mm256_mul_ps(far, _mm256_set1_ps(FAR_MARGIN));
            let meets = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(near, far));
            (near, meets.cast_unsigned())
        }
    }

    #[inline(always)]
    fn at_most(values: &[f32; WIDTH], limit: f32) -> (__m256, u32) {
        let values = load(values);
        // SAFETY: AVX2 is there (see `Avx2`).
        let kept = unsafe {
            _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(values, _mm256_set1_ps(limit)))
        };
        (values, kept.cast_unsigned())
    }

    #[inline(always)]
    fn arrange_near(order: u64, values: __m256, to: &mut [f32; WIDTH]) {
        // SAFETY: AVX2 is there (see `Avx2`); there is room for eight numbers.
        unsafe {
            let sorted = _mm256_permutevar8x32_ps(values, permutation(order));
            _mm256_storeu_ps(to.as_mut_ptr(), sorted);
        }
    }

    #[inline(always)]
    fn arrange(order: u64, values: &[u32; WIDTH], to: &mut [u32; WIDTH]) {
        // SAFETY: AVX2 is there (see `Avx2`); there is room for eight numbers on both sides.
        unsafe {
            let values = _mm256_loadu_si256(values.as_ptr().cast());
            let sorted = _mm256_permutevar8x32_epi32(values, permutation(order));
            _mm256_storeu_si256(to.as_mut_ptr().cast(), sorted);
        }
    }
}
