use std::ops::ControlFlow;

use rayon::prelude::*;
use softbox::camera::RayCamera;
use softbox::color::Rgb;
use softbox::geometry::TraceCounts;
use softbox::integrator::{
    PathCounts, PathId, PathSettings, PathTracer, Wavefront, reference_cluster,
};
use softbox::math::Isa;
use softbox::scene::{Instancing, PrepareSettings, PreparedScene, prepare};

use crate::scenes::View;

/// The picture's size, not a multiple of anything.
const WIDTH: u32 = 23;
const HEIGHT: u32 = 17;
const SAMPLES: u32 = 2;

/// Clusters in a batch: lanes that are full, and such that lack one path, nearly all or most.
const BATCHES: [usize; 5] = [1, 7, 8, 61, 777];

/// Holds the wavefront against the reference in all of `settings`.
pub(crate) fn check(view: &View, settings: &[PathSettings]) {
    check_with(view, Instancing::Auto, settings);
}

/// The same with meshes shared as `instancing` says.
pub(crate) fn check_with(view: &View, instancing: Instancing, settings: &[PathSettings]) {
    let scenes: Vec<PreparedScene> = Isa::available()
        .map(|isa| as_prepared(view, instancing, isa))
        .collect();
    let camera = RayCamera::new(&view.1, WIDTH, HEIGHT, scenes[0].normalization());
    // Said by the thread of the test: what others say is lost.
    let wrong: Vec<String> = (settings.par_iter())
        .filter_map(|&settings| what_differs(&scenes, &camera, settings))
        .collect();
    assert!(wrong.is_empty(), "{}: {}", view.0.name, wrong.join("\n"));
}

/// One sentence when the wavefront is wrong for one of `scenes`.
fn what_differs(
    scenes: &[PreparedScene],
    camera: &RayCamera,
    settings: PathSettings,
) -> Option<String> {
    let tracer = PathTracer::new(&scenes[0], camera, settings);
    let size = tracer.cluster_size();
    let (expected, work) = by_reference(&tracer);
    if !settings.only_last_bounce && expected.iter().all(|r| *r == Rgb::ZERO) {
        return Some(format!("{settings:?} is dark"));
    }
    for (scene, batch) in (scenes.iter()).flat_map(|scene| BATCHES.map(|batch| (scene, batch))) {
        let (radiance, counts) = by_wavefront(&PathTracer::new(scene, camera, settings), batch);
        let isa = scene.aggregate().isa();
        let case = || format!("{settings:?}, {isa:?}, by {batch}");
        if let Some(path) = first_difference(ids(size), &radiance, &expected) {
            return Some(format!("{}, {path}", case()));
        }
        if counts != work {
            return Some(format!("{}: {counts:?}, not {work:?}", case()));
        }
    }
    None
}

fn as_prepared((scene, _): &View, instancing: Instancing, isa: Isa) -> PreparedScene {
    let settings = PrepareSettings {
        instancing,
        isa: Some(isa),
        ..PrepareSettings::default()
    };
    prepare(scene, &settings, &|_, _| ControlFlow::Continue(())).expect("nothing asks it to stop")
}

/// The paths, as many as make whole clusters: neighbours in a row of pixels.
fn ids(cluster: usize) -> Vec<PathId> {
    let pixels = WIDTH * HEIGHT;
    let paths = pixels * SAMPLES / cluster as u32 * cluster as u32;
    (0..paths)
        .map(|i| PathId {
            pixel: [i % pixels % WIDTH, i % pixels / WIDTH],
            sample: i / pixels,
        })
        .collect()
}

fn by_reference(tracer: &PathTracer<'_>) -> (Vec<Rgb>, PathCounts) {
    let mut counts = PathCounts::default();
    let size = tracer.cluster_size();
    let ids = ids(size);
    let mut radiance = vec![Rgb::splat(f32::NAN); ids.len()];
    for (ids, radiance) in ids.chunks(size).zip(radiance.chunks_mut(size)) {
        reference_cluster(tracer, ids, radiance, &mut counts);
    }
    (radiance, without_tests(counts))
}

fn by_wavefront(tracer: &PathTracer<'_>, batch: usize) -> (Vec<Rgb>, PathCounts) {
    let size = tracer.cluster_size();
    let (ids, batch) = (ids(size), batch * size);
    let mut radiance = vec![Rgb::splat(f32::NAN); ids.len()];
    let (mut wavefront, mut counts) = (Wavefront::default(), PathCounts::default());
    for (ids, radiance) in ids.chunks(batch).zip(radiance.chunks_mut(batch)) {
        wavefront.trace(tracer, ids, radiance, &mut counts);
    }
    (radiance, without_tests(counts))
}

/// The work but for the tests in boxes and primitives, which depend on the company of a ray.
fn without_tests(counts: PathCounts) -> PathCounts {
    PathCounts {
        trace: TraceCounts {
            rays: counts.trace.rays,
            ..TraceCounts::default()
        },
        ..counts
    }
}

/// The first path whose radiance has other bits than expected.
fn first_difference(ids: Vec<PathId>, radiance: &[Rgb], expected: &[Rgb]) -> Option<String> {
    let bits = |r: &Rgb| r.to_array().map(f32::to_bits);
    let mut paths = ids.into_iter().zip(radiance.iter().zip(expected));
    let (id, (radiance, expected)) = paths.find(|(_, (a, b))| bits(a) != bits(b))?;
    Some(format!("{id:?} is {radiance}, not {expected}"))
}
