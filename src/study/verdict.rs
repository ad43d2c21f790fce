use serde::Serialize;

use super::bootstrap::bootstrap_interval;
use super::curve::{Curve, Level};

/// What a comparison has shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// More efficient.
    Better,
    /// Less efficient.
    Worse,
    /// The interval holds 1, or there are too few runs for one.
    NoDifferenceShown,
}

/// The efficiency of one method against that of another after the same number of samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// Samples in each pixel, the most that both have.
    pub samples_per_pixel: u32,
    /// How many times as efficient: the other would need that many times the processor seconds for
    /// the same error, if its error falls as one over time.
    pub ratio: f64,
    /// Its 95 % interval; `None` for too few runs.
    pub interval: Option<[f64; 2]>,
    /// What follows.
    pub outcome: Outcome,
}

impl Verdict {
    /// `ours` against `other`, runs of which that have the same place were made side by side.
    /// `None` when they share no level or an error is below that of the reference.
    pub fn between(ours: &Curve, other: &Curve) -> Option<Self> {
        let (ours, other) = last_common(ours, other)?;
        let runs = ours.runs.len().min(other.runs.len());
        let ratio = |drawn: &[usize]| ours.efficiency(drawn) / other.efficiency(drawn);
        let all: Vec<usize> = (0..runs).collect();
        let point = ratio(&all);
        let interval = bootstrap_interval(runs, ratio);
        let outcome = match interval {
            Some([low, _]) if low > 1.0 => Outcome::Better,
            Some([_, high]) if high < 1.0 => Outcome::Worse,
            _ => Outcome::NoDifferenceShown,
        };
        point.is_finite().then_some(Self {
            samples_per_pixel: ours.samples_per_pixel,
            ratio: point,
            interval,
            outcome,
        })
    }
}

fn last_common<'a>(ours: &'a Curve, other: &'a Curve) -> Option<(&'a Level, &'a Level)> {
    ours.levels.iter().rev().find_map(|level| {
        let same = |o: &&Level| o.samples_per_pixel == level.samples_per_pixel;
        Some((level, other.levels.iter().find(same)?))
    })
}

#[cfg(test)]
mod tests {
    use super::super::bootstrap::SplitMix;
    use super::super::synthetic::synthetic;
    use super::*;

    #[test]
    fn what_is_twice_as_efficient_is_found_to_be_so() {
        let mut random = SplitMix(5);
        let ours = synthetic((0.3, 0.1, -1.0), (6, 0.05), &mut random);
        let other = synthetic((0.2, 0.3, -1.0), (6, 0.05), &mut random);
        let verdict = Verdict::between(&ours, &other).unwrap();
        assert_eq!(
            (verdict.samples_per_pixel, verdict.outcome),
            (64, Outcome::Better)
        );
        assert!((verdict.ratio / 2.0 - 1.0).abs() < 0.2, "{}", verdict.ratio);
        let back = Verdict::between(&other, &ours).unwrap();
        assert_eq!(back.outcome, Outcome::Worse);
        assert!((back.ratio * verdict.ratio - 1.0).abs() < 1e-9);
    }

    #[test]
    fn equals_are_told_apart_in_one_of_twenty_cases_only() {
        let mut random = SplitMix(6);
        let found = (0..200)
            .filter(|_| {
                let [a, b] = [(); 2].map(|()| synthetic((0.2, 0.3, -1.0), (5, 0.1), &mut random));
                Verdict::between(&a, &b).unwrap().outcome != Outcome::NoDifferenceShown
            })
            .count();
        assert!((1..=24).contains(&found), "{found}");
    }

    #[test]
    fn few_runs_show_nothing_and_nothing_shared_is_no_verdict() {
        let mut random = SplitMix(7);
        let ours = synthetic((0.3, 0.1, -1.0), (3, 0.01), &mut random);
        let other = synthetic((0.3, 0.9, -1.0), (3, 0.01), &mut random);
        let verdict = Verdict::between(&ours, &other).unwrap();
        assert_eq!(
            (verdict.interval, verdict.outcome),
            (None, Outcome::NoDifferenceShown)
        );
        assert_eq!(Verdict::between(&ours, &Curve::default()), None);
    }
}
