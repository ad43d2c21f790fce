//! Test S11: the modes, paths that share their light, and different numbers of light samples, agree.

use softbox::integrator::PathSettings;
use softbox::settings::{MaxDepth, Mode};

use super::scenes::{self, View};
use super::welch::{Picture, assert_same_picture, mean_of};
use crate::support::measure::{Estimate, blocks, measure, prepared, settings};

const SIZE: (u32, u32) = (8, 8);
const SAMPLES: u32 = 3000;

/// One picture for each of `settings`, every one with its own random numbers.
fn pictures(view: &View, settings: &[(String, PathSettings, u32)]) -> Vec<Picture> {
    let scene = prepared(&view.0);
    settings
        .iter()
        .enumerate()
        .map(|(seed, (name, settings, samples))| {
            let settings = PathSettings {
                seed: 100 + seed as u64,
                ..*settings
            };
            let blocks = blocks(&scene, &view.1, settings, SIZE, *samples);
            (name.clone(), blocks)
        })
        .collect()
}

/// Every mode of `view` at `depth`, and paths that share with those of pixels far away.
fn check(view: &View, depth: MaxDepth) {
    let modes = Mode::ALL.map(|mode| (mode.name().to_owned(), settings(mode, depth), SAMPLES));
    let shared = [4, 16].map(|reuse| {
        let settings = PathSettings {
            reuse,
            ..settings(Mode::Best, depth)
        };
        (format!("best, shared by {reuse}"), settings, SAMPLES / 4)
    });
    let pictures = pictures(view, &[&modes[..], &shared[..]].concat());
    let (_, best) = &pictures[2];
    assert!(
        best.iter().any(|block| block.mean(1) > 0.05),
        "{} is dark",
        view.0.name
    );
    assert_same_picture(&format!("{}, depth {depth}", view.0.name), &pictures);
}

fn check_depths(view: &View, depths: [MaxDepth; 2]) {
    for depth in depths {
        check(view, depth);
    }
}

const SHORT: [MaxDepth; 2] = [MaxDepth(1), MaxDepth(5)];
const LONG: [MaxDepth; 2] = [MaxDepth(1), MaxDepth::INFINITE];

#[test]
fn diffuse_spheres() {
    check_depths(&scenes::diffuse_spheres(), LONG);
}

#[test]
fn mirror_and_glass() {
    check_depths(&scenes::mirror_and_glass(), SHORT);
}

#[test]
fn conductors() {
    check_depths(&scenes::conductors(), LONG);
}

#[test]
fn point_spot_and_directional() {
    check_depths(&scenes::delta_lit(&["point", "spot", "sun"]), SHORT);
}

#[test]
fn many_small_lights() {
    check_depths(&scenes::many_small_lights(), [MaxDepth(1), MaxDepth(3)]);
}

#[test]
fn lights_in_between() {
    check_depths(&scenes::lights_in_between(), [MaxDepth(1), MaxDepth(3)]);
}

#[test]
fn constant_sky() {
    check_depths(&scenes::constant_sky(), LONG);
}

#[test]
fn a_box_open_to_the_sky() {
    check_depths(&scenes::open_box(), LONG);
}

#[test]
fn ambient() {
    check_depths(&scenes::ambient(), SHORT);
}

#[test]
fn environment_with_sun() {
    check_depths(&scenes::environment_with_sun(), SHORT);
}

#[test]
fn emissive_sphere() {
    check_depths(&scenes::emissive_sphere(), SHORT);
}

#[test]
fn emissive_mesh() {
    check_depths(&scenes::emissive_mesh(), SHORT);
}

#[test]
fn lone_rectangle() {
    check_depths(&scenes::lone_rectangle(), LONG);
}

#[test]
fn mixed_lights() {
    check_depths(&scenes::mixed(&["area", "point", "map"]), SHORT);
}

/// Where uniform directions are good too, the modes must agree closely: a density that is wrong by
/// two percent shows.
#[test]
fn wide_lights() {
    let view = scenes::wide_lights();
    let settings =
        Mode::ALL.map(|mode| (mode.name().to_owned(), settings(mode, MaxDepth(1)), 30_000));
    let pictures = pictures(&view, &settings);
    for (name, blocks) in &pictures {
        let whole = mean_of(blocks);
        let precision = whole.standard_error(1) / whole.mean(1);
        assert!(precision < 1.3e-3, "{name}: {precision}");
    }
    assert_same_picture(&view.0.name, &pictures);
}

#[test]
fn the_number_of_light_samples_does_not_matter() {
    for view in [
        scenes::conductors(),
        scenes::mixed(&["area", "point", "map"]),
    ] {
        for mode in Mode::ALL {
            let with = |light_samples: u32, samples: u32| {
                let settings = PathSettings {
                    light_samples,
                    ..settings(mode, MaxDepth(3))
                };
                (
                    format!("{} × {light_samples}", mode.name()),
                    settings,
                    samples,
                )
            };
            let pictures = pictures(&view, &[with(1, 2000), with(4, 1000)]);
            assert_same_picture(&view.0.name, &pictures);
        }
    }
}

/// Test S10: the roulette that alone ends these paths leaves their mean. The longest paths that
/// matter have some fifty bounces.
#[test]
fn roulette_leaves_the_mean() {
    let mut builder = softbox::scene::SceneBuilder::new("bright furnace");
    let wall = crate::support::scenes::glowing(&mut builder, 0.9, 0.1);
    builder.sphere("wall", glam::DVec3::ZERO, 1.0, wall);
    let scene = prepared(&builder.finish());
    let camera = crate::support::measure::camera(
        glam::DVec3::new(0.3, 0.1, 0.0),
        glam::DVec3::new(1.0, 0.2, 0.3),
        60.0,
    );
    for mode in Mode::ALL {
        let estimate: Estimate =
            measure(&scene, &camera, settings(mode, MaxDepth::INFINITE), 150_000);
        let (mean, error) = (estimate.mean(0), estimate.standard_error(0));
        assert!(error < 4e-3, "{mode:?}: {error}");
        assert!(
            (mean - 1.0).abs() < 4.0 * error,
            "{mode:?}: {mean} ± {error}"
        );
    }
}
