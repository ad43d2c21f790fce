use crate::color::Rgb;

/// Mean and variance of the samples of one pixel, per channel.
///
/// Samples are added one by one in the order of their index, so that the result does not depend
/// on how they were divided into passes. Welford 1962, "Note on a Method for Calculating Corrected
/// Sums of Squares and Products", in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelStats {
    mean: [f64; 3],
    /// Sum of squared deviations from the mean.
    deviation: [f64; 3],
    /// The same for the luminance, which the course's adaptive rule looks at.
    luminance_deviation: f64,
    /// The mean when the number of samples was last a power of two.
    mark: [f32; 3],
    /// Square of half the difference that there was then between the means of the two halves.
    half_difference: [f32; 3],
    count: u32,
    /// The number of samples at which the pixel takes no more (adaptive sampling).
    limit: u32,
}

impl Default for PixelStats {
    fn default() -> Self {
        Self {
            mean: [0.0; 3],
            deviation: [0.0; 3],
            luminance_deviation: 0.0,
            mark: [0.0; 3],
            half_difference: [0.0; 3],
            count: 0,
            limit: u32::MAX,
        }
    }
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
        if self.count.is_power_of_two() {
            self.compare_halves();
        }
    }

    /// The mean of all lies in the middle between those of both halves, of which the first is known.
    fn compare_halves(&mut self) {
        for channel in 0..3 {
            let half = self.mean[channel] - f64::from(self.mark[channel]);
            self.half_difference[channel] = (half * half) as f32;
            self.mark[channel] = self.mean[channel] as f32;
        }
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

    /// The squared error of the mean per channel; `None` below two samples.
    ///
    /// The first 2ᵏ samples are a low-discrepancy set, and so are their halves, which tell by their
    /// difference what independent samples would tell by their variance. Were the halves
    /// independent, the expected square of half their difference would be the squared error; as they
    /// complete each other, it is somewhat larger. From there the error falls with the number of
    /// samples.
    pub fn squared_error(&self) -> Option<[f64; 3]> {
        let share = f64::from(1 << self.count.checked_ilog2()?) / f64::from(self.count);
        (self.count > 1).then(|| self.half_difference.map(|d| f64::from(d) * share))
    }

    /// The number of samples at which the pixel takes no more; `u32::MAX` while it is open.
    pub fn limit(&self) -> u32 {
        self.limit
    }

    /// Lets the pixel take samples up to `limit` of them.
    pub fn set_limit(&mut self, limit: u32) {
        self.limit = limit;
    }

    /// True when sample number `sample` is the next one.
    pub fn takes(&self, sample: u32) -> bool {
        self.count == sample && sample < self.limit
    }

    /// True when adaptive sampling has ended this pixel.
    pub fn is_closed(&self) -> bool {
        self.count >= self.limit
    }

    /// Ends this pixel.
    pub fn close(&mut self) {
        self.limit = self.count;
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

    /// Independent samples, so that both estimates have the same mean.
    #[test]
    fn halves_tell_the_error_of_independent_samples() {
        let mut random = 1_u32;
        for n in [2_u32, 8, 12, 64, 100] {
            let (mut sum, pixels) = (0.0, 20_000);
            for _ in 0..pixels {
                let mut stats = PixelStats::default();
                for _ in 0..n {
                    random = random.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
                    let mixed = (random ^ (random >> 15)).wrapping_mul(0x2C1B_3C6D);
                    stats.add(Rgb::splat((mixed >> 8) as f32 / 16_777_216.0));
                }
                sum += stats.squared_error().map_or(0.0, |e| e[0]);
            }
            let expected = 1.0 / 12.0 / f64::from(n);
            let ratio = sum / f64::from(pixels) / expected;
            assert!((ratio - 1.0).abs() < 0.05, "{n} samples: {ratio}");
        }
        let mut single = PixelStats::default();
        assert_eq!(single.squared_error(), None);
        single.add(Rgb::ONE);
        assert_eq!(single.squared_error(), None);
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
