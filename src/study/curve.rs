use serde::Serialize;

use super::bootstrap::bootstrap_interval;
use super::power_law::{PowerLaw, WeightedPoint};
use super::quantile::{median, student_975};
use crate::image::Score;

/// Variance of ln(error) below which no point is believed: curves are not exactly straight.
const LEAST_VARIANCE: f64 = 1e-4;
/// Relative spread of a single run that is assumed where there is only one.
const ASSUMED_SPREAD: f64 = 0.1;

/// One seed's picture after some samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Run {
    /// Seed of its random numbers.
    pub seed: u64,
    /// Samples in each pixel.
    pub samples_per_pixel: u32,
    /// Its errors, less those of the reference.
    pub score: Score,
    /// Processor seconds of all workers for all its samples.
    pub cpu_seconds: f64,
    /// Seconds on the wall.
    pub wall_seconds: f64,
    /// Rays of all kinds.
    pub rays: u64,
    /// Paths.
    pub samples: u64,
}

/// All runs of one method after the same number of samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// Samples in each pixel.
    pub samples_per_pixel: u32,
    /// At least one, in the order in which they were made.
    pub runs: Vec<Run>,
}

/// What a [`Level`] says.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LevelFigures {
    /// Samples in each pixel.
    pub samples_per_pixel: u32,
    /// Number of runs.
    pub seeds: usize,
    /// Median of the runs.
    pub cpu_seconds: f64,
    /// Median of the runs.
    pub wall_seconds: f64,
    /// Mean of the runs.
    pub rays: f64,
    /// Mean of the runs.
    pub samples: f64,
    /// Mean of the runs.
    pub rel_mse: f64,
    /// Mean of the runs, each without the worst 0.1 % of its pixels.
    pub rel_mse_trimmed: f64,
    /// Mean of the runs.
    pub mse: f64,
    /// Brightness of the picture against that of the reference, mean of the runs.
    pub mean_ratio: f64,
    /// Its 95 % interval by the spread of the runs; `None` for a single run. It does not hold the
    /// reference's own error.
    pub mean_ratio_interval: Option<[f64; 2]>,
    /// 1 / (relMSE · processor seconds); `None` where the error is below that of the reference.
    pub efficiency: Option<f64>,
    /// Its 95 % interval; see [`bootstrap_interval`].
    pub efficiency_interval: Option<[f64; 2]>,
}

impl Level {
    /// 1 / (mean relMSE · median processor seconds) of the runs numbered `drawn`; NaN where the
    /// error is not above 0.
    pub(super) fn efficiency(&self, drawn: &[usize]) -> f64 {
        let of = |i: &usize| &self.runs[*i];
        let error = drawn.iter().map(|i| of(i).score.rel_mse).sum::<f64>() / drawn.len() as f64;
        let seconds = median(drawn.iter().map(|i| of(i).cpu_seconds));
        let efficiency = 1.0 / (error * seconds);
        if error > 0.0 { efficiency } else { f64::NAN }
    }

    fn mean(&self, figure: impl Fn(&Run) -> f64) -> f64 {
        self.runs.iter().map(figure).sum::<f64>() / self.runs.len() as f64
    }

    /// Variance of the mean of `figure`; `None` for a single run.
    fn variance_of_mean(&self, figure: impl Fn(&Run) -> f64) -> Option<f64> {
        let (n, mean) = (self.runs.len(), self.mean(&figure));
        let sum: f64 = self.runs.iter().map(|r| (figure(r) - mean).powi(2)).sum();
        (n > 1).then(|| sum / (n - 1) as f64 / n as f64)
    }

    /// The figures of the level.
    pub fn figures(&self) -> LevelFigures {
        let n = self.runs.len();
        let all: Vec<usize> = (0..n).collect();
        let mean_ratio = self.mean(|r| r.score.mean_ratio);
        let half_width = self
            .variance_of_mean(|r| r.score.mean_ratio)
            .map(|variance| student_975(n - 1) * variance.sqrt());
        let efficiency = self.efficiency(&all);
        LevelFigures {
            samples_per_pixel: self.samples_per_pixel,
            seeds: n,
            cpu_seconds: median(self.runs.iter().map(|r| r.cpu_seconds)),
            wall_seconds: median(self.runs.iter().map(|r| r.wall_seconds)),
            rays: self.mean(|r| r.rays as f64),
            samples: self.mean(|r| r.samples as f64),
            rel_mse: self.mean(|r| r.score.rel_mse),
            rel_mse_trimmed: self.mean(|r| r.score.rel_mse_trimmed),
            mse: self.mean(|r| r.score.mse),
            mean_ratio,
            mean_ratio_interval: half_width.map(|w| [mean_ratio - w, mean_ratio + w]),
            efficiency: efficiency.is_finite().then_some(efficiency),
            efficiency_interval: bootstrap_interval(n, |drawn| self.efficiency(drawn)),
        }
    }
}

/// One method's error against its time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// By ascending number of samples.
    pub levels: Vec<Level>,
}

impl Curve {
    /// Sorts `run` into its level.
    pub fn add(&mut self, run: Run) {
        let samples = run.samples_per_pixel;
        match self
            .levels
            .binary_search_by_key(&samples, |level| level.samples_per_pixel)
        {
            Ok(at) => self.levels[at].runs.push(run),
            Err(at) => self.levels.insert(
                at,
                Level {
                    samples_per_pixel: samples,
                    runs: vec![run],
                },
            ),
        }
    }

    /// The power law of relMSE against processor seconds. Its error comes from leaving out one seed
    /// after the other (Tukey 1958, the jackknife), for the levels of a run share samples; with
    /// fewer than three seeds from the scatter about the line.
    pub fn power_law(&self) -> Option<PowerLaw> {
        let mut law = self.power_law_without(None)?;
        let mut seeds: Vec<u64> = self.runs().map(|run| run.seed).collect();
        seeds.sort_unstable();
        seeds.dedup();
        let slopes: Option<Vec<f64>> = seeds
            .iter()
            .map(|&seed| Some(self.power_law_without(Some(seed))?.slope))
            .collect();
        if let Some(slopes) = slopes.filter(|slopes| slopes.len() >= 3) {
            let n = slopes.len() as f64;
            let mean = slopes.iter().sum::<f64>() / n;
            let squares: f64 = slopes.iter().map(|s| (s - mean).powi(2)).sum();
            law.slope_error = Some(((n - 1.0) / n * squares).sqrt());
        }
        Some(law)
    }

    fn runs(&self) -> impl Iterator<Item = &Run> {
        self.levels.iter().flat_map(|level| &level.runs)
    }

    fn power_law_without(&self, seed: Option<u64>) -> Option<PowerLaw> {
        let levels: Vec<Level> = self
            .levels
            .iter()
            .map(|level| Level {
                samples_per_pixel: level.samples_per_pixel,
                runs: level
                    .runs
                    .iter()
                    .filter(|run| Some(run.seed) != seed)
                    .copied()
                    .collect(),
            })
            .filter(|level| !level.runs.is_empty())
            .collect();
        PowerLaw::fit(&points(&levels))
    }

    /// The smallest and the largest mean relMSE; `None` when none is above 0.
    pub fn measured_errors(&self) -> Option<(f64, f64)> {
        let errors = self
            .levels
            .iter()
            .map(|level| level.mean(|r| r.score.rel_mse));
        let positive: Vec<f64> = errors.filter(|&error| error > 0.0).collect();
        let least = positive.iter().copied().reduce(f64::min)?;
        Some((least, positive.iter().copied().fold(least, f64::max)))
    }
}

/// The levels as points, each variance half its own and half that of all: few runs tell their
/// spread badly.
fn points(levels: &[Level]) -> Vec<WeightedPoint> {
    let relative = |level: &Level| {
        let mean = level.mean(|r| r.score.rel_mse);
        let single = level.variance_of_mean(|r| r.score.rel_mse)? * level.runs.len() as f64;
        Some(single / (mean * mean))
    };
    let known: Vec<f64> = levels.iter().filter_map(relative).collect();
    let pooled = match known.len() {
        0 => ASSUMED_SPREAD * ASSUMED_SPREAD,
        n => known.iter().sum::<f64>() / n as f64,
    };
    levels
        .iter()
        .map(|level| {
            let own = relative(level).unwrap_or(pooled);
            WeightedPoint {
                x: median(level.runs.iter().map(|r| r.cpu_seconds)),
                y: level.mean(|r| r.score.rel_mse),
                variance: 0.5 * (own + pooled) / level.runs.len() as f64 + LEAST_VARIANCE,
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::bootstrap::SplitMix;
    use super::super::synthetic::synthetic;

    #[test]
    fn the_slope_of_accumulated_pictures_is_found_within_its_error() {
        let mut random = SplitMix(11);
        let (mut off, mut told) = (0.0, 0.0);
        for _ in 0..60 {
            let curve = synthetic((0.25, 0.8, -1.2), (6, 0.1), &mut random);
            let law = curve.power_law().unwrap();
            off += (law.slope + 1.2).powi(2);
            told += law.slope_error.unwrap().powi(2);
        }
        let (deviation, told) = ((off / 60.0_f64).sqrt(), (told / 60.0_f64).sqrt());
        assert!(deviation < 0.03, "{deviation}");
        assert!(
            (0.6..1.7).contains(&(told / deviation)),
            "{told} {deviation}"
        );
    }

    #[test]
    fn figures_of_a_level_follow_their_definitions() {
        let curve = synthetic((0.5, 0.2, -1.0), (8, 0.05), &mut SplitMix(2));
        assert_eq!(curve.levels.len(), 7);
        let figures = curve.levels[4].figures();
        assert_eq!((figures.samples_per_pixel, figures.seeds), (16, 8));
        assert_eq!((figures.samples, figures.rays), (16.0, 48.0));
        assert!((figures.rel_mse_trimmed / figures.rel_mse - 0.9).abs() < 1e-9);
        let expected = 1.0 / (figures.rel_mse * figures.cpu_seconds);
        assert!((figures.efficiency.unwrap() / expected - 1.0).abs() < 1e-9);
        let [low, high] = figures.efficiency_interval.unwrap();
        assert!(low < expected && expected < high && high / low < 1.3);
        let [low, high] = figures.mean_ratio_interval.unwrap();
        assert!(low < 1.0 && 1.0 < high && high - low < 0.05);
        let (least, most) = curve.measured_errors().unwrap();
        assert!((least * 64.0 / most - 1.0).abs() < 0.2);
    }

    #[test]
    fn a_single_run_has_figures_but_no_intervals() {
        let curve = synthetic((0.5, 0.2, -1.0), (1, 0.0), &mut SplitMix(2));
        let figures = curve.levels[0].figures();
        assert_eq!(figures.mean_ratio_interval, None);
        assert_eq!(figures.efficiency_interval, None);
        assert!(figures.efficiency.is_some());
        let law = curve.power_law().unwrap();
        assert!((law.slope + 1.0).abs() < 0.05 && law.slope_error.unwrap() > 0.0);
    }

    #[test]
    fn errors_below_the_reference_have_no_efficiency_and_leave_the_fit_alone() {
        let mut curve = synthetic((0.5, 0.2, -1.0), (5, 0.02), &mut SplitMix(4));
        for run in &mut curve.levels[6].runs {
            run.score.rel_mse = -1e-6;
        }
        let figures = curve.levels[6].figures();
        assert_eq!(
            (figures.efficiency, figures.efficiency_interval),
            (None, None)
        );
        assert!((curve.power_law().unwrap().slope + 1.0).abs() < 0.05);
    }
}
