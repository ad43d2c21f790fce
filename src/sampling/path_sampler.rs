use glam::Vec2;

/// What a random number is used for at one bounce; together with the bounce it is the dimension.
///
/// Numbers are addressed, never drawn in sequence, so that leaving one out changes no other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    /// Position inside the pixel (2-D).
    Pixel,
    /// Position on the lens (2-D).
    Lens,
    /// Direction of the scattered ray (2-D).
    Scatter,
    /// Choice of lobe: x.
    Lobe,
    /// Russian roulette: x.
    Roulette,
    /// Choice of a light for direct light sample `.0`: x picks the light, y a part of it.
    LightChoice(u32),
    /// Point on the light for direct light sample `.0` (2-D).
    LightPoint(u32),
    /// Uniform hemisphere direction number `.0` (2-D).
    Hemisphere(u32),
}

impl Slot {
    fn index(self) -> u64 {
        match self {
            Self::Pixel => 0,
            Self::Lens => 1,
            Self::Scatter => 2,
            Self::Lobe => 3,
            Self::Roulette => 4,
            Self::LightChoice(n) => 8 + 3 * u64::from(n),
            Self::LightPoint(n) => 9 + 3 * u64::from(n),
            Self::Hemisphere(n) => 10 + 3 * u64::from(n),
        }
    }
}

/// The random numbers of sample `sample` of pixel `pixel`: a pure function of
/// (seed, pixel, sample, bounce, slot).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathSampler {
    key: u64,
}

impl PathSampler {
    /// The numbers of one path. `pixel` is x + y · 2³² of the whole image, so that regions and
    /// tiles see the same numbers.
    pub fn new(seed: u64, pixel: [u32; 2], sample: u32) -> Self {
        let pixel = u64::from(pixel[0]) | (u64::from(pixel[1]) << 32);
        let key = mix(mix(seed ^ 0x9E37_79B9_7F4A_7C15).wrapping_add(pixel));
        Self {
            key: mix(key ^ u64::from(sample).wrapping_mul(0xD1B5_4A32_D192_ED03)),
        }
    }

    /// Two independent numbers in [0, 1), on the lattice of multiples of 2⁻²⁴ (never 1).
    pub fn get_2d(&self, bounce: u32, slot: Slot) -> Vec2 {
        let dimension = (u64::from(bounce) << 40) ^ slot.index();
        let h = mix(self.key ^ dimension.wrapping_mul(0xA076_1D64_78BD_642F));
        Vec2::new(unit(h as u32), unit((h >> 32) as u32))
    }

    /// One number in [0, 1).
    pub fn get_1d(&self, bounce: u32, slot: Slot) -> f32 {
        self.get_2d(bounce, slot).x
    }
}

fn unit(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// A bijective 64-bit mixer with full avalanche (Stafford 2011, "Better Bit Mixing", variant 13).
fn mix(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn correlation(pairs: impl Iterator<Item = (f32, f32)>) -> f64 {
        let (mut n, mut sx, mut sy, mut sxx, mut syy, mut sxy) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        for (x, y) in pairs {
            let (x, y) = (f64::from(x), f64::from(y));
            n += 1.0;
            sx += x;
            sy += y;
            sxx += x * x;
            syy += y * y;
            sxy += x * y;
        }
        let cov = sxy / n - sx / n * (sy / n);
        cov / ((sxx / n - (sx / n).powi(2)) * (syy / n - (sy / n).powi(2))).sqrt()
    }

    /// Test S16 of the stress list for neighbours in pixel, sample, bounce and slot: |r| < 4/√N,
    /// widened to 4.8/√N because 200 coefficients are looked at.
    #[test]
    fn neighbours_are_uncorrelated() {
        const N: u32 = 65_536;
        let bound = 4.8 / f64::from(N).sqrt();
        for bounce in 0..8 {
            for slot in [
                Slot::Pixel,
                Slot::Scatter,
                Slot::Roulette,
                Slot::LightPoint(0),
                Slot::LightPoint(1),
            ] {
                let at =
                    |x: u32, y: u32, s: u32, b: u32| PathSampler::new(7, [x, y], s).get_2d(b, slot);
                let cases = [
                    correlation((0..N).map(|i| (at(i, 3, 0, bounce).x, at(i + 1, 3, 0, bounce).x))),
                    correlation((0..N).map(|i| (at(i, 3, 0, bounce).x, at(i, 4, 0, bounce).x))),
                    correlation((0..N).map(|i| (at(5, 3, i, bounce).x, at(5, 3, i + 1, bounce).x))),
                    correlation((0..N).map(|i| (at(5, 3, i, bounce).x, at(5, 3, i, bounce + 1).x))),
                    correlation((0..N).map(|i| (at(5, 3, i, bounce).x, at(5, 3, i, bounce).y))),
                ];
                for r in cases {
                    assert!(r.abs() < bound, "bounce {bounce} {slot:?}: {cases:?}");
                }
            }
        }
    }

    #[test]
    fn numbers_stay_below_one_and_are_uniform() {
        let n = 200_000_u32;
        let mut bins = [0_u32; 64];
        for i in 0..n {
            let u = PathSampler::new(1, [i % 640, i / 640], 0).get_2d(2, Slot::Scatter);
            assert!((0.0..1.0).contains(&u.x) && (0.0..1.0).contains(&u.y));
            bins[(u.x * 8.0) as usize * 8 + (u.y * 8.0) as usize] += 1;
        }
        let expected = f64::from(n) / 64.0;
        let chi2: f64 = bins
            .iter()
            .map(|&b| (f64::from(b) - expected).powi(2) / expected)
            .sum();
        // 63 degrees of freedom: mean 63, deviation 11.2; four deviations.
        assert!(chi2 < 108.0, "{chi2}");
    }
}
