//! Runs with a known power law and spread, to test what is made of them.

use super::bootstrap::SplitMix;
use super::{Curve, Run};
use crate::image::Score;

/// Runs of a method that costs `seconds` a sample and has error `error` after one, by x^slope,
/// as accumulated pictures do: what a seed lacks or has too much stays.
pub(super) fn synthetic(
    (seconds, error, slope): (f64, f64, f64),
    (seeds, spread): (u64, f64),
    random: &mut SplitMix,
) -> Curve {
    let mut curve = Curve::default();
    for seed in 0..seeds {
        let own = (spread * random.normal()).exp();
        for k in 0..7 {
            let samples_per_pixel = 1 << k;
            let n = f64::from(samples_per_pixel);
            let luck = own * (0.3 * spread * random.normal()).exp();
            let rel_mse = error * n.powf(slope) * luck;
            let score = Score {
                rel_mse,
                rel_mse_trimmed: 0.9 * rel_mse,
                mse: rel_mse,
                mean_ratio: 1.0 + 0.01 * random.normal(),
            };
            curve.add(Run {
                seed,
                samples_per_pixel,
                score,
                cpu_seconds: seconds * n * (1.0 + 0.02 * random.normal()),
                wall_seconds: seconds * n,
                rays: 3 * u64::from(samples_per_pixel),
                samples: u64::from(samples_per_pixel),
            });
        }
    }
    curve
}
