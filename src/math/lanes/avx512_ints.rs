#![expect(unsafe_code, reason = "intrinsics; see `avx512`")]

use std::arch::x86_64::{
    __m512i, _mm_setr_epi8, _mm512_add_epi32, _mm512_and_si512, _mm512_broadcast_i32x4,
    _mm512_loadu_si512, _mm512_mullo_epi32, _mm512_or_si512, _mm512_set1_epi8, _mm512_set1_epi32,
    _mm512_shuffle_epi8, _mm512_sllv_epi32, _mm512_srav_epi32, _mm512_srli_epi32,
    _mm512_srlv_epi32, _mm512_storeu_si512, _mm512_xor_si512,
};
use std::ops::{Add, BitAnd, BitOr, BitXor, Mul};

use super::{IntLanes, ROW};

/// Sixteen integers in one register. Used only by kernels that [`super::avx512::run`] has started.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx512Ints(pub(super) __m512i);

macro_rules! operators {
    ($($trait:ident $name:ident $intrinsic:ident;)*) => {
        $(impl $trait for Avx512Ints {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                // SAFETY: AVX-512 is there (see `Avx512Ints`).
                Self(unsafe { $intrinsic(self.0, other.0) })
            }
        })*
    };
}

operators! {
    Add add _mm512_add_epi32;
    Mul mul _mm512_mullo_epi32;
    BitAnd bitand _mm512_and_si512;
    BitOr bitor _mm512_or_si512;
    BitXor bitxor _mm512_xor_si512;
}

impl IntLanes for Avx512Ints {
    #[inline(always)]
    fn splat(value: u32) -> Self {
        // SAFETY: AVX-512 is there (see `Avx512Ints`).
        Self(unsafe { _mm512_set1_epi32(value.cast_signed()) })
    }

    #[inline(always)]
    fn load(from: &[u32; ROW]) -> Self {
        // SAFETY: AVX-512 is there (see `Avx512Ints`); a row has sixteen numbers.
        Self(unsafe { _mm512_loadu_si512(from.as_ptr().cast()) })
    }

    #[inline(always)]
    fn store(self, to: &mut [u32; ROW]) {
        // SAFETY: AVX-512 is there (see `Avx512Ints`); a row has room for sixteen numbers.
        unsafe { _mm512_storeu_si512(to.as_mut_ptr().cast(), self.0) }
    }

    #[inline(always)]
    fn shl<const BY: i32>(self) -> Self {
        // SAFETY: AVX-512 is there (see `Avx512Ints`).
        Self(unsafe { _mm512_sllv_epi32(self.0, _mm512_set1_epi32(BY)) })
    }

    #[inline(always)]
    fn shr<const BY: i32>(self) -> Self {
        // SAFETY: AVX-512 is there (see `Avx512Ints`).
        Self(unsafe { _mm512_srlv_epi32(self.0, _mm512_set1_epi32(BY)) })
    }

    #[inline(always)]
    fn sar<const BY: i32>(self) -> Self {
        // SAFETY: AVX-512 is there (see `Avx512Ints`).
        Self(unsafe { _mm512_srav_epi32(self.0, _mm512_set1_epi32(BY)) })
    }

    #[inline(always)]
    fn reverse_bits(self) -> Self {
        // SAFETY: AVX-512 is there (see `Avx512Ints`).
        unsafe {
            // Halves of bytes are looked up, the lower ones moved up; then the bytes change places.
            let nibbles = _mm512_set1_epi8(0x0F);
            let low = _mm512_and_si512(self.0, nibbles);
            let high = _mm512_and_si512(_mm512_srli_epi32::<4>(self.0), nibbles);
            let up = _mm512_broadcast_i32x4(_mm_setr_epi8(
                0x00, -0x80, 0x40, -0x40, 0x20, -0x60, 0x60, -0x20, 0x10, -0x70, 0x50, -0x30, 0x30,
                -0x50, 0x70, -0x10,
            ));
            let down = _mm512_broadcast_i32x4(_mm_setr_epi8(
                0x0, 0x8, 0x4, 0xC, 0x2, 0xA, 0x6, 0xE, 0x1, 0x9, 0x5, 0xD, 0x3, 0xB, 0x7, 0xF,
            ));
            let bytes = _mm512_or_si512(
                _mm512_shuffle_epi8(up, low),
                _mm512_shuffle_epi8(down, high),
            );
            let places = _mm512_broadcast_i32x4(_mm_setr_epi8(
                3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12,
            ));
            Self(_mm512_shuffle_epi8(bytes, places))
        }
    }
}
