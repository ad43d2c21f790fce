//! Welch's test over the blocks of several pictures.

use crate::support::measure::Estimate;

/// Probability of a false alarm for a whole family of comparisons.
const SIGNIFICANCE: f64 = 0.01;

/// Differences smaller than this, relative to the larger mean, are rounding.
const ROUNDING: f64 = 2e-5;

/// One estimate of a picture: a name and its blocks.
pub(crate) type Picture = (String, Vec<Estimate>);

/// Compares every pair of `pictures`, block by block and as a whole, all channels; panics with
/// every difference that chance does not explain (Bonferroni over all comparisons).
pub(crate) fn assert_same_picture(scene: &str, pictures: &[Picture]) {
    let pairs: Vec<(&Picture, &Picture)> = pictures
        .iter()
        .enumerate()
        .flat_map(|(i, a)| pictures[i + 1..].iter().map(move |b| (a, b)))
        .collect();
    let comparisons = pairs.len() * (pictures[0].1.len() + 1) * 3;
    let limit = two_sided_quantile(SIGNIFICANCE / comparisons as f64);
    let mut complaints = Vec::new();
    for (a, b) in pairs {
        for (place, x, y) in places(&a.1, &b.1) {
            for c in 0..3 {
                let z = normal_score(&x, &y, c);
                if z.abs() > limit {
                    complaints.push(format!(
                        "{} against {}, {place}, channel {c}: {} and {}, {z:.1} standard errors",
                        a.0,
                        b.0,
                        x.mean(c),
                        y.mean(c)
                    ));
                }
            }
        }
    }
    assert!(
        complaints.is_empty(),
        "{scene} (limit {limit:.2}):\n{}",
        complaints.join("\n")
    );
}

/// The blocks side by side, and the mean of the whole picture.
fn places(a: &[Estimate], b: &[Estimate]) -> Vec<(String, Estimate, Estimate)> {
    let (largest_a, largest_b) = (largest(a), largest(b));
    a.iter()
        .zip(b)
        .enumerate()
        .map(|(i, (x, y))| {
            let (x, y) = (with_largest(x, largest_a), with_largest(y, largest_b));
            (format!("block {i}"), x, y)
        })
        .chain([("the whole picture".to_owned(), mean_of(a), mean_of(b))])
        .collect()
}

fn largest(blocks: &[Estimate]) -> f64 {
    blocks.iter().map(|b| b.largest).fold(0.0, f64::max)
}

fn with_largest(estimate: &Estimate, largest: f64) -> Estimate {
    Estimate {
        largest,
        ..*estimate
    }
}

/// The mean of independent estimates with the same number of samples, with the variance inside the
/// blocks only, as a stratified estimate has it.
pub(crate) fn mean_of(blocks: &[Estimate]) -> Estimate {
    let count = blocks.len() as f64;
    combine(blocks, 1.0 / count)
}

/// The sum of independent estimates with the same number of samples.
pub(crate) fn sum_of(parts: &[Estimate]) -> Estimate {
    combine(parts, 1.0)
}

fn combine(parts: &[Estimate], factor: f64) -> Estimate {
    let n = parts[0].n;
    let mut total = Estimate {
        n,
        largest: factor * largest(parts),
        ..Estimate::default()
    };
    for c in 0..3 {
        let mean = factor * parts.iter().map(|p| p.mean(c)).sum::<f64>();
        let error: f64 = parts
            .iter()
            .map(|p| (factor * p.standard_error(c)).powi(2))
            .sum();
        total.sum[c] = mean * n;
        total.sum_of_squares[c] = (error * (n - 1.0) + mean * mean) * n;
    }
    total
}

/// Welch's t of two means as a normal score: t is mapped by Abramowitz and Stegun 1964, 26.7.8,
/// with the degrees of freedom of Welch and Satterthwaite. A block that by chance never saw the
/// rare samples of its picture knows nothing of their variance, so one such sample is added.
fn normal_score(a: &Estimate, b: &Estimate, c: usize) -> f64 {
    let difference = a.mean(c) - b.mean(c);
    if difference.abs() <= ROUNDING * a.mean(c).abs().max(b.mean(c).abs()) {
        return 0.0;
    }
    let squared_error = |e: &Estimate| e.standard_error(c).powi(2) + (e.largest / e.n).powi(2);
    let (va, vb) = (squared_error(a), squared_error(b));
    if va + vb == 0.0 {
        return f64::INFINITY;
    }
    let t = difference / (va + vb).sqrt();
    let freedom = (va + vb).powi(2) / (va * va / (a.n - 1.0) + vb * vb / (b.n - 1.0));
    t * (1.0 - 0.25 / freedom) / (1.0 + t * t / (2.0 * freedom)).sqrt()
}

/// The score that |z| exceeds with probability `p`, for p well below 1.
fn two_sided_quantile(p: f64) -> f64 {
    let (mut low, mut high) = (1.5, 12.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if 2.0 * upper_tail(middle) > p {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// P(Z > z) by Laplace's continued fraction, for z above 1.5.
fn upper_tail(z: f64) -> f64 {
    let fraction = (1..=200).rev().fold(z, |f, k| z + f64::from(k) / f);
    (-0.5 * z * z).exp() / ((2.0 * std::f64::consts::PI).sqrt() * fraction)
}

fn estimate(mean: f64, error: f64, n: f64) -> Estimate {
    Estimate {
        n,
        sum: [mean * n; 3],
        sum_of_squares: [(error * error * (n - 1.0) + mean * mean) * n; 3],
        largest: 10.0 * mean,
    }
}

#[test]
fn the_quantile_is_the_known_one() {
    assert!((two_sided_quantile(0.01) - 2.575_829).abs() < 1e-5);
    assert!((two_sided_quantile(1e-6) - 4.891_638).abs() < 1e-5);
}

#[test]
fn a_biased_block_is_found_and_chance_is_not() {
    let right = vec![estimate(1.0, 0.01, 4000.0); 64];
    let mut near = right.clone();
    near[7] = estimate(1.03, 0.01, 4000.0);
    let mut far = right.clone();
    far[7] = estimate(1.1, 0.01, 4000.0);
    let picture = |name: &str, blocks: &[Estimate]| (name.to_owned(), blocks.to_vec());
    assert_same_picture("chance", &[picture("a", &right), picture("b", &near)]);
    let found = std::panic::catch_unwind(|| {
        assert_same_picture("bias", &[picture("a", &right), picture("b", &far)]);
    });
    assert!(found.is_err());
    // Ten standard errors of the whole picture, one of each block.
    let all = vec![estimate(1.01, 0.01, 4000.0); 64];
    let found = std::panic::catch_unwind(|| {
        assert_same_picture("bias", &[picture("a", &right), picture("b", &all)]);
    });
    assert!(found.is_err());
}
