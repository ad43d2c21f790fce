//! The wavefront gives the bits of the reference, path by path: wherever it works in lanes, for
//! every instruction set, and for batches of any length.

mod compare;
mod scenes;
#[expect(unreachable_pub, reason = "shared by several test crates")]
#[path = "../support/scenes.rs"]
mod support;

use softbox::integrator::PathSettings;
use softbox::scene::Instancing;
use softbox::settings::{MaxDepth, Mode};

use compare::{check, check_with};

fn settings(mode: Mode) -> PathSettings {
    PathSettings {
        mode,
        light_samples: 1,
        max_depth: MaxDepth::INFINITE,
        only_last_bounce: false,
        seed: 1,
        replicates: 1,
        reuse: 1,
    }
}

/// Every mode, number of light samples and choice of bounces that shading treats in its own way.
fn all_settings() -> Vec<PathSettings> {
    let mut all = Vec::new();
    for mode in Mode::ALL {
        for (light_samples, depth) in [(1, 6), (3, 3), (2, 1)] {
            let max_depth = MaxDepth(depth);
            all.push(PathSettings {
                light_samples,
                max_depth,
                ..settings(mode)
            });
        }
        for depth in [0, 1, 3] {
            let max_depth = MaxDepth(depth);
            all.push(PathSettings {
                light_samples: 2,
                max_depth,
                only_last_bounce: true,
                ..settings(mode)
            });
        }
        all.push(PathSettings {
            seed: 77,
            replicates: 3,
            ..settings(mode)
        });
    }
    all.extend(shared());
    all
}

/// Clusters of all sizes, of paths that end before and after their shared vertices.
fn shared() -> impl Iterator<Item = PathSettings> {
    let all = [(2, 6, 1), (4, 2, 1), (8, 5, 2), (16, 5, 1), (4, 1, 1)];
    all.into_iter().flat_map(|(reuse, depth, light_samples)| {
        [false, true].map(|only_last_bounce| PathSettings {
            reuse,
            light_samples,
            max_depth: MaxDepth(depth),
            only_last_bounce,
            ..settings(Mode::Best)
        })
    })
}

#[test]
fn one_light_far_and_near() {
    check(&scenes::ceiling_light(), &all_settings());
}

#[test]
fn points_beside_a_light_and_on_its_plane() {
    for side in scenes::SIDES {
        check(&scenes::light_between_walls(side), &all_settings());
    }
}

#[test]
fn triangle_light() {
    for side in scenes::SIDES {
        check(&scenes::triangle_light(side), &all_settings());
    }
}

#[test]
fn a_light_as_large_as_the_room() {
    check(&scenes::glowing_ceiling(), &all_settings());
}

#[test]
fn a_light_that_no_ray_meets() {
    check(&scenes::light_node(), &all_settings());
}

#[test]
fn a_light_and_the_sky() {
    for sky in scenes::SKIES {
        check(&scenes::light_and_sky(sky), &all_settings());
    }
}

#[test]
fn delta_lights_with_and_without_a_light() {
    for with_area in [false, true] {
        check(&scenes::delta_lights(with_area), &all_settings());
    }
}

#[test]
fn many_lights_of_all_shapes() {
    check(&scenes::many_lights(), &all_settings());
}

#[test]
fn every_material_on_spheres_and_smooth_meshes() {
    check(&scenes::materials(), &all_settings());
}

#[test]
fn lights_through_mirrors_and_glass() {
    for with_lamp in [false, true] {
        check(&scenes::caustics(with_lamp), &all_settings());
    }
}

#[test]
fn instances() {
    for instancing in [Instancing::Never, Instancing::Always] {
        check_with(&scenes::smooth_copies(), instancing, &all_settings());
    }
}

#[test]
fn a_lens() {
    let (scene, camera) = scenes::ceiling_light();
    let camera = softbox::camera::Camera {
        lens_radius: 0.1,
        focal_distance: 4.0,
        ..camera
    };
    check(&(scene, camera), &all_settings());
}
