use std::f64::consts::{FRAC_2_SQRT_PI, PI};

/// The error function and its complement, to a few roundings.
///
/// Abramowitz and Stegun 1964, "Handbook of Mathematical Functions", 7.1.6 (series) and 7.1.14
/// (continued fraction).
pub(super) fn erf_and_erfc(x: f64) -> (f64, f64) {
    if x < 0.0 {
        let (erf, erfc) = erf_and_erfc(-x);
        return (-erf, 2.0 - erfc);
    }
    if x < 2.0 {
        let (mut term, mut sum) = (x, x);
        for n in 1..60 {
            term *= 2.0 * x * x / f64::from(2 * n + 1);
            sum += term;
        }
        let erf = FRAC_2_SQRT_PI * (-x * x).exp() * sum;
        return (erf, 1.0 - erf);
    }
    let fraction = (1..=120)
        .rev()
        .fold(x, |below, n| x + 0.5 * f64::from(n) / below);
    let erfc = (-x * x).exp() / (PI.sqrt() * fraction);
    (1.0 - erfc, erfc)
}

/// The root of the rising function `f` between `low` and `high`, by bisection.
pub(super) fn bisect(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if f(middle) > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Abramowitz and Stegun 1964, tables 7.1 and 7.3.
    #[test]
    fn values_are_those_of_the_tables() {
        let table = [
            (0.0, 1.0),
            (0.5, 0.479_500_122_186_953_5),
            (1.0, 0.157_299_207_050_285_13),
            (1.9999, 0.004_679_802_081_5),
            (2.0, 0.004_677_734_981_047_266),
            (3.0, 2.209_049_699_858_544e-5),
            (5.0, 1.537_459_794_428_035e-12),
        ];
        for (x, erfc) in table {
            let (ours_erf, ours_erfc) = erf_and_erfc(x);
            assert!((ours_erfc / erfc - 1.0).abs() < 1e-6, "{x}: {ours_erfc}");
            assert!((ours_erf + ours_erfc - 1.0).abs() < 1e-15);
            assert!((erf_and_erfc(-x).0 + ours_erf).abs() < 1e-15);
        }
        assert!((erf_and_erfc(1.0).1 - table[2].1).abs() < 1e-14);
        assert!((bisect(0.0, 2.0, |x| x * x - 2.0) - 2.0_f64.sqrt()).abs() < 1e-14);
    }
}
