use std::io::Stderr;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use anyhow::anyhow;
use softbox::session::{RenderJob, Workbench};

use super::measure::{Plan, measure as measure_curves};
use super::reference::{self, Recipe};
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
    let mut bench = Workbench::new(&RenderJob {
        scene: Arc::clone(&scene),
        camera,
        settings: settings.clone(),
    });
    let contenders = args.contenders();
    let mut first_pass = bench.begin_as(contenders[0].mode, None, settings.seed);
    if !bench.advance(&mut first_pass, 1, stop) {
        return Ok(None);
    }
    let refine_seconds = bench.refine();
    let given = given.or_else(|| {
        let recipe = Recipe {
            mode: args.chosen_reference_mode(),
            seed: settings.seed,
            samples: args.chosen_reference_spp(),
            time_limit: args.time_limit,
            stop,
        };
        let begin = Instant::now();
        let mut on_step = |fraction: f64| {
            progress.update(&standing(fraction, begin, recipe.samples));
        };
        reference::make(&bench, &recipe, &mut on_step)
    });
    progress.finish();
    let Some((reference, reference_facts)) = given else {
        return Ok(None);
    };
    let seeds: Vec<u64> = (0..u64::from(args.seeds))
        .map(|i| settings.seed.wrapping_add(i))
        .collect();
    let plan = Plan {
        contenders: &contenders,
        settings: &settings,
        levels: args.spp.as_slice(),
        seeds: &seeds,
        time_limit: args.time_limit,
    };
    let most = args.spp.as_slice().iter().max().copied().unwrap_or(0);
    let begin = Instant::now();
    let mut on_step = |fraction: f64| {
        progress.update(&standing(fraction, begin, most.saturating_mul(args.seeds)));
    };
    let curves = measure_curves(&bench, &reference, &plan, stop, &mut on_step)
        .map_err(Status::Failed.because())?;
    let facts = Facts {
        job: &job,
        scene_name: &scene.name,
        load_seconds,
        build_seconds: bench.build_seconds(),
        first_pass_seconds: first_pass.wall_seconds(),
        refine_seconds,
        reference: reference_facts,
        is_complete: !stop(),
    };
    Ok(SceneReport::new(args, facts, &contenders, &curves))
}

fn standing(fraction: f64, begin: Instant, samples: u32) -> Standing {
    let seconds = begin.elapsed().as_secs_f64();
    Standing {
        samples: fraction * f64::from(samples),
        target_samples: Some(samples),
        fraction: Some(fraction),
        seconds,
        relative_error: None,
        seconds_left: (fraction > 0.0).then(|| seconds * (1.0 - fraction) / fraction),
    }
}
