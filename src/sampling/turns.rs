//! Which of the points of a cluster each of its paths takes.

use super::scramble::mix_32;
use crate::math::set_bits;

/// Bits of the number of a sample that were searched for: the first 16 384 samples.
const FOUND: usize = 14;

/// For clusters of 2, 4, 8 and 16 paths: what each bit of the number of a sample turns the paths by.
///
/// The points of all paths together are even whatever stands here. A beam search chose it so that those
/// of one path are too: for the least sum, over the first 2, 4, … 16 384 samples, of 2ᵍ − 1, where the
/// first 2ⁿ points have the same number in every elementary interval of area 2⁻ⁿ⁺ᵍ. From the number of
/// points on at which the columns of the net go beyond 4096 all pairs but the pixel's count alike; before,
/// they count 2 (scatter), 1 (next scatter), 2 (its light), 0.5 and 0.5. With these weights throughout
/// mirrors and glass lose what an empty box gains. g is 0 to 5; with the low bits of the sample in reverse
/// order it grows to 9, and the error falls no more from some number of samples on.
const COLUMNS: [[u8; FOUND]; 4] = [
    [0, 0, 0, 1, 1, 0, 0, 1, 1, 1, 1, 1, 0, 0],
    [2, 2, 1, 1, 0, 0, 0, 1, 1, 3, 0, 0, 2, 3],
    [2, 1, 3, 3, 0, 6, 1, 2, 1, 5, 3, 1, 6, 4],
    [1, 9, 9, 0, 12, 9, 2, 6, 13, 4, 3, 6, 2, 0],
];

/// What the number of a path is changed by (exclusive or) in sample number `index` of a cluster of `size`
/// paths, 2 to 16 and a power of two; less than `size`.
pub(super) fn turn(size: u32, index: u32) -> u32 {
    let columns = &COLUMNS[size.ilog2() as usize - 1];
    let beyond = index >> FOUND;
    let first = if beyond == 0 { 0 } else { mix_32(beyond) };
    let bits = set_bits(index & ((1 << FOUND) - 1));
    bits.fold(first, |turn, bit| turn ^ u32::from(columns[bit])) & (size - 1)
}
