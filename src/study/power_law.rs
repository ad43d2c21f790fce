use serde::{Deserialize, Serialize};

/// A point of a curve, both above 0, and how sure its height is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeightedPoint {
    /// Processor seconds.
    pub x: f64,
    /// Error.
    pub y: f64,
    /// Variance of ln y, above 0.
    pub variance: f64,
}

/// y = exp(`intercept`) · x^`slope`: a straight line where both axes are logarithmic. Error falls
/// with slope −1 for independent samples, faster for well spread ones; a curve that flattens out is
/// biased or has met the noise of its reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PowerLaw {
    /// Exponent.
    pub slope: f64,
    /// Standard error of the slope; `None` for two points, which tell nothing about it.
    pub slope_error: Option<f64>,
    /// ln y at x = 1.
    pub intercept: f64,
}

/// Where a curve reaches a height.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reach {
    /// The height.
    pub rel_mse: f64,
    /// Processor seconds.
    pub cpu_seconds: f64,
    /// True outside of what was measured.
    pub is_extrapolated: bool,
}

impl PowerLaw {
    /// Weighted least squares of ln y on ln x, the weights being 1 / variance. The error of the
    /// slope is widened where the points scatter more than their variances say. `None` without two
    /// points of different x; points that are not positive and finite are left out.
    pub fn fit(points: &[WeightedPoint]) -> Option<Self> {
        let is_usable = |v: f64| v > 0.0 && v.is_finite();
        let logs: Vec<[f64; 3]> = points
            .iter()
            .filter(|p| is_usable(p.x) && is_usable(p.y) && is_usable(p.variance))
            .map(|p| [p.x.ln(), p.y.ln(), 1.0 / p.variance])
            .collect();
        let weight: f64 = logs.iter().map(|[.., w]| w).sum();
        let mean = |of: usize| logs.iter().map(|p| p[of] * p[2]).sum::<f64>() / weight;
        let (x_mean, y_mean) = (mean(0), mean(1));
        let spread: f64 = logs.iter().map(|[x, _, w]| w * (x - x_mean).powi(2)).sum();
        // Not so for no points either, whose means are NaN.
        let is_line = logs.len() >= 2 && spread > 1e-12 * weight;
        if !is_line {
            return None;
        }
        let slope = logs
            .iter()
            .map(|[x, y, w]| w * (x - x_mean) * (y - y_mean))
            .sum::<f64>()
            / spread;
        let intercept = y_mean - slope * x_mean;
        let scatter: f64 = logs
            .iter()
            .map(|[x, y, w]| w * (y - intercept - slope * x).powi(2))
            .sum();
        let degrees = (logs.len() - 2) as f64;
        let widened = (scatter / degrees).max(1.0);
        let slope_error = (degrees > 0.0).then(|| (widened / spread).sqrt());
        Some(Self {
            slope,
            slope_error,
            intercept,
        })
    }

    /// The height at `x`.
    pub fn at(&self, x: f64) -> f64 {
        (self.intercept + self.slope * x.ln()).exp()
    }

    /// Where the line reaches the height `rel_mse`, the heights from `measured.0` to `measured.1`
    /// having been measured; `None` for a line that does not fall.
    pub fn reach(&self, rel_mse: f64, measured: (f64, f64)) -> Option<Reach> {
        let cpu_seconds = ((rel_mse.ln() - self.intercept) / self.slope).exp();
        (self.slope < 0.0 && cpu_seconds.is_finite()).then_some(Reach {
            rel_mse,
            cpu_seconds,
            is_extrapolated: !(measured.0..=measured.1).contains(&rel_mse),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::bootstrap::SplitMix;
    use super::*;

    fn curve(slope: f64, noise: impl Fn(usize) -> f64, random: &mut SplitMix) -> PowerLaw {
        let points: Vec<WeightedPoint> = (0..9)
            .map(|k| {
                let x = 0.5 * f64::from(1 << k);
                let y = 0.2 * x.powf(slope) * (noise(k) * random.normal()).exp();
                let variance = noise(k).powi(2).max(1e-12);
                WeightedPoint { x, y, variance }
            })
            .collect();
        PowerLaw::fit(&points).unwrap()
    }

    #[test]
    fn an_exact_line_is_recovered_and_reached() {
        let line = curve(-1.25, |_| 0.0, &mut SplitMix(1));
        assert!((line.slope + 1.25).abs() < 1e-9 && line.slope_error.unwrap() < 1e-5);
        assert!((line.at(1.0) - 0.2).abs() < 1e-9);
        let inside = line.reach(0.01, (1e-3, 0.1)).unwrap();
        assert!((inside.cpu_seconds - 20_f64.powf(0.8)).abs() < 1e-6 && !inside.is_extrapolated);
        assert!(line.reach(1e-4, (1e-3, 0.1)).unwrap().is_extrapolated);
        let rising = curve(0.5, |_| 0.0, &mut SplitMix(1));
        assert_eq!(rising.reach(0.01, (0.0, 1.0)), None);
    }

    #[test]
    fn noise_moves_the_slope_as_far_as_its_error_says() {
        let mut random = SplitMix(3);
        // Points of very different trust: weights matter.
        let noise = |k: usize| if k < 3 { 0.5 } else { 0.02 };
        let (mut squares, mut errors, mut sum) = (0.0, 0.0, 0.0);
        let trials = 400;
        for _ in 0..trials {
            let line = curve(-1.0, noise, &mut random);
            sum += line.slope + 1.0;
            squares += (line.slope + 1.0).powi(2);
            errors += line.slope_error.unwrap().powi(2);
        }
        let n = f64::from(trials);
        let deviation = (squares / n).sqrt();
        assert!((sum / n).abs() < 4.0 * deviation / n.sqrt(), "{}", sum / n);
        let told = (errors / n).sqrt();
        assert!(
            (0.8..1.5).contains(&(told / deviation)),
            "{told} {deviation}"
        );
        // Without weights the three wild points would decide.
        assert!(deviation < 0.02, "{deviation}");
    }

    #[test]
    fn there_is_no_line_through_one_place() {
        let point = |x, y| WeightedPoint {
            x,
            y,
            variance: 0.1,
        };
        assert_eq!(PowerLaw::fit(&[]), None);
        assert_eq!(PowerLaw::fit(&[point(1.0, 2.0)]), None);
        assert_eq!(PowerLaw::fit(&[point(2.0, 2.0), point(2.0, 1.0)]), None);
        let usable = [
            point(1.0, 2.0),
            point(2.0, -1.0),
            point(4.0, 0.5),
            point(8.0, f64::NAN),
        ];
        let line = PowerLaw::fit(&usable).unwrap();
        assert!((line.slope + 1.0).abs() < 1e-12 && line.slope_error.is_none());
    }
}
