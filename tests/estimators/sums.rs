//! Pictures that are sums of others: single bounces (S11) and single lights (S12).

use glam::Vec3;
use softbox::camera::RayCamera;
use softbox::integrator::{PathCounts, PathId, PathSettings, PathTracer, reference};
use softbox::settings::{MaxDepth, Mode};

use super::scenes::{self, View};
use super::welch::{Picture, assert_same_picture, sum_of};
use crate::support::measure::{blocks, prepared, settings};

const SIZE: (u32, u32) = (8, 8);

/// The radiance of each single path of `view`.
fn paths(view: &View, settings: PathSettings, samples: u32) -> Vec<Vec3> {
    let scene = prepared(&view.0);
    let camera = RayCamera::new(&view.1, SIZE.0, SIZE.1, scene.normalization());
    let tracer = PathTracer::new(&scene, &camera, settings);
    let mut counts = PathCounts::default();
    (0..SIZE.0 * SIZE.1)
        .flat_map(|pixel| (0..samples).map(move |sample| (pixel, sample)))
        .map(|(pixel, sample)| {
            let id = PathId {
                pixel: [pixel % SIZE.0, pixel / SIZE.0],
                sample,
            };
            reference(&tracer, id, &mut counts)
        })
        .collect()
}

/// Path by path, `parts` add up to `whole`, but for the rounding of single precision.
fn assert_adds_up(name: &str, whole: &[Vec3], parts: &[Vec<Vec3>]) {
    assert!(
        whole.iter().any(|r| r.max_element() > 0.1),
        "{name} is dark"
    );
    for (i, &whole) in whole.iter().enumerate() {
        let sum: Vec3 = parts.iter().map(|part| part[i]).sum();
        let tolerance = 1e-5 * whole.max_element().max(sum.max_element());
        assert!(
            (whole - sum).abs().max_element() <= tolerance,
            "{name}, path {i}: {whole} is not {sum}"
        );
    }
}

#[test]
fn single_bounces_add_up_path_by_path() {
    for view in [
        scenes::diffuse_spheres(),
        scenes::mirror_and_glass(),
        scenes::conductors(),
        scenes::environment_with_sun(),
        scenes::mixed(&["area", "point", "map"]),
    ] {
        for mode in Mode::ALL {
            let depth = |m: u32, only_last_bounce: bool| PathSettings {
                only_last_bounce,
                ..settings(mode, MaxDepth(m))
            };
            let layers: Vec<Vec<Vec3>> =
                (0..=4).map(|m| paths(&view, depth(m, true), 60)).collect();
            let name = format!("{} {mode:?}", view.0.name);
            assert_adds_up(&name, &paths(&view, depth(4, false), 60), &layers);
            for (m, layer) in layers.iter().enumerate().skip(1) {
                let is_lit = layer.iter().any(|r| r.max_element() > 0.0);
                assert!(is_lit, "{name}: nothing after {m} bounces");
            }
        }
    }
}

/// No light that is sampled one by one touches the random numbers of another, so the pictures of
/// single lights add up path by path.
#[test]
fn single_delta_lights_add_up_path_by_path() {
    let names = ["point", "spot", "sun"];
    for mode in [Mode::Hemisphere, Mode::Importance] {
        let settings = settings(mode, MaxDepth(5));
        let parts: Vec<Vec<Vec3>> = names
            .iter()
            .map(|name| paths(&scenes::delta_lit(&[name]), settings, 100))
            .collect();
        let whole = paths(&scenes::delta_lit(&names), settings, 100);
        assert_adds_up(mode.name(), &whole, &parts);
    }
}

#[test]
fn single_lights_add_up_in_the_mean() {
    let names = ["area", "point", "map"];
    for mode in Mode::ALL {
        let picture = |keep: &[&str], seed: u64| {
            let (scene, camera) = scenes::mixed(keep);
            let settings = PathSettings {
                seed,
                ..settings(mode, MaxDepth(3))
            };
            blocks(&prepared(&scene), &camera, settings, SIZE, 3000)
        };
        let parts: Vec<_> = names
            .iter()
            .zip(1..)
            .map(|(name, seed)| picture(&[name], seed))
            .collect();
        let sum = (0..parts[0].len())
            .map(|block| sum_of(&parts.iter().map(|part| part[block]).collect::<Vec<_>>()))
            .collect();
        let pictures: [Picture; 2] = [
            ("the sum".to_owned(), sum),
            ("all lights".to_owned(), picture(&names, 9)),
        ];
        assert_same_picture(mode.name(), &pictures);
    }
}
