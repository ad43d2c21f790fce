use std::io::Stderr;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use anyhow::anyhow;
use softbox::session::{RenderJob, Workbench};

use super::measure::{Plan, measure as measure_curves};
use super::reference;
use super::report::{Facts, SceneReport};
use crate::bench_args::BenchArgs;
use crate::exit::{Failure, Status};
use crate::open::open;
use crate::place_camera::place_camera;
use crate::progress::{Progress, Standing};

/// Measures one scene; `None` when stopped before there was anything to tell.
pub(super) fn measure(
    args: &BenchArgs,
    path: PathBuf,
    progress: &mut Progress<Stderr>,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Option<SceneReport>, Failure> {
    let job = args.job(path);
    let settings = job.settings.clone();
    // Known to be wrong before anything takes time.
    let read = |path: &PathBuf| reference::read(path, args, &settings);
    let given = args.reference.as_ref().map(read).transpose()?;
    let started = Instant::now();
    let loaded = open(&job)?;
    let load_seconds = started.elapsed().as_secs_f64();
    let scene = Arc::new(loaded.scene);
    let camera = place_camera(&job.camera, &scene, [settings.width, settings.height])
        .map_err(Status::Failed.because())?;
    if !camera.is_valid() {
        return Err(Status::Usage.because()(anyhow!(
            "The camera cannot see: eye and target must differ, all numbers be finite, and the angle lie between 0 and 180 degrees."
        )));
    }
    let bench = Workbench::new(&RenderJob {
        scene: Arc::clone(&scene),
        camera,
        settings: settings.clone(),
    });
    let modes = args.modes();
    let mut first_pass = bench.begin(modes[0], settings.seed);
    if !bench.advance(&mut first_pass, 1, stop) {
        return Ok(None);
    }
    let given = given.or_else(|| {
        let estimator = (args.chosen_reference_mode(), settings.seed);
        let samples = args.chosen_reference_spp();
        reference::make(&bench, estimator, samples, args.time_limit, stop)
    });
    let Some((reference, reference_facts)) = given else {
        return Ok(None);
    };
    let seeds: Vec<u64> = (0..u64::from(args.seeds))
        .map(|i| settings.seed.wrapping_add(i))
        .collect();
    let plan = Plan {
        modes: &modes,
        levels: args.spp.as_slice(),
        seeds: &seeds,
        time_limit: args.time_limit,
    };
    let begin = Instant::now();
    let mut on_step = |fraction: f64| {
        let seconds = begin.elapsed().as_secs_f64();
        progress.update(&standing(fraction, seconds, args));
    };
    let curves = measure_curves(&bench, &reference, &plan, stop, &mut on_step)
        .map_err(Status::Failed.because())?;
    let facts = Facts {
        job: &job,
        scene_name: &scene.name,
        load_seconds,
        build_seconds: bench.build_seconds(),
        first_pass_seconds: first_pass.wall_seconds(),
        reference: reference_facts,
        is_complete: !stop(),
    };
    Ok(SceneReport::new(args, facts, &modes, &curves))
}

fn standing(fraction: f64, seconds: f64, args: &BenchArgs) -> Standing {
    let most = args.spp.as_slice().iter().max().copied().unwrap_or(0);
    let samples = fraction * f64::from(most) * f64::from(args.seeds);
    Standing {
        samples,
        target_samples: Some(most.saturating_mul(args.seeds)),
        fraction: Some(fraction),
        seconds,
        relative_error: None,
        seconds_left: (fraction > 0.0).then(|| seconds * (1.0 - fraction) / fraction),
    }
}
