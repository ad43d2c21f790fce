//! Test F6 of the stress list: the interval with the real sampler on a real scene.

use std::ops::ControlFlow;

use super::super::even::{half_width_95, independent_of_nine};
use crate::camera::RayCamera;
use crate::film::Film;
use crate::image::Region;
use crate::integrator::{PathSettings, PathTracer};
use crate::scene::{PrepareSettings, cornell_box, initial_camera, prepare};
use crate::session::pass::{Stop, render_pass};
use crate::session::workers::Workers;
use crate::settings::{Adaptive, AdaptiveGoal, CameraRule, IntegratorKind, RenderSettings};

const SIZE: [u32; 2] = [24, 18];

/// The share of intervals that hold the truth, over all pixels, channels and seeds; the truth is the
/// mean of all seeds.
fn coverage(seeds: u32, samples: u32) -> f64 {
    let scene = cornell_box("box").finish();
    let camera = initial_camera(&scene, CameraRule::Auto, false);
    let scene = prepare(&scene, &PrepareSettings::default(), &|_, _| {
        ControlFlow::Continue(())
    })
    .expect("nothing asks it to stop");
    let [width, height] = SIZE;
    let camera = RayCamera::new(&camera, width, height, scene.normalization());
    let mut settings = RenderSettings {
        adaptive: Some(Adaptive {
            batch: 64,
            tolerance: 0.05,
            goal: AdaptiveGoal::Even,
            exposure: 0.0,
        }),
        ..RenderSettings::default()
    };
    let replicates = settings.replicates();
    let independent = independent_of_nine(&settings);
    let region = Region {
        x: 0,
        y: 0,
        width,
        height,
    };
    let mut film = Film::with_replicates(region, replicates);
    let workers = Workers::new(2, false);
    let never = Stop {
        at_once: &|| false,
        when_due: &|| false,
    };
    let values = (width * height * 3) as usize;
    let mut runs: Vec<Vec<[f64; 2]>> = Vec::new();
    for seed in 0..seeds {
        settings.seed = u64::from(seed);
        film.tiles_mut().iter_mut().for_each(|tile| tile.clear());
        let tracer = PathTracer::new(&scene, &camera, PathSettings::from(&settings));
        let kind = IntegratorKind::Wavefront;
        render_pass(&workers, &tracer, kind, &mut film, samples, never);
        let rows = film.rows();
        let mut run = Vec::with_capacity(values);
        for place in 0..(width * height) as usize {
            let (x, y) = (place % width as usize, place / width as usize);
            let pooled = rows.pooled(x, y).expect("there are enough samples");
            let half_width = half_width_95(&pooled, (replicates, independent));
            let mean = rows.mean(x, y);
            run.extend((0..3).map(|c| [mean[c], half_width[c]]));
        }
        runs.push(run);
    }
    let n = f64::from(seeds);
    // The truth holds a part of each seed's own error.
    let share = (1.0 - 1.0 / n).sqrt();
    let covered: usize = (0..values)
        .map(|i| {
            let truth = runs.iter().map(|run| run[i][0]).sum::<f64>() / n;
            let holds = |run: &&Vec<[f64; 2]>| (run[i][0] - truth).abs() <= share * run[i][1];
            runs.iter().filter(holds).count()
        })
        .sum();
    covered as f64 / (n * values as f64)
}

#[test]
fn the_interval_holds_the_truth_in_95_of_100_pictures() {
    for samples in [64, 256] {
        let covered = coverage(60, samples);
        assert!((0.93..=0.97).contains(&covered), "{samples}: {covered}");
    }
}

#[test]
#[ignore = "a minute"]
fn the_interval_holds_the_truth_over_a_thousand_seeds() {
    for samples in [64, 256] {
        let covered = coverage(1000, samples);
        assert!((0.93..=0.97).contains(&covered), "{samples}: {covered}");
    }
}
