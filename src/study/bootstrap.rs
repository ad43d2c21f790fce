use super::quantile::{normal_tail, quantile, student_975};

/// Runs below which there is no interval: it would be too short to be told.
pub const FEWEST_RUNS: usize = 5;
/// Times that the runs are drawn anew.
const DRAWS: usize = 4000;

/// A 95 % interval of a statistic of `runs` independent runs: the runs are drawn anew with
/// repetition many times, and `statistic` sees the numbers of those drawn. `None` below
/// [`FEWEST_RUNS`] runs, or when some statistic is not finite. The same runs always give the same
/// interval.
///
/// The percentile interval, widened as Student's is against the normal, for with few runs it is too
/// short: Hesterberg 2015, "What Teachers Should Know About the Bootstrap", section 5.3.
pub fn bootstrap_interval(runs: usize, statistic: impl Fn(&[usize]) -> f64) -> Option<[f64; 2]> {
    if runs < FEWEST_RUNS {
        return None;
    }
    let mut random = SplitMix(runs as u64);
    let mut drawn = vec![0; runs];
    let mut statistics: Vec<f64> = (0..DRAWS)
        .map(|_| {
            drawn.fill_with(|| random.below(runs));
            statistic(&drawn)
        })
        .collect();
    if !statistics.iter().all(|value| value.is_finite()) {
        return None;
    }
    statistics.sort_unstable_by(f64::total_cmp);
    let n = runs as f64;
    let tail = normal_tail((n / (n - 1.0)).sqrt() * student_975(runs - 1));
    Some([tail, 1.0 - tail].map(|p| quantile(&statistics, p)))
}

/// Random numbers of Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom Number Generators".
#[derive(Debug)]
pub(super) struct SplitMix(pub(super) u64);

impl SplitMix {
    pub(super) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    fn below(&mut self, end: usize) -> usize {
        ((u128::from(self.next()) * end as u128) >> 64) as usize
    }

    /// A number of the standard normal distribution: Box and Muller 1958.
    #[cfg(test)]
    pub(super) fn normal(&mut self) -> f64 {
        let [a, b] = [(); 2].map(|()| ((self.next() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64);
        (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Share of experiments whose interval holds the truth.
    fn coverage(runs: usize, truth: f64, value: impl Fn(&mut SplitMix) -> f64) -> f64 {
        let mut random = SplitMix(7);
        let experiments = 400;
        let hits = (0..experiments)
            .filter(|_| {
                let values: Vec<f64> = (0..runs).map(|_| value(&mut random)).collect();
                let mean =
                    |drawn: &[usize]| drawn.iter().map(|&i| values[i]).sum::<f64>() / runs as f64;
                let [low, high] = bootstrap_interval(runs, mean).unwrap();
                low <= truth && truth <= high
            })
            .count();
        hits as f64 / f64::from(experiments)
    }

    #[test]
    fn intervals_hold_the_truth_in_nineteen_of_twenty_experiments() {
        for runs in [5, 8, 16] {
            let normal = coverage(runs, 3.0, |random| 3.0 + 0.2 * random.normal());
            assert!((0.91..0.98).contains(&normal), "{runs}: {normal}");
            // As skewed as the errors of a noisy picture.
            let truth = (0.5 * 0.3_f64.powi(2)).exp();
            let skewed = coverage(runs, truth, |random| (0.3 * random.normal()).exp());
            assert!((0.89..0.98).contains(&skewed), "{runs}: {skewed}");
        }
    }

    #[test]
    fn too_few_runs_have_no_interval() {
        assert_eq!(bootstrap_interval(4, |_| 1.0), None);
        assert_eq!(bootstrap_interval(5, |_| 1.0), Some([1.0, 1.0]));
        assert_eq!(bootstrap_interval(5, |_| f64::NAN), None);
    }
}
