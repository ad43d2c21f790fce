/// 97.5 % quantiles of Student's distribution for 1 to 30 degrees of freedom.
const STUDENT_975: [f64; 30] = [
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160,
    2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056,
    2.052, 2.048, 2.045, 2.042,
];
/// 97.5 % quantile of the normal distribution.
const NORMAL_975: f64 = 1.959_964;

/// Half width of a 95 % interval in standard errors, for `degrees` of freedom (at least 1).
pub fn student_975(degrees: usize) -> f64 {
    if let Some(tabled) = STUDENT_975.get(degrees.saturating_sub(1)) {
        return *tabled;
    }
    // Cornish and Fisher 1938, "Moments and Cumulants in the Specification of Distributions".
    let (z, n) = (NORMAL_975, degrees as f64);
    z + (z.powi(3) + z) / (4.0 * n)
        + (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / (96.0 * n * n)
}

/// Probability that a standard normal number exceeds `z`; absolute error below 1e-7.
/// Abramowitz and Stegun 1964, "Handbook of Mathematical Functions", 26.2.17.
pub(super) fn normal_tail(z: f64) -> f64 {
    if z < 0.0 {
        return 1.0 - normal_tail(-z);
    }
    let t = 1.0 / (1.0 + 0.231_641_9 * z);
    let series = [
        0.319_381_530,
        -0.356_563_782,
        1.781_477_937,
        -1.821_255_978,
        1.330_274_429,
    ];
    let polynomial = series.iter().rev().fold(0.0, |sum, c| (sum + c) * t);
    (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt() * polynomial
}

/// The value below which the share `p` (0..1) of `sorted` lies, between neighbours linearly.
/// NaN of nothing.
pub(super) fn quantile(sorted: &[f64], p: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let at = p.clamp(0.0, 1.0) * last as f64;
    let below = at.floor() as usize;
    let above = (below + 1).min(last);
    sorted[below] + (sorted[above] - sorted[below]) * (at - below as f64)
}

/// The middle of `values`; NaN of nothing.
pub(super) fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_unstable_by(f64::total_cmp);
    quantile(&values, 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_quantiles_are_met() {
        for (z, tail) in [(0.0, 0.5), (1.0, 0.158_655), (1.959_964, 0.025)] {
            assert!((normal_tail(z) - tail).abs() < 1e-6, "{z}");
            assert!((normal_tail(-z) - (1.0 - tail)).abs() < 1e-6, "{z}");
        }
        assert_eq!((student_975(1), student_975(4)), (12.706, 2.776));
        assert!((student_975(60) - 2.0003).abs() < 1e-3);
        assert!((student_975(100_000) - NORMAL_975).abs() < 1e-4);
        assert_eq!(median([3.0, 1.0, 2.0, 10.0].into_iter()), 2.5);
        assert_eq!(quantile(&[0.0, 1.0, 2.0], 0.25), 0.5);
        assert!(quantile(&[], 0.5).is_nan());
    }
}
