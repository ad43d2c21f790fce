use std::time::Instant;

use softbox::image::CompareError;
use softbox::session::{Exposure, Workbench};
use softbox::settings::RenderSettings;
use softbox::study::{Curve, Reference, Run};

use crate::contender::Contender;

/// How much longer than its limit a measurement may take when the machine slows down on the way.
const PATIENCE: f64 = 1.25;

/// What is measured on one scene.
#[derive(Debug)]
pub(super) struct Plan<'a> {
    pub(super) contenders: &'a [Contender],
    /// The settings that all share.
    pub(super) settings: &'a RenderSettings,
    /// Numbers of samples, ascending.
    pub(super) levels: &'a [u32],
    /// One run of each contender for each.
    pub(super) seeds: &'a [u64],
    /// Seconds on the wall for all runs together.
    pub(super) time_limit: Option<f64>,
}

/// The curve of each contender, in the order of the plan, as far as `stop` let it come. `on_step` is told
/// the fraction that is done.
///
/// # Errors
/// When the reference does not fit.
pub(super) fn measure(
    bench: &Workbench,
    reference: &Reference,
    plan: &Plan<'_>,
    stop: &(dyn Fn() -> bool + Sync),
    on_step: &mut dyn FnMut(f64),
) -> Result<Vec<Curve>, CompareError> {
    let mut curves = vec![Curve::default(); plan.contenders.len()];
    let begin = Instant::now();
    let seeds = plan.seeds.len() as f64;
    let mut levels = plan.levels;
    for (done, &seed) in plan.seeds.iter().enumerate() {
        let elapsed = begin.elapsed().as_secs_f64();
        let mean = elapsed / done.max(1) as f64;
        let is_late = |limit| elapsed + mean > PATIENCE * limit;
        if done > 0 && plan.time_limit.is_some_and(is_late) {
            break;
        }
        // The first seed finds out how far all of them can go.
        let share = plan.time_limit.filter(|_| done == 0).map(|t| t / seeds);
        let mut exposures: Vec<Exposure> = plan
            .contenders
            .iter()
            .map(|c| bench.begin_as(c.mode, c.adaptive(plan.settings), seed))
            .collect();
        let started = Instant::now();
        for (index, &level) in levels.iter().enumerate() {
            if index > 0 && does_not_fit(share, started, (levels[index - 1], level)) {
                levels = &levels[..index];
                break;
            }
            for (exposure, curve) in exposures.iter_mut().zip(&mut curves) {
                if !bench.advance(exposure, level, stop) {
                    return Ok(curves);
                }
                curve.add(run(exposure, reference, seed, level)?);
            }
            let work = |levels: &[u32]| f64::from(levels.last().copied().unwrap_or(1));
            let part = f64::from(level) / work(levels);
            on_step((done as f64 + part) / seeds);
        }
    }
    Ok(curves)
}

/// True when going on from `levels.0` to `levels.1` samples would end after the share of time.
fn does_not_fit(share: Option<f64>, started: Instant, levels: (u32, u32)) -> bool {
    let elapsed = started.elapsed().as_secs_f64();
    let after = elapsed * f64::from(levels.1) / f64::from(levels.0);
    share.is_some_and(|share| after > share)
}

fn run(
    exposure: &Exposure,
    reference: &Reference,
    seed: u64,
    samples_per_pixel: u32,
) -> Result<Run, CompareError> {
    let counts = exposure.counts();
    Ok(Run {
        seed,
        samples_per_pixel,
        score: reference.score(&exposure.image())?,
        cpu_seconds: exposure.cpu_seconds(),
        wall_seconds: exposure.wall_seconds(),
        rays: counts.closest_rays + counts.shadow_rays,
        samples: exposure.samples(),
    })
}
