//! Pictures of scenes that lie beside the repository.

use std::ops::ControlFlow;
use std::path::PathBuf;

use rayon::prelude::*;
use softbox::camera::{Camera, RayCamera};
use softbox::film::PixelStats;
use softbox::integrator::{BATCH_SIZE, PathCounts, PathId, PathSettings, PathTracer, Wavefront};
use softbox::io::load_scene;
use softbox::scene::{PrepareSettings, PreparedScene, Scene, prepare};

/// The folder of scenes and references beside the repository; `None`, with a message, without it.
#[expect(clippy::print_stdout, reason = "says what was not there")]
pub(crate) fn shared() -> Option<PathBuf> {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "..", "shared"]
        .iter()
        .collect();
    if !path.is_dir() {
        println!("skipped, not there: {}", path.display());
        return None;
    }
    Some(path)
}

/// The scene in `file` of the shared folder; `None`, with a message, when it is not there.
#[expect(clippy::print_stdout, reason = "says which scenes were not there")]
pub(crate) fn load(file: &str) -> Option<Scene> {
    let path = shared()?.join(file);
    if !path.exists() {
        println!("skipped, not there: {}", path.display());
        return None;
    }
    let loaded = load_scene(&path, &mut |_| ControlFlow::Continue(()));
    Some(loaded.expect("a readable scene").scene)
}

pub(crate) fn prepared_as(scene: &Scene, course_compatible: bool) -> PreparedScene {
    let settings = PrepareSettings {
        course_compatible,
        ..PrepareSettings::default()
    };
    prepare(scene, &settings, &|_, _| ControlFlow::Continue(())).expect("nothing asks it to stop")
}

/// The statistics of every pixel, row by row, after samples `first` to `first + count - 1`, and the
/// work it took.
pub(crate) fn picture(
    scene: &PreparedScene,
    camera: &Camera,
    settings: PathSettings,
    (width, height): (u32, u32),
    (first, count): (u32, u32),
) -> (Vec<PixelStats>, PathCounts) {
    let camera = RayCamera::new(camera, width, height, scene.normalization());
    let tracer = PathTracer::new(scene, &camera, settings);
    let mut pixels = vec![PixelStats::default(); (width * height) as usize];
    let counts = pixels
        .par_chunks_mut(width as usize)
        .enumerate()
        .map(|(y, row)| {
            let mut wavefront = Wavefront::default();
            let mut counts = PathCounts::default();
            let ids: Vec<PathId> = (0..width)
                .flat_map(|x| {
                    (first..first + count).map(move |sample| PathId {
                        pixel: [x, y as u32],
                        sample,
                    })
                })
                .collect();
            let mut radiance = vec![glam::Vec3::ZERO; BATCH_SIZE];
            for batch in ids.chunks(BATCH_SIZE) {
                let radiance = &mut radiance[..batch.len()];
                wavefront.trace(&tracer, batch, radiance, &mut counts);
                for (id, &radiance) in batch.iter().zip(radiance.iter()) {
                    row[id.pixel[0] as usize].add(radiance);
                }
            }
            counts
        })
        .reduce(PathCounts::default, |mut a, b| {
            a += b;
            a
        });
    (pixels, counts)
}
