/// exp(x²)·erfc(x) for x ≥ 0; the error after multiplication with exp(−x²) is below 1.5·10⁻⁷.
///
/// Hastings 1955, "Approximations for Digital Computers", sheet 43.
pub(super) fn scaled_erfc(x: f64) -> f64 {
    const COEFFICIENTS: [f64; 5] = [
        0.254_829_592,
        -0.284_496_736,
        1.421_413_741,
        -1.453_152_027,
        1.061_405_429,
    ];
    let t = 1.0 / (1.0 + 0.327_591_1 * x);
    COEFFICIENTS.iter().rev().fold(0.0, |sum, c| (sum + c) * t)
}

/// The standard error integral's complement ½·erfc(−x) = ½(1 + erf x), given exp(−x²).
pub(super) fn half_erfc_of_minus(x: f64, exp_minus_x2: f64) -> f64 {
    let tail = 0.5 * exp_minus_x2 * scaled_erfc(x.abs());
    if x < 0.0 { tail } else { 1.0 - tail }
}

/// The x in (−6, 6) with erf x = `y` for y in (−1, 1), to about 10⁻⁶.
///
/// A start from the two-term expression of Winitzki 2008, "A Handy Approximation for the Error
/// Function and Its Inverse", then Newton's method.
pub(super) fn inverse_erf(y: f64) -> f64 {
    const A: f64 = 0.147;
    let log = ((1.0 - y) * (1.0 + y)).max(f64::MIN_POSITIVE).ln();
    let term = 2.0 / (std::f64::consts::PI * A) + 0.5 * log;
    let start = ((term * term - log / A).sqrt() - term).max(0.0).sqrt();
    let mut x = start.min(6.0);
    let tail = 1.0 - y.abs();
    for _ in 0..2 {
        let gauss = (-x * x).exp();
        let error = tail - gauss * scaled_erfc(x);
        x -= error * 0.5 * std::f64::consts::PI.sqrt() / gauss.max(1e-30);
        x = x.clamp(0.0, 6.0);
    }
    x.copysign(y)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// erf by its power series, in f64.
    fn series(x: f64) -> f64 {
        let (mut term, mut sum) = (x, x);
        for n in 1..200 {
            term *= -x * x / f64::from(n);
            sum += term / f64::from(2 * n + 1);
        }
        2.0 / std::f64::consts::PI.sqrt() * sum
    }

    #[test]
    fn the_error_function_matches_its_series() {
        for i in -300..=300 {
            let x = f64::from(i) / 100.0;
            let ours = 2.0 * half_erfc_of_minus(x, (-x * x).exp()) - 1.0;
            assert!((ours - series(x)).abs() < 2e-7, "{x}");
        }
    }

    #[test]
    fn the_inverse_inverts() {
        for i in -999..=999 {
            let y = f64::from(i) / 1000.0;
            assert!((series(inverse_erf(y)) - y).abs() < 1e-6, "{y}");
        }
        let last = inverse_erf(1.0 - 1.0 / 16_777_216.0);
        assert!((3.7..4.0).contains(&last), "{last}");
        assert_eq!(inverse_erf(0.0), 0.0);
    }
}
