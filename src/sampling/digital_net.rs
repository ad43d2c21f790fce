//! The low-discrepancy points under the random numbers of a path, before they are randomized.
//!
//! Coordinates are written with the lowest bit as the first binary digit, as
//! [`super::scramble::scramble`] wants them.

use super::scramble::mix_32;

/// Pairs of dimensions in the net.
pub(super) const PAIRS: usize = 7;

/// Columns that were searched for: the first 4096 points.
const FOUND: usize = 12;

/// The columns of one upper triangular matrix over GF(2) for each pair: column `j` is where bit `j`
/// of the index goes.
///
/// Each matrix keeps aligned blocks of 2ᵏ indices together, so that every pair alone is a
/// (0,2)-sequence. What is left to choose is how the pairs lie to each other. Simulated annealing
/// chose it for the least mean squared error of the first 2, 4, … 4096 scrambled points (16, 64 and
/// 256 counting most) over functions whose share of variance halves with each binary digit and
/// falls with the number of pairs that act together (product weights; Sloan and Woźniakowski 1998,
/// "When Are Quasi-Monte Carlo Algorithms Efficient for High Dimensional Integrals?"). The weights
/// are how much of a path's variance usually hangs on a pair, an eighth of: pixel 0.3, scatter 1,
/// 0.8, 0.5 and light 0.6, 0.6, 0.4 at bounce 0, 1, 2. For the first four columns the pixel had 0.1,
/// the light 0.5, 0.8, 0.4 and the last scatter 0.4: so few points cannot serve all.
const COLUMNS: [[u16; FOUND]; PAIRS] = [
    [1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048],
    [1, 3, 7, 14, 17, 38, 113, 181, 273, 810, 1515, 3613],
    [1, 2, 7, 11, 31, 58, 123, 245, 422, 713, 1644, 2593],
    [1, 3, 5, 11, 18, 44, 87, 143, 318, 542, 1094, 2055],
    [1, 3, 4, 10, 29, 48, 125, 162, 384, 1023, 1441, 2570],
    [1, 3, 5, 12, 28, 57, 107, 156, 406, 922, 1620, 2393],
    [1, 3, 5, 15, 20, 59, 105, 145, 363, 570, 1852, 3257],
];

const MATRICES: [[u32; 32]; PAIRS] = matrices();

/// The columns that were found, and upper triangular ones by chance from there on.
const fn matrices() -> [[u32; 32]; PAIRS] {
    let mut matrices = [[0; 32]; PAIRS];
    let mut pair = 0;
    while pair < PAIRS {
        let mut column = 0;
        while column < 32 {
            let diagonal = 1 << column;
            matrices[pair][column] = if column < FOUND {
                COLUMNS[pair][column] as u32
            } else {
                diagonal | (mix_32((32 * pair + column) as u32) & (diagonal - 1))
            };
            column += 1;
        }
        pair += 1;
    }
    matrices
}

/// The index at which the (0,2)-sequence of [`point`] has what pair `pair` of the net shows at
/// `index`.
pub(super) fn index_in_pair(pair: usize, index: u32) -> u32 {
    let columns = &MATRICES[pair];
    let mut rest = index;
    let mut sum = 0;
    while rest != 0 {
        sum ^= columns[rest.trailing_zeros() as usize];
        rest &= rest - 1;
    }
    sum
}

/// The bits of an index below 16.
pub(super) const PLACES: u32 = 15;

/// [`index_in_pair`] of the indices below 16, which are added (modulo 2) to those of the other bits.
pub(super) const LOW: [[u32; 16]; PAIRS] = low();

const fn low() -> [[u32; 16]; PAIRS] {
    let mut low = [[0; 16]; PAIRS];
    let mut pair = 0;
    while pair < PAIRS {
        let mut index = 1;
        while index < 16_usize {
            let column = MATRICES[pair][index.trailing_zeros() as usize];
            low[pair][index] = low[pair][index & (index - 1)] ^ column;
            index += 1;
        }
        pair += 1;
    }
    low
}

/// The bits that take part in each step of Pascal's triangle.
pub(super) const PASCAL: [u32; 5] = [
    0x0000_FFFF,
    0x00FF_00FF,
    0x0F0F_0F0F,
    0x3333_3333,
    0x5555_5555,
];

/// Point `index` of the (0,2)-sequence of Sobol: of any 2ᵏ points from an aligned index on, each
/// elementary interval of area 2⁻ᵏ holds one.
///
/// Sobol 1967, "On the Distribution of Points in a Cube and the Approximate Evaluation of
/// Integrals". The first coordinate is the index itself (van der Corput), the second its product
/// with Pascal's triangle modulo 2, in five steps since that matrix is a Kronecker power.
pub(super) fn point(index: u32) -> [u32; 2] {
    let mut y = index;
    y ^= (y >> 16) & PASCAL[0];
    y ^= (y >> 8) & PASCAL[1];
    y ^= (y >> 4) & PASCAL[2];
    y ^= (y >> 2) & PASCAL[3];
    y ^= (y >> 1) & PASCAL[4];
    [index, y]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matrices_keep_aligned_blocks_together() {
        for columns in MATRICES {
            for (j, column) in columns.into_iter().enumerate() {
                assert_eq!(column >> j, 1, "column {j}: {column:b}");
            }
        }
    }

    #[test]
    fn the_second_coordinate_is_pascals_triangle() {
        for j in 0..32_u32 {
            // Row j, one binomial coefficient from the one before.
            let row = (0..=u64::from(j)).scan(1_u64, |coefficient, k| {
                let current = *coefficient;
                *coefficient = current * (u64::from(j) - k) / (k + 1);
                Some(current)
            });
            let column = row.enumerate().fold(0, |sum, (k, coefficient)| {
                sum | ((coefficient & 1) as u32) << k
            });
            assert_eq!(point(1 << j)[1], column, "column {j}");
        }
    }

    #[test]
    fn pairs_are_linear() {
        for pair in 0..PAIRS {
            for i in 0..200 {
                let (a, b) = (mix_32(i), mix_32(i + 999));
                let both = index_in_pair(pair, a) ^ index_in_pair(pair, b);
                assert_eq!(index_in_pair(pair, a ^ b), both);
            }
        }
    }
}
