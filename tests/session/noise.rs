//! The error that a picture tells of itself, held against the true one.

use softbox::io::builtin_scene;
use softbox::session::Workbench;

use super::*;

/// The estimate against the true relMSE of a picture of the built-in scene `name` after `samples`
/// samples per pixel: roots of their means over `seeds` pictures, whose mean is the truth.
fn told_against_true(name: &str, samples: &[u32], seeds: u64) -> Vec<f64> {
    let scene = Arc::new(builtin_scene(name).expect("it is built in").scene);
    let mut job = RenderJob {
        camera: initial_camera(&scene, CameraRule::Auto, false),
        scene,
        settings: RenderSettings::default(),
    };
    (job.settings.width, job.settings.height) = (64, 48);
    let bench = Workbench::new(&job);
    let mut pictures: Vec<_> = (0..seeds)
        .map(|seed| bench.begin(Mode::Best, seed))
        .collect();
    let mut ratios = Vec::new();
    for &samples in samples {
        let mut told = 0.0;
        let mut images = Vec::new();
        for picture in &mut pictures {
            assert!(bench.advance(picture, samples, &|| false));
            told += picture.relative_error().map_or(0.0, |error| error * error);
            images.push(picture.image());
        }
        let n = seeds as f32;
        let mut truth = 0.0;
        for pixel in 0..64 * 48 {
            let values = || images.iter().map(|image| image.pixels()[pixel]);
            let mean = values().sum::<glam::Vec3>() / n;
            let squares: glam::Vec3 = values().map(|v| (v - mean) * (v - mean)).sum();
            // Of one picture, and the share of the truth that it is itself.
            let relative = squares / (mean * mean + 0.01) / (n - 1.0);
            truth += f64::from(relative.element_sum()) / 3.0;
        }
        let truth = truth / (64.0 * 48.0) * seeds as f64;
        ratios.push((told / truth).sqrt());
    }
    ratios
}

/// Not less than the truth by more than a few percent, and not as much more as the spread of the
/// samples says, which is 1.3 to 2.7 times it from 64 samples on. Where pixels share their light the
/// error falls fastest, and the halves of a picture say the most about what it was.
#[test]
fn a_picture_knows_its_error() {
    for name in ["cornell-spheres", "cornell-mirror-glass", "open-sky"] {
        for ratio in told_against_true(name, &[16, 64, 100], 8) {
            assert!((0.95..=1.8).contains(&ratio), "{name}: {ratio}");
        }
    }
}

#[test]
#[ignore = "some minutes"]
fn pictures_of_all_scenes_know_their_error() {
    let samples = [8, 16, 32, 64, 100, 128, 256, 512, 1024];
    for name in softbox::io::builtin_names() {
        let ratios = told_against_true(name, &samples, 8);
        println!("{name}: {samples:?} {ratios:.2?}");
        assert!(
            ratios.iter().all(|ratio| (0.92..=1.9).contains(ratio)),
            "{name}"
        );
    }
}
