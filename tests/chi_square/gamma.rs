/// The chance that a chi-square variable of `freedom` degrees of freedom is above `statistic`.
pub(crate) fn chi_square_tail(statistic: f64, freedom: f64) -> f64 {
    upper_incomplete_gamma(0.5 * freedom, 0.5 * statistic)
}

/// The regularised upper incomplete gamma function Q(a, x) for a > 0, x ≥ 0.
///
/// The power series of the lower function below a + 1, Legendre's continued fraction above
/// (Abramowitz and Stegun 1964, "Handbook of Mathematical Functions", 6.5.29 and 6.5.31).
fn upper_incomplete_gamma(a: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    let scale = (a * x.ln() - x - ln_gamma(a)).exp();
    if x < a + 1.0 {
        let (mut term, mut sum, mut n) = (1.0 / a, 1.0 / a, a);
        while term > sum * 1e-16 {
            n += 1.0;
            term *= x / n;
            sum += term;
        }
        return 1.0 - scale * sum;
    }
    // From the tail inwards; the number of steps needed falls with the distance from x = a.
    let steps = 200 + (20.0 * a.sqrt()) as u32;
    let mut fraction = 0.0;
    for k in (1..=steps).rev().map(f64::from) {
        fraction = k * (a - k) / (x - a + 1.0 + 2.0 * k + fraction);
    }
    scale / (x - a + 1.0 + fraction)
}

/// ln Γ(x) for x > 0: Stirling's series after stepping up to 12.
fn ln_gamma(x: f64) -> f64 {
    let (mut x, mut below) = (x, 0.0);
    while x < 12.0 {
        below += x.ln();
        x += 1.0;
    }
    let inverse2 = 1.0 / (x * x);
    let series = (1.0 / 12.0 - inverse2 * (1.0 / 360.0 - inverse2 / 1260.0)) / x;
    (x - 0.5) * x.ln() - x + 0.5 * std::f64::consts::TAU.ln() + series - below
}

#[test]
fn quantiles_are_those_of_the_tables() {
    for (freedom, quantile) in [(1.0, 3.841_459), (10.0, 18.307_04), (100.0, 124.342_1)] {
        let tail = chi_square_tail(quantile, freedom);
        assert!((tail - 0.05).abs() < 1e-6, "{freedom}: {tail}");
    }
    assert!((chi_square_tail(30.143_53, 19.0) - 0.05).abs() < 1e-6);
    for statistic in [0.1, 1.0, 5.0, 40.0, 700.0] {
        let exact = (-0.5_f64 * statistic).exp();
        assert!((chi_square_tail(statistic, 2.0) / exact - 1.0).abs() < 1e-9);
    }
    // At the mean of many degrees of freedom: Q(a, a) = 1/2 - 1/(3 sqrt(2 pi a)).
    let middle = chi_square_tail(2000.0, 2000.0);
    let expected = 0.5 - 1.0 / (3.0 * (std::f64::consts::TAU * 1000.0).sqrt());
    assert!((middle - expected).abs() < 1e-5, "{middle}");
    assert!(chi_square_tail(2300.0, 2000.0) < 1e-5);
}
