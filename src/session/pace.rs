//! How much to do before looking up again: pure decisions, no clock.

use crate::settings::RenderSettings;

/// Time for the coarse first look, seconds.
const PREVIEW_BUDGET: f64 = 0.008;
/// Coarsest preview: one path for a square of this many pixels a side.
pub(super) const MAX_PREVIEW_STEP: u32 = 32;
/// Steps that are tried, finest first.
const PREVIEW_STEPS: [u32; 5] = [2, 4, 8, 16, MAX_PREVIEW_STEP];
/// A first full pass that takes longer than this, in seconds, is preceded by a finer look.
const FINER_LOOK_FROM: f64 = 0.2;
/// Aimed length of a pass in seconds: long enough that passes cost nothing, short enough that
/// stop rules are kept.
const PASS_AIM: f64 = 0.25;
/// Most samples per pixel that one pass adds.
const MOST_PER_PASS: u32 = 256;
/// The ETA shows after this many seconds, when the rates have settled.
const ETA_AFTER: f64 = 1.5;

/// The edge of the squares that a preview of `pixels` pixels may have at `rate` paths per second.
pub(super) fn preview_step(pixels: f64, rate: f64) -> u32 {
    PREVIEW_STEPS
        .into_iter()
        .find(|&step| pixels / f64::from(step * step) / rate.max(1.0) <= PREVIEW_BUDGET)
        .unwrap_or(MAX_PREVIEW_STEP)
}

/// The edge of the squares of a second, finer look after one of `shown`; `None` when the first full
/// pass is about as quick or the look would be no finer.
pub(super) fn finer_step(pixels: f64, rate: f64, shown: u32) -> Option<u32> {
    let step = (shown / 4).max(2);
    (step < shown && pixels / rate.max(1.0) > FINER_LOOK_FROM).then_some(step)
}

/// The number of samples per pixel at which the next pass ends.
///
/// `done` is what every open pixel has, `bound` the number that must not be passed, `last` the samples
/// and seconds of the last pass. With `seconds_left` until a time limit the pass is made to fit, so
/// that it need not be cut: then all pixels end with the same number of samples, and the picture can
/// be made again.
pub(super) fn next_target(
    (done, bound): (u32, u32),
    last: Option<(u32, f64)>,
    seconds_left: Option<f64>,
) -> u32 {
    let step = match last {
        None => 1,
        Some((samples, seconds)) if seconds * 2.0 <= PASS_AIM => {
            (samples * 2).clamp(1, MOST_PER_PASS)
        }
        Some((samples, seconds)) if seconds > PASS_AIM * 1.5 => (samples / 2).max(1),
        Some((samples, _)) => samples.max(1),
    };
    let fitting = last.zip(seconds_left).map(|((samples, seconds), left)| {
        (left / seconds.max(1e-6) * f64::from(samples)).max(1.0) as u32
    });
    let step = step.min(fitting.unwrap_or(u32::MAX));
    done.saturating_add(step).min(bound)
}

/// What [`eta_seconds`] looks at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Progress {
    pub(super) seconds: f64,
    pub(super) samples_mean: f64,
    pub(super) relative_error: Option<f64>,
}

/// Seconds until the first of the stop rules ends the render; `None` without rules and while the
/// figure would jump about.
pub(super) fn eta_seconds(settings: &RenderSettings, progress: &Progress) -> Option<f64> {
    let Progress {
        seconds,
        samples_mean,
        relative_error,
    } = *progress;
    if seconds < ETA_AFTER || samples_mean < 2.0 {
        return None;
    }
    let per_sample = seconds / samples_mean;
    let by_samples = settings
        .stop
        .samples_per_pixel
        .map(|n| (f64::from(n) - samples_mean) * per_sample);
    let by_seconds = settings.stop.seconds.map(|limit| limit - seconds);
    // The error falls with the root of the number of samples.
    let by_error = settings.stop.relative_error.and_then(|aim| {
        let ratio = relative_error? / aim.max(1e-9);
        Some((ratio * ratio - 1.0) * seconds)
    });
    [by_samples, by_seconds, by_error]
        .into_iter()
        .flatten()
        .reduce(f64::min)
        .map(|eta| eta.max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn previews_stay_in_their_budget() {
        assert_eq!(preview_step(1_228_800.0, 1e9), 2);
        let step = preview_step(1_228_800.0, 600_000.0);
        assert!(1_228_800.0 / f64::from(step * step) / 600_000.0 <= PREVIEW_BUDGET);
        assert_eq!(preview_step(1e9, 1.0), MAX_PREVIEW_STEP);
    }

    #[test]
    fn slow_first_passes_are_bridged_by_a_finer_look() {
        assert_eq!(finer_step(1e6, 1e6, 16), Some(4));
        assert_eq!(finer_step(1e6, 1e6, 4), Some(2));
        assert_eq!(finer_step(1e6, 1e6, 2), None);
        assert_eq!(finer_step(1e5, 1e6, 16), None);
    }

    #[test]
    fn passes_grow_to_their_aim_and_never_beyond_their_bound() {
        assert_eq!(next_target((0, 100), None, None), 1);
        assert_eq!(next_target((1, 100), Some((1, 0.001)), None), 3);
        assert_eq!(next_target((8, 100), Some((8, 1.0)), None), 12);
        assert_eq!(next_target((90, 100), Some((64, 0.01)), None), 100);
        assert_eq!(next_target((8, 100), Some((8, 0.1)), Some(0.05)), 12);
        assert_eq!(next_target((8, 100), Some((8, 0.1)), Some(0.0)), 9);
        assert_eq!(next_target((30, 32), Some((64, 0.01)), None), 32);
    }

    #[test]
    fn the_eta_is_hidden_at_first_and_follows_the_first_rule_to_end() {
        let mut settings = RenderSettings::default();
        let progress = Progress {
            seconds: 10.0,
            samples_mean: 50.0,
            relative_error: Some(0.02),
        };
        assert_eq!(eta_seconds(&settings, &progress), None);
        settings.stop.samples_per_pixel = Some(100);
        assert_eq!(eta_seconds(&settings, &progress), Some(10.0));
        settings.stop.relative_error = Some(0.016);
        assert!(eta_seconds(&settings, &progress).is_some_and(|eta| (eta - 5.625).abs() < 1e-9));
        assert_eq!(
            eta_seconds(
                &settings,
                &Progress {
                    seconds: 0.5,
                    ..progress
                }
            ),
            None
        );
    }
}
