use crate::color::Rgb;

/// The means of the replicates of each pixel of a tile; nothing for a single one.
///
/// Sample i belongs to replicate i modulo their number
/// ([`crate::sampling::PathSampler::replicated`]). Only their differences are of interest, so single
/// precision is enough: 12 bytes a pixel and replicate.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Replicates {
    number: u32,
    /// Those of one pixel after those of the other.
    means: Vec<[f32; 3]>,
}

impl Replicates {
    /// `number` replicates for each of `pixels` pixels.
    pub(super) fn new(number: u32, pixels: usize) -> Self {
        let stored = if number > 1 { number as usize } else { 0 };
        Self {
            number,
            means: vec![[0.0; 3]; pixels * stored],
        }
    }

    pub(super) fn number(&self) -> u32 {
        self.number
    }

    pub(super) fn clear(&mut self) {
        self.means.fill([0.0; 3]);
    }

    /// Adds sample number `sample` of pixel `index`.
    pub(super) fn add(&mut self, index: usize, sample: u32, radiance: Rgb) {
        if self.number < 2 {
            return;
        }
        let at = index * self.number as usize + (sample % self.number) as usize;
        let share = 1.0 / (sample / self.number + 1) as f32;
        for (mean, x) in self.means[at].iter_mut().zip(radiance.to_array()) {
            *mean += (x - *mean) * share;
        }
    }

    /// The squared error of the mean of pixel `index` per channel, by the spread of the means of its
    /// replicates: unbiased when all have the same number of samples. `None` for a single
    /// replicate and before each has a sample of the pixel's `count`.
    pub(super) fn squared_error(&self, index: usize, count: u32) -> Option<[f64; 3]> {
        if self.number < 2 || count < self.number {
            return None;
        }
        let number = self.number as usize;
        let means = &self.means[index * number..][..number];
        let n = f64::from(self.number);
        let mut squares = [0.0; 3];
        for (c, sum) in squares.iter_mut().enumerate() {
            let middle = means.iter().map(|m| f64::from(m[c])).sum::<f64>() / n;
            let deviations = means.iter().map(|m| (f64::from(m[c]) - middle).powi(2));
            *sum = deviations.sum::<f64>() / (n * (n - 1.0));
        }
        Some(squares)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spread_of_the_means_is_that_of_the_samples_dealt_out() {
        let mut replicates = Replicates::new(2, 3);
        for (sample, x) in [1.0, 5.0, 3.0, 9.0].into_iter().enumerate() {
            replicates.add(1, sample as u32, Rgb::new(x, 2.0 * x, 0.0));
        }
        // The means are 2 and 7, their middle 4.5.
        let expected = 2.0 * 2.5 * 2.5 / 2.0;
        assert_eq!(
            replicates.squared_error(1, 4),
            Some([expected, 4.0 * expected, 0.0])
        );
        assert_eq!(replicates.squared_error(1, 1), None);
        assert_eq!(replicates.squared_error(0, 4), Some([0.0; 3]));
        assert_eq!(Replicates::new(1, 3).squared_error(0, 4), None);
    }
}
