#![expect(unsafe_code, reason = "intrinsics; see `avx2`")]

use std::arch::x86_64::{
    __m256i, _mm_setr_epi8, _mm256_add_epi32, _mm256_and_si256, _mm256_broadcastsi128_si256,
    _mm256_loadu_si256, _mm256_mullo_epi32, _mm256_or_si256, _mm256_set1_epi8, _mm256_set1_epi32,
    _mm256_shuffle_epi8, _mm256_slli_epi32, _mm256_srai_epi32, _mm256_srli_epi32,
    _mm256_storeu_si256, _mm256_xor_si256,
};
use std::ops::{Add, BitAnd, BitOr, BitXor, Mul};

use super::{IntLanes, ROW};

/// Eight integers in one register. Used only by kernels that [`super::avx2::run`] has started.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx2Ints(pub(super) __m256i);

macro_rules! operators {
    ($($trait:ident $name:ident $intrinsic:ident;)*) => {
        $(impl $trait for Avx2Ints {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                // SAFETY: AVX2 is there (see `Avx2Ints`).
                Self(unsafe { $intrinsic(self.0, other.0) })
            }
        })*
    };
}

operators! {
    Add add _mm256_add_epi32;
    Mul mul _mm256_mullo_epi32;
    BitAnd bitand _mm256_and_si256;
    BitOr bitor _mm256_or_si256;
    BitXor bitxor _mm256_xor_si256;
}

impl IntLanes for Avx2Ints {
    #[inline(always)]
    fn splat(value: u32) -> Self {
        // SAFETY: AVX2 is there (see `Avx2Ints`).
        Self(unsafe { _mm256_set1_epi32(value.cast_signed()) })
    }

    #[inline(always)]
    fn load(from: &[u32; ROW]) -> Self {
        // SAFETY: AVX2 is there (see `Avx2Ints`); a row has at least eight numbers.
        Self(unsafe { _mm256_loadu_si256(from.as_ptr().cast()) })
    }

    #[inline(always)]
    fn store(self, to: &mut [u32; ROW]) {
        // SAFETY: AVX2 is there (see `Avx2Ints`); a row has room for eight numbers.
        unsafe { _mm256_storeu_si256(to.as_mut_ptr().cast(), self.0) }
    }

    #[inline(always)]
    fn shl<const BY: i32>(self) -> Self {
        // SAFETY: AVX2 is there (see `Avx2Ints`).
        Self(unsafe { _mm256_slli_epi32::<BY>(self.0) })
    }

    #[inline(always)]
    fn shr<const BY: i32>(self) -> Self {
        // SAFETY: AVX2 is there (see `Avx2Ints`).
        Self(unsafe { _mm256_srli_epi32::<BY>(self.0) })
    }

    #[inline(always)]
    fn sar<const BY: i32>(self) -> Self {
        // SAFETY: AVX2 is there (see `Avx2Ints`).
        Self(unsafe { _mm256_srai_epi32::<BY>(self.0) })
    }

    #[inline(always)]
    fn reverse_bits(self) -> Self {
        // SAFETY: AVX2 is there (see `Avx2Ints`).
        unsafe {
            // Halves of bytes are looked up, the lower ones moved up; then the bytes change places.
            let nibbles = _mm256_set1_epi8(0x0F);
            let low = _mm256_and_si256(self.0, nibbles);
            let high = _mm256_and_si256(_mm256_srli_epi32::<4>(self.0), nibbles);
            let up = _mm256_broadcastsi128_si256(_mm_setr_epi8(
                0x00, -0x80, 0x40, -0x40, 0x20, -0x60, 0x60, -0x20, 0x10, -0x70, 0x50, -0x30, 0x30,
                -0x50, 0x70, -0x10,
            ));
            let down = _mm256_broadcastsi128_si256(_mm_setr_epi8(
                0x0, 0x8, 0x4, 0xC, 0x2, 0xA, 0x6, 0xE, 0x1, 0x9, 0x5, 0xD, 0x3, 0xB, 0x7, 0xF,
            ));
            let bytes = _mm256_or_si256(
                _mm256_shuffle_epi8(up, low),
                _mm256_shuffle_epi8(down, high),
            );
            let places = _mm256_broadcastsi128_si256(_mm_setr_epi8(
                3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12,
            ));
            Self(_mm256_shuffle_epi8(bytes, places))
        }
    }
}
