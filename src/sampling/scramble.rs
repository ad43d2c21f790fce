//! Hashes: mixers, and the nested scrambling that randomizes low-discrepancy points.

/// The factors of [`mix_32`].
pub(super) const MIX_32: [u32; 2] = [0x7FEB_352D, 0x846C_A68B];

/// The factors of [`scramble`].
pub(super) const LAINE_KARRAS: [u32; 3] = [0x3D20_ADEA, 0x0552_6C56, 0x53A2_2864];

/// A bijective 32-bit mixer with full avalanche (Wellons 2018, "Prospecting for Hash Functions",
/// the function with the lowest bias of two rounds).
pub(super) const fn mix_32(mut x: u32) -> u32 {
    x = (x ^ (x >> 16)).wrapping_mul(MIX_32[0]);
    x = (x ^ (x >> 15)).wrapping_mul(MIX_32[1]);
    x ^ (x >> 16)
}

/// A bijective 64-bit mixer with full avalanche (Stafford 2011, "Better Bit Mixing", variant 13).
pub(super) fn mix_64(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}

/// Owen's nested uniform scramble of a number whose *lowest* bit is its first binary digit: what
/// happens to a bit depends on the bits below it only.
///
/// Owen 1995, "Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences". The hash is of the form found
/// by Laine and Karras 2011, "Stratified Sampling for Stochastic Transparency", its use here by
/// Burley 2020, "Practical Hash-based Owen Scrambling", its constants by Vegdahl 2021, "Building a
/// Better LK Hash".
pub(super) fn scramble(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(LAINE_KARRAS[0]);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(LAINE_KARRAS[1]);
    x ^ x.wrapping_mul(LAINE_KARRAS[2])
}

/// The numbers below 2³² in another order that keeps every aligned block of 2ᵏ numbers together:
/// the same scramble with the highest bit as the first digit.
pub(super) fn shuffle(index: u32, seed: u32) -> u32 {
    scramble(index.reverse_bits(), seed).reverse_bits()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bit_depends_on_no_bit_above_it() {
        for i in 0..2000_u32 {
            let (x, seed) = (mix_32(i), mix_32(i ^ 0x5555_0000));
            for bits in 1..32 {
                let mask = (1_u32 << bits) - 1;
                let other = (x & mask) | (mix_32(x) & !mask);
                assert_eq!(scramble(x, seed) & mask, scramble(other, seed) & mask);
                assert_ne!(scramble(x, seed), scramble(x ^ (1 << bits), seed));
            }
        }
    }

    /// Over all seeds, each bit of a number is flipped half of the time, whatever the bits below,
    /// and two bits of one number independently of each other.
    #[test]
    fn flips_are_fair_and_independent() {
        const N: u32 = 20_000;
        // Four and a half deviations; some three thousand looks.
        let bound = 4.5 * f64::from(N).sqrt() / 2.0;
        let numbers = [0, 1, 0b1011, 0xDEAD_BEEF, 0xFFFF_FFFF];
        for x in numbers {
            let flips = |i: u32| x ^ scramble(x, mix_32(i + 1));
            for (a, b) in (0..16).flat_map(|a| (a..24).map(move |b| (a, b))) {
                let odd = (0..N)
                    .filter(|&i| {
                        let f = flips(i);
                        let parity = (f >> a) ^ if a == b { 0 } else { f >> b };
                        parity & 1 == 1
                    })
                    .count();
                let deviation = (odd as f64 - f64::from(N) / 2.0).abs();
                assert!(deviation < bound, "{x:x}, bits {a} and {b}: {odd} of {N}");
            }
        }
    }

    #[test]
    fn shuffling_keeps_blocks_together() {
        for seed in [0, 1, 0x1234_5678] {
            for bits in [2_u32, 5, 8] {
                for block in 0..5_u32 {
                    let mut to: Vec<u32> = (0..1 << bits)
                        .map(|i| shuffle((block << bits) + i, seed))
                        .collect();
                    to.sort_unstable();
                    assert_eq!(to[0] % (1 << bits), 0);
                    assert!(to.windows(2).all(|w| w[1] == w[0] + 1));
                }
            }
        }
    }
}
