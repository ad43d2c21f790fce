//! The low-discrepancy points under the random numbers of a path, before they are randomized.
//!
//! Coordinates are written with the lowest bit as the first binary digit, as
//! [`super::scramble::scramble`] wants them.

use super::scramble::mix_32;

/// Pairs of dimensions in the net.
pub(super) const PAIRS: usize = 7;

/// Columns that were searched for: the first 262 144 points, those of 16 paths for 16 384 samples.
const FOUND: usize = 18;

/// The columns of one upper triangular matrix over GF(2) for each pair: column `j` is where bit `j`
/// of the index goes.
///
/// Each matrix keeps aligned blocks of 2ᵏ indices together, so that every pair alone is a
/// (0,2)-sequence. What is left to choose is how the pairs lie to each other. Simulated annealing
/// chose the first twelve columns for the least mean squared error of the first 2, 4, … 4096
/// scrambled points (16, 64 and 256 counting most) over functions whose share of variance halves
/// with each binary digit and falls with the number of pairs that act together (product weights;
/// Sloan and Woźniakowski 1998, "When Are Quasi-Monte Carlo Algorithms Efficient for High
/// Dimensional Integrals?"). The weights are how much of a path's variance usually hangs on a pair,
/// an eighth of: pixel 0.3, scatter 1, 0.8, 0.5 and light 0.6, 0.6, 0.4 at bounce 0, 1, 2. For the
/// first four columns the pixel had 0.1, the light 0.5, 0.8, 0.4 and the last scatter 0.4: so few
/// points cannot serve all.
///
/// The others were chosen one by one, with the same weights, for the least sum over the elementary
/// intervals of two pairs, of area 2⁻ᵈ for d up to m, of (2ᵍ − 1) 2ᵐ⁻ᵈ, where g of the d digits
/// depend on others in the first 2ᵐ points. With columns by chance in their place the error of sixteen
/// paths that share light fell only by half from 1024 to 4096 samples.
const COLUMNS: [[u32; FOUND]; PAIRS] = [
    [
        1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16_384, 32_768, 65_536,
        131_072,
    ],
    [
        1, 3, 7, 14, 17, 38, 113, 181, 273, 810, 1515, 3613, 6358, 8999, 22_922, 61_078, 106_596,
        135_252,
    ],
    [
        1, 2, 7, 11, 31, 58, 123, 245, 422, 713, 1644, 2593, 5083, 14_403, 26_190, 48_168, 99_450,
        246_747,
    ],
    [
        1, 3, 5, 11, 18, 44, 87, 143, 318, 542, 1094, 2055, 7644, 9544, 28_749, 40_508, 130_278,
        165_264,
    ],
    [
        1, 3, 4, 10, 29, 48, 125, 162, 384, 1023, 1441, 2570, 4154, 13_365, 28_884, 42_453, 91_346,
        154_702,
    ],
    [
        1, 3, 5, 12, 28, 57, 107, 156, 406, 922, 1620, 2393, 4945, 10_398, 21_932, 53_450, 83_223,
        248_560,
    ],
    [
        1, 3, 5, 15, 20, 59, 105, 145, 363, 570, 1852, 3257, 4651, 8283, 17_287, 47_285, 119_146,
        195_962,
    ],
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
                COLUMNS[pair][column]
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

    /// Vectors over GF(2), each with a leading bit of its own.
    struct Basis([u32; 32]);

    impl Basis {
        /// False when `row` depends on the others.
        fn add(&mut self, mut row: u32) -> bool {
            while row != 0 {
                let leading = row.ilog2() as usize;
                if self.0[leading] == 0 {
                    self.0[leading] = row;
                    return true;
                }
                row ^= self.0[leading];
            }
            false
        }
    }

    /// The binary digits of both coordinates of a pair in terms of the first `m` bits of the index.
    fn digits(pair: usize, m: usize) -> [Vec<u32>; 2] {
        let columns: Vec<_> = (0..m).map(|j| point(MATRICES[pair][j])).collect();
        [0, 1].map(|axis| {
            let digit = |d: usize| {
                let bits = columns.iter().enumerate();
                bits.fold(0, |row, (j, column)| row | ((column[axis] >> d) & 1) << j)
            };
            (0..m).map(digit).collect()
        })
    }

    /// Of the elementary intervals of area 2⁻ᵐ of two pairs, the mean of by how much more than one of the
    /// first 2ᵐ points those have that have any.
    fn excess(pairs: [usize; 2], m: usize) -> f64 {
        let [[x0, y0], [x1, y1]] = pairs.map(|pair| digits(pair, m));
        let (mut sum, mut shapes) = (0.0, 0.0);
        let mut visit = |basis: &[&[u32]; 4]| {
            let mut all = Basis([0; 32]);
            let rows = basis.iter().copied().flatten();
            let dependent = rows.filter(|&&row| !all.add(row)).count();
            sum += f64::from(1_u32 << dependent) - 1.0;
            shapes += 1.0;
        };
        for a in 0..=m {
            for b in 0..=m - a {
                for c in 0..=m - a - b {
                    let d = m - a - b - c;
                    visit(&[&x0[..a], &y0[..b], &x1[..c], &y1[..d]]);
                }
            }
        }
        sum / shapes
    }

    /// Columns by chance, from the thirteenth on, have up to 1.1.
    #[test]
    fn pairs_lie_well_to_each_other() {
        const SCATTER: [usize; 2] = [1, 3];
        const LIGHT: usize = 4;
        for m in 4..=FOUND {
            for pairs in [SCATTER, [SCATTER[0], LIGHT], [SCATTER[1], LIGHT]] {
                let excess = excess(pairs, m);
                assert!(excess < 0.9, "pairs {pairs:?}, {m} bits: {excess}");
            }
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
