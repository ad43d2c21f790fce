//! The error of the running picture against its processor time. While it is off, nothing is
//! computed and there is no thread.

use std::path::PathBuf;
use std::sync::Arc;

use eframe::egui::Context;
use softbox::session::Snapshot;
use softbox::study::{PowerLaw, WeightedPoint};

use super::reference_picture::ReferencePicture;
use super::scorer::{Finding, Scorer};

/// Points closer than this on the axis of time take each other's place.
const STEP: f64 = 1.05;
/// Samples in each pixel from which their spread tells the error; few of them often agree by chance.
const FEWEST_SAMPLES: f64 = 8.0;
/// Points from which a slope is told.
const FEWEST_FOR_SLOPE: usize = 4;

/// One point of the curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CurvePoint {
    /// Processor seconds of the workers.
    pub(super) cpu_seconds: f64,
    /// Error; above 0.
    pub(super) rel_mse: f64,
}

/// The curve of the running picture.
#[derive(Debug, Default)]
pub(super) struct ErrorCurve {
    is_on: bool,
    scorer: Option<Scorer>,
    reference: Option<Arc<ReferencePicture>>,
    /// Why there is no curve against the reference.
    misfit: Option<String>,
    points: Vec<CurvePoint>,
    /// Of the picture that the points belong to.
    generation: u64,
    /// The snapshot that was looked at last.
    last: Option<Arc<Snapshot>>,
    wishes_to_show: bool,
    /// What is typed as the path of a reference.
    pub(super) path: String,
    /// The error to be reached.
    pub(super) target: Option<f64>,
}

impl ErrorCurve {
    /// Begins to watch, or forgets the points and ends the thread.
    pub(super) fn set_on(&mut self, is_on: bool) {
        if self.is_on && !is_on {
            self.scorer = None;
            self.begin_again();
        }
        self.is_on = is_on;
    }

    /// `Some(true)` once after something was asked for that has to be seen.
    pub(super) fn take_wish(&mut self) -> Option<bool> {
        std::mem::take(&mut self.wishes_to_show).then_some(true)
    }

    fn begin_again(&mut self) {
        self.points.clear();
        self.misfit = None;
        self.last = None;
    }

    /// Reads the picture at `path` and holds the running one against it.
    ///
    /// # Errors
    /// One sentence when no thread can be started.
    pub(super) fn read(&mut self, ctx: &Context, path: PathBuf) -> Result<(), String> {
        self.wishes_to_show = true;
        self.scorer(ctx)?.read(path);
        Ok(())
    }

    /// Goes back to the estimate from the samples' own spread.
    pub(super) fn forget_reference(&mut self) {
        self.reference = None;
        self.begin_again();
    }

    fn scorer(&mut self, ctx: &Context) -> Result<&Scorer, String> {
        let scorer = match self.scorer.take() {
            Some(scorer) => scorer,
            None => {
                let wake = ctx.clone();
                Scorer::start(move || wake.request_repaint())
                    .map_err(|error| format!("Cannot start a thread to read pictures: {error}."))?
            }
        };
        Ok(self.scorer.insert(scorer))
    }

    /// Takes note of the picture on the screen, once a frame; `is_held` when it will not get better
    /// by itself. An error is a sentence for the user.
    pub(super) fn follow(
        &mut self,
        ctx: &Context,
        shown: Option<&Arc<Snapshot>>,
        is_held: bool,
    ) -> Result<(), String> {
        let found = self.take_findings();
        let snapshot = shown.filter(|s| self.is_on && self.is_news(s, is_held));
        if let Some(snapshot) = snapshot {
            self.look_at(ctx, snapshot)?;
        }
        found
    }

    /// True when the snapshot is further along by a step, or the last one of its picture.
    fn is_news(&self, snapshot: &Arc<Snapshot>, is_held: bool) -> bool {
        if snapshot.is_preview || snapshot.view.is_first_hit() {
            return false;
        }
        self.last.as_ref().is_none_or(|last| {
            let is_further = snapshot.cpu_seconds >= last.cpu_seconds * STEP;
            let is_other = snapshot.generation != last.generation;
            is_other || (is_further || is_held) && !Arc::ptr_eq(last, snapshot)
        })
    }

    fn look_at(&mut self, ctx: &Context, snapshot: &Arc<Snapshot>) -> Result<(), String> {
        if snapshot.generation != self.generation {
            self.generation = snapshot.generation;
            self.begin_again();
        }
        self.last = Some(Arc::clone(snapshot));
        match self.reference.clone() {
            Some(reference) => self.scorer(ctx)?.score(Arc::clone(snapshot), reference),
            None => {
                let is_enough = snapshot.samples_mean >= FEWEST_SAMPLES;
                if let Some(error) = snapshot.relative_error.filter(|_| is_enough) {
                    self.add(snapshot.cpu_seconds, error * error);
                }
            }
        }
        Ok(())
    }

    fn take_findings(&mut self) -> Result<(), String> {
        let mut failed = Ok(());
        while let Some(finding) = self.scorer.as_ref().and_then(Scorer::take) {
            match finding {
                Finding::Read(Ok(reference)) => {
                    self.begin_again();
                    self.reference = Some(reference);
                }
                Finding::Read(Err(sentence)) => failed = Err(sentence),
                // Of a picture or reference before this one.
                Finding::Scored(snapshot, _)
                    if snapshot.generation != self.generation || self.reference.is_none() => {}
                Finding::Scored(snapshot, Ok(rel_mse)) => self.add(snapshot.cpu_seconds, rel_mse),
                Finding::Scored(_, Err(sentence)) => {
                    self.points.clear();
                    self.misfit = Some(sentence);
                }
            }
        }
        failed
    }

    fn add(&mut self, cpu_seconds: f64, rel_mse: f64) {
        if cpu_seconds <= 0.0 || rel_mse <= 0.0 {
            return;
        }
        if let [.., before, last] = self.points[..]
            && last.cpu_seconds < before.cpu_seconds * STEP
        {
            self.points.pop();
        }
        self.points.push(CurvePoint {
            cpu_seconds,
            rel_mse,
        });
    }

    /// The points, by ascending time.
    pub(super) fn points(&self) -> &[CurvePoint] {
        &self.points
    }

    /// Name of the picture that the running one is held against; `None` for the estimate from the
    /// samples' own spread.
    pub(super) fn reference_name(&self) -> Option<&str> {
        self.reference.as_ref().map(|r| r.name.as_str())
    }

    /// Why the reference cannot be compared with the picture.
    pub(super) fn misfit(&self) -> Option<&str> {
        self.misfit.as_deref()
    }

    /// The straight line through the points, once there are some.
    pub(super) fn power_law(&self) -> Option<PowerLaw> {
        let points: Vec<WeightedPoint> = self
            .points
            .iter()
            .map(|point| WeightedPoint {
                x: point.cpu_seconds,
                y: point.rel_mse,
                variance: 1.0,
            })
            .collect();
        PowerLaw::fit(&points).filter(|_| points.len() >= FEWEST_FOR_SLOPE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_thinned_but_the_last_one_is_always_there() {
        let mut curve = ErrorCurve::default();
        for i in 1..=2000 {
            let seconds = 0.01 * f64::from(i);
            curve.add(seconds, 0.1 / seconds);
        }
        curve.add(0.0, 1.0);
        let points = curve.points();
        assert!((60..200).contains(&points.len()), "{}", points.len());
        assert!(points.is_sorted_by(|a, b| a.cpu_seconds < b.cpu_seconds));
        assert_eq!(points.last().map(|p| p.cpu_seconds), Some(20.0));
        let law = curve.power_law().unwrap();
        assert!((law.slope + 1.0).abs() < 1e-9 && (law.at(1.0) - 0.1).abs() < 1e-9);
    }

    #[test]
    fn turning_it_off_forgets_everything_but_the_wishes() {
        let mut curve = ErrorCurve {
            target: Some(1e-3),
            ..ErrorCurve::default()
        };
        curve.set_on(true);
        curve.add(1.0, 0.5);
        curve.set_on(false);
        assert!(curve.points().is_empty() && curve.scorer.is_none());
        assert_eq!(curve.target, Some(1e-3));
    }
}
