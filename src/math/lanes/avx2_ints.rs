#![expect(unsafe_code, reason = "intrinsics; see `avx2`")]

use std::arch::x86_64::{
    __m256i, _mm_setr_epi8, _mm256_add_epi32, _mm256_and_si256, _mm256_broadcastsi128_si256,
    _mm256_loadu_si256, _mm256_mullo_epi32, _mm256_or_si256, _mm256_set1_epi8, _mm256_set1_epi32,
    _mm256_shuffle_epi8, _mm256_sllv_epi32, _mm256_srav_epi32, _mm256_srlv_epi32,
    _mm256_storeu_si256, _mm256_xor_si256,
};

use super::registers::{int_lanes, register_operators};
use super::{IntLanes, ROW};

/// Eight integers in one register. Used only by kernels that [`super::avx2::run`] has started.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx2Ints(pub(super) __m256i);

int_lanes! {
    Avx2Ints:
    splat: _mm256_set1_epi32,
    bytes: _mm256_set1_epi8,
    load: _mm256_loadu_si256,
    store: _mm256_storeu_si256,
    add: _mm256_add_epi32,
    mul: _mm256_mullo_epi32,
    and: _mm256_and_si256,
    or: _mm256_or_si256,
    xor: _mm256_xor_si256,
    shl: _mm256_sllv_epi32,
    shr: _mm256_srlv_epi32,
    sar: _mm256_srav_epi32,
    look_up: _mm256_shuffle_epi8,
    repeat: _mm256_broadcastsi128_si256,
}
