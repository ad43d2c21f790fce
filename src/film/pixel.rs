use crate::color::Rgb;

/// Mean and variance of the samples of one pixel, per channel.
///
/// Samples are added one by one in the order of their index, so that the result does not depend
/// on how they were divided into passes. Welford 1962, "Note on a Method for Calculating Corrected
/// Sums of Squares and Products", in f64.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PixelStats {
    mean: [f64; 3],
    /// Sum of squared deviations from the mean.
    deviation: [f64; 3],
    /// The same for the luminance, which the course's adaptive rule looks at.
    luminance_deviation: f64,
    count: u32,
    /// The pixel takes no more samples (adaptive sampling).
    closed: bool,
}

impl PixelStats {
    /// Adds one sample of finite radiance.
    pub fn add(&mut self, radiance: Rgb) {
        self.count += 1;
        let share = 1.0 / f64::from(self.count);
        let radiance_luminance = luminance_f64(radiance.to_array().map(f64::from));
        let luminance_before = radiance_luminance - luminance_f64(self.mean);
        for (channel, x) in radiance.to_array().into_iter().enumerate() {
            let x = f64::from(x);
            let before = x - self.mean[channel];
            self.mean[channel] += before * share;
            self.deviation[channel] += before * (x - self.mean[channel]);
        }
        self.luminance_deviation +=
            luminance_before * (radiance_luminance - luminance_f64(self.mean));
    }

    /// Samples so far.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// Mean radiance per channel.
    pub fn mean(&self) -> [f64; 3] {
        self.mean
    }

    /// Mean radiance as pixels carry it.
    pub fn radiance(&self) -> Rgb {
        Rgb::new(
            self.mean[0] as f32,
            self.mean[1] as f32,
            self.mean[2] as f32,
        )
    }

    /// Unbiased variance of one sample per channel; `None` below two samples.
    pub fn variance(&self) -> Option<[f64; 3]> {
        (self.count > 1).then(|| self.deviation.map(|d| d / f64::from(self.count - 1)))
    }

    /// Mean and unbiased variance of the luminance of one sample; `None` below two samples.
    pub fn luminance(&self) -> Option<(f64, f64)> {
        let variance = self.luminance_deviation / f64::from(self.count.max(2) - 1);
        (self.count > 1).then(|| (luminance_f64(self.mean), variance))
    }

    /// The squared error of the mean that the variance predicts, relative as in relMSE:
    /// the mean over the channels of σ²/n / (mean² + 0.01). `None` below two samples.
    pub fn relative_squared_error(&self) -> Option<f64> {
        let variance = self.variance()?;
        let n = f64::from(self.count);
        let sum: f64 = (0..3)
            .map(|c| variance[c] / n / (self.mean[c] * self.mean[c] + 0.01))
            .sum();
        Some(sum / 3.0)
    }

    /// True when adaptive sampling has ended this pixel.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Ends this pixel.
    pub fn close(&mut self) {
        self.closed = true;
    }
}

fn luminance_f64(rgb: [f64; 3]) -> f64 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Test F2 of the stress list: small deviation on a large mean.
    #[test]
    fn variance_does_not_cancel() {
        for (mean, deviation) in [(1.0_f32, 1e-3_f32), (10.0, 1e-2), (1000.0, 0.1)] {
            let mut stats = PixelStats::default();
            let n = 100_000;
            for i in 0..n {
                let x = if i % 2 == 0 {
                    mean + deviation
                } else {
                    mean - deviation
                };
                stats.add(Rgb::splat(x));
            }
            let (low, high) = (f64::from(mean - deviation), f64::from(mean + deviation));
            let expected = ((high - low) / 2.0).powi(2) * f64::from(n) / f64::from(n - 1);
            let variance = stats.variance().map_or(0.0, |v| v[0]);
            assert!(
                (variance / expected - 1.0).abs() < 1e-3,
                "{variance} {expected}"
            );
        }
    }

    /// Test F1: the mean of many samples does not drift.
    #[test]
    fn the_mean_of_many_samples_does_not_drift() {
        let mut stats = PixelStats::default();
        let mut exact = 0.0_f64;
        let n = 5_000_000_u32;
        for i in 0..n {
            let x = (i.wrapping_mul(2_654_435_761) >> 8) as f32 / 16_777_216.0;
            exact += f64::from(x);
            stats.add(Rgb::splat(x));
        }
        assert!((stats.mean()[0] / (exact / f64::from(n)) - 1.0).abs() < 1e-9);
    }
}
