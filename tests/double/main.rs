//! The path tracer against its twin in double precision, sample by sample.

mod compare;
mod scenes;

use softbox::integrator::{PathSettings, PathTracer};
use softbox::scene::{Instancing, PrepareSettings};
use softbox::settings::{MaxDepth, Mode};

use compare::{Comparison, ENDLESS_FLIP_RATE, FLIP_RATE, GLOWING_FLIP_RATE, ray_camera};
use scenes::View;

const SETTINGS: PathSettings = PathSettings {
    mode: Mode::Best,
    light_samples: 2,
    max_depth: MaxDepth(4),
    only_last_bounce: false,
    seed: 1,
    replicates: 1,
    reuse: 1,
};

fn compare(view: &View, settings: PathSettings, samples: u32) -> Comparison {
    let scene = view.prepared(&PrepareSettings::default());
    let camera = ray_camera(&scene, &view.camera);
    let tracer = PathTracer::new(&scene, &camera, settings);
    Comparison::new(&tracer, &tracer, samples)
}

fn agrees_in_all_modes(view: &View) {
    for mode in Mode::ALL {
        compare(view, PathSettings { mode, ..SETTINGS }, 16).check(mode.name());
    }
}

#[test]
fn diffuse_boxes_and_spheres() {
    agrees_in_all_modes(&scenes::diffuse());
}

#[test]
fn mirror_and_glass() {
    agrees_in_all_modes(&scenes::mirror_and_glass());
}

#[test]
fn rough_metal() {
    agrees_in_all_modes(&scenes::rough_metal());
}

#[test]
fn delta_lights() {
    agrees_in_all_modes(&scenes::delta_lights());
}

#[test]
fn a_tree_of_lights() {
    agrees_in_all_modes(&scenes::many_lights());
}

#[test]
fn environment_and_sky() {
    agrees_in_all_modes(&scenes::outdoors());
}

#[test]
fn smooth_mesh() {
    let view = scenes::smooth_meshes();
    for mode in Mode::ALL {
        let comparison = compare(&view, PathSettings { mode, ..SETTINGS }, 16);
        comparison.check_within(mode.name(), GLOWING_FLIP_RATE);
    }
}

/// Every mesh that can be is an instance, seen in both precisions.
#[test]
fn shared_meshes() {
    let shared = PrepareSettings {
        instancing: Instancing::Always,
        ..PrepareSettings::default()
    };
    for (view, flip_rate) in [
        (scenes::diffuse(), FLIP_RATE),
        (scenes::mirror_and_glass(), FLIP_RATE),
        (scenes::rough_metal(), FLIP_RATE),
        (scenes::smooth_meshes(), GLOWING_FLIP_RATE),
    ] {
        let scene = view.prepared(&shared);
        assert!(scene.instance_stats().instances > 0);
        let camera = ray_camera(&scene, &view.camera);
        let tracer = PathTracer::new(&scene, &camera, SETTINGS);
        Comparison::new(&tracer, &tracer, 16).check_within("shared", flip_rate);
    }
}

#[test]
fn every_setting_is_honoured() {
    let view = scenes::mirror_and_glass();
    let by_depth = [0, 1, 2, 5].map(|depth| PathSettings {
        max_depth: MaxDepth(depth),
        light_samples: 1,
        ..SETTINGS
    });
    for settings in by_depth {
        compare(&view, settings, 16).check(&settings.max_depth.to_string());
    }
    let endless = PathSettings {
        max_depth: MaxDepth::INFINITE,
        light_samples: 1,
        ..SETTINGS
    };
    compare(&view, endless, 32).check_within("endless", ENDLESS_FLIP_RATE);
    for mode in Mode::ALL {
        let settings = PathSettings {
            mode,
            only_last_bounce: true,
            ..SETTINGS
        };
        compare(&view, settings, 4).check("last bounce");
    }
}

#[test]
fn lenses_and_glowing_rooms() {
    compare(&scenes::seen_through_a_lens(), SETTINGS, 8).check("lens");
    agrees_in_all_modes(&scenes::inside_a_lamp());
}

#[test]
fn triangles_that_shine() {
    for is_lamp in [false, true] {
        agrees_in_all_modes(&scenes::triangles_that_shine(is_lamp));
    }
}

#[test]
fn the_errors_of_the_course_are_repeated() {
    let view = scenes::delta_lights();
    let course = PrepareSettings {
        course_compatible: true,
        ..PrepareSettings::default()
    };
    let scene = view.prepared(&course);
    let camera = ray_camera(&scene, &view.camera);
    for mode in Mode::ALL {
        let tracer = PathTracer::new(&scene, &camera, PathSettings { mode, ..SETTINGS });
        Comparison::new(&tracer, &tracer, 8).check(mode.name());
    }
}

/// The comparison is able to fail: other random numbers are other paths of the same picture.
#[test]
fn another_seed_is_another_path() {
    let view = scenes::diffuse();
    let scene = view.prepared(&PrepareSettings::default());
    let camera = ray_camera(&scene, &view.camera);
    let tracer = |seed| PathTracer::new(&scene, &camera, PathSettings { seed, ..SETTINGS });
    assert!(Comparison::new(&tracer(1), &tracer(2), 1).flip_rate() > 0.5);
}

/// Rounding moves points off the plane of the triangle they lie on. Where the shading normal is not
/// that of the triangle, this must not let the triangle light itself.
#[test]
fn a_convex_lamp_does_not_light_itself() {
    let view = scenes::barrel_lamp();
    let scene = view.prepared(&PrepareSettings::default());
    let camera = ray_camera(&scene, &view.camera);
    for mode in Mode::ALL {
        let tracer = PathTracer::new(&scene, &camera, PathSettings { mode, ..SETTINGS });
        let brightest = compare::brightest(&tracer, 64);
        assert!((brightest - 1.0).abs() < 1e-5, "{mode:?}: {brightest}");
    }
}
