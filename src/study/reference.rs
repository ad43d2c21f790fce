use super::quantile::normal_tail;
use crate::color::Rgb;
use crate::image::{CompareError, Image, Score, score};

/// Edge of the blocks whose means are compared, in pixels.
const BLOCK: usize = 8;

/// The picture that others are held against, and its own noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Linear pixels.
    pub image: Image<Rgb>,
    /// What a perfect picture would score against it; subtracted from every score.
    pub noise: Score,
    /// Probability that two halves of one estimator differ as much as these do; small when
    /// something is wrong. `None` when there are no halves.
    pub agreement: Option<f64>,
}

impl Reference {
    /// A finished picture, the relMSE of whose noise is known or 0.
    pub fn known(image: Image<Rgb>, rel_mse: f64) -> Self {
        let noise = Score {
            rel_mse,
            rel_mse_trimmed: rel_mse,
            ..Score::default()
        };
        Self {
            image,
            noise,
            agreement: None,
        }
    }

    /// The mean of two pictures of as many samples each and different seeds. Half their difference
    /// is as far from 0 as their mean is from the truth, which tells the noise.
    ///
    /// # Errors
    /// When the sizes differ or no pixel is finite.
    pub fn from_halves(a: &Image<Rgb>, b: &Image<Rgb>) -> Result<Self, CompareError> {
        let agreement = score(a, b).map(|_| agreement(a, b))?;
        let both = a.pixels().iter().zip(b.pixels());
        let pixels = both.map(|(&a, &b)| a * 0.5 + b * 0.5).collect();
        let mean = Image::from_pixels(a.width(), a.height(), pixels);
        let noise = score(a, &mean)?;
        Ok(Self {
            image: mean,
            noise,
            agreement: Some(agreement),
        })
    }

    /// The errors of `image` without the reference's own; single figures may be below 0 when they
    /// are smaller than their doubt.
    ///
    /// # Errors
    /// When the sizes differ or no pixel is finite.
    pub fn score(&self, image: &Image<Rgb>) -> Result<Score, CompareError> {
        let gross = score(image, &self.image)?;
        Ok(Score {
            rel_mse: gross.rel_mse - self.noise.rel_mse,
            rel_mse_trimmed: gross.rel_mse_trimmed - self.noise.rel_mse_trimmed,
            mse: gross.mse - self.noise.mse,
            mean_ratio: gross.mean_ratio,
        })
    }
}

/// Two-sided sign test: of the blocks of 8 × 8 pixels, as many should be brighter in `a` as in `b`.
fn agreement(a: &Image<Rgb>, b: &Image<Rgb>) -> f64 {
    let [mut brighter, mut unequal] = [0.0, 0.0];
    for y in (0..a.height()).step_by(BLOCK) {
        for x in (0..a.width()).step_by(BLOCK) {
            let difference = block_difference(a, b, (x, y));
            brighter += f64::from(u8::from(difference > 0.0));
            unequal += f64::from(u8::from(difference != 0.0));
        }
    }
    if unequal == 0.0 {
        return 1.0;
    }
    let off = ((brighter - 0.5 * unequal).abs() - 0.5).max(0.0);
    2.0 * normal_tail(off / (0.5 * unequal.sqrt()))
}

fn block_difference(a: &Image<Rgb>, b: &Image<Rgb>, corner: (usize, usize)) -> f64 {
    let (right, bottom) = (
        (corner.0 + BLOCK).min(a.width()),
        (corner.1 + BLOCK).min(a.height()),
    );
    (corner.1..bottom)
        .flat_map(|y| (corner.0..right).map(move |x| (x, y)))
        .map(|(x, y)| (a.get(x, y).as_dvec3() - b.get(x, y).as_dvec3()).element_sum())
        .filter(|difference| difference.is_finite())
        .sum()
}

#[cfg(test)]
mod tests {
    use super::super::bootstrap::SplitMix;
    use super::*;

    const SIZE: usize = 96;

    fn truth(index: usize) -> Rgb {
        let x = (index % SIZE) as f32 / SIZE as f32;
        Rgb::new(0.05 + x, 0.5, 1.5 - x)
    }

    /// The truth with noise in proportion to it, and `bias` too bright.
    fn noisy(deviation: f32, bias: f32, seed: u64) -> Image<Rgb> {
        let mut random = SplitMix(seed);
        let mut pixel = |index| {
            let noise = Rgb::from_array([(); 3].map(|()| random.normal() as f32));
            truth(index) * (1.0 + bias + deviation * noise)
        };
        let pixels = (0..SIZE * SIZE).map(&mut pixel).collect();
        Image::from_pixels(SIZE, SIZE, pixels)
    }

    #[test]
    fn scores_against_a_noisy_reference_are_those_against_the_truth() {
        let exact = Reference::known(noisy(0.0, 0.0, 0), 0.0);
        let image = noisy(0.05, 0.0, 1);
        let expected = exact.score(&image).unwrap();
        // The reference is as noisy as the picture.
        let (mut net, mut gross) = (0.0, 0.0);
        for seed in 0..8 {
            let [a, b] = [2 + 2 * seed, 3 + 2 * seed].map(|seed| noisy(0.07, 0.0, seed));
            let reference = Reference::from_halves(&a, &b).unwrap();
            let got = reference.score(&image).unwrap();
            net += got.rel_mse / 8.0;
            gross += (got.rel_mse + reference.noise.rel_mse) / 8.0;
            assert!((got.mse / expected.mse - 1.0).abs() < 0.1);
        }
        assert!((net / expected.rel_mse - 1.0).abs() < 0.02, "{net}");
        assert!(gross / expected.rel_mse > 1.8, "{gross}");
    }

    #[test]
    fn a_perfect_picture_scores_nothing_on_average() {
        let sum: f64 = (0..16)
            .map(|seed| {
                let [a, b] = [2 * seed, 2 * seed + 1].map(|seed| noisy(0.05, 0.0, seed));
                let reference = Reference::from_halves(&a, &b).unwrap();
                reference.score(&noisy(0.0, 0.0, 0)).unwrap().rel_mse / reference.noise.rel_mse
            })
            .sum();
        assert!((sum / 16.0).abs() < 0.02, "{sum}");
    }

    #[test]
    fn halves_of_one_estimator_agree_and_others_do_not() {
        let p = |bias, seed| {
            let other = noisy(0.1, bias, seed + 100);
            let halves = Reference::from_halves(&noisy(0.1, 0.0, seed), &other);
            halves.unwrap().agreement.unwrap()
        };
        let small = (0..50).filter(|&seed| p(0.0, seed) < 0.05).count();
        assert!(small <= 7, "{small}");
        // 2 % too bright: 1.2 standard deviations of a block.
        assert!((0..10).all(|seed| p(0.02, seed) < 0.01));
        let same = noisy(0.1, 0.0, 5);
        let twins = Reference::from_halves(&same, &same).unwrap();
        assert_eq!((twins.agreement, twins.noise.rel_mse), (Some(1.0), 0.0));
    }

    #[test]
    fn a_picture_of_another_size_is_refused() {
        let reference = Reference::known(Image::filled(2, 2, Rgb::ONE), 0.0);
        let other = Image::filled(2, 3, Rgb::ONE);
        assert!(matches!(
            reference.score(&other),
            Err(CompareError::Size { .. })
        ));
        assert!(Reference::from_halves(&reference.image, &other).is_err());
    }
}
