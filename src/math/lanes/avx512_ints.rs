#![expect(unsafe_code, reason = "intrinsics; see `avx512`")]

use std::arch::x86_64::{
    __m512i, _mm_setr_epi8, _mm512_add_epi32, _mm512_and_si512, _mm512_broadcast_i32x4,
    _mm512_loadu_si512, _mm512_mullo_epi32, _mm512_or_si512, _mm512_set1_epi8, _mm512_set1_epi32,
    _mm512_shuffle_epi8, _mm512_sllv_epi32, _mm512_srav_epi32, _mm512_srlv_epi32,
    _mm512_storeu_si512, _mm512_xor_si512,
};

use super::registers::{int_lanes, register_operators};
use super::{IntLanes, ROW};

/// Sixteen integers in one register. Used only by kernels that [`super::avx512::run`] has started.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx512Ints(pub(super) __m512i);

int_lanes! {
    Avx512Ints:
    splat: _mm512_set1_epi32,
    bytes: _mm512_set1_epi8,
    load: _mm512_loadu_si512,
    store: _mm512_storeu_si512,
    add: _mm512_add_epi32,
    mul: _mm512_mullo_epi32,
    and: _mm512_and_si512,
    or: _mm512_or_si512,
    xor: _mm512_xor_si512,
    shl: _mm512_sllv_epi32,
    shr: _mm512_srlv_epi32,
    sar: _mm512_srav_epi32,
    look_up: _mm512_shuffle_epi8,
    repeat: _mm512_broadcast_i32x4,
}
