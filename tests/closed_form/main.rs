//! Scenes of known radiance (tests C1 to C10 and C13 of the stress list), in every mode.

mod skies;
#[path = "../support/mod.rs"]
mod support;

use std::f64::consts::PI;

use glam::{DMat4, DVec3};
use softbox::camera::Camera;
use softbox::color::Rgb;
use softbox::integrator::PathSettings;
use softbox::scene::{LightKind, PreparedScene, Scene, SceneBuilder, Surface};
use softbox::settings::{MaxDepth, Mode};
use support::measure::{camera, measure, prepared, settings};
use support::scenes::{glowing, inside_out, sphere_mesh};

const DEPTHS: [MaxDepth; 5] = [
    MaxDepth(0),
    MaxDepth(1),
    MaxDepth(2),
    MaxDepth(5),
    MaxDepth::INFINITE,
];

/// Largest standard error, relative to the exact value, that makes a comparison worth something.
const PRECISION: f64 = 2e-3;

/// Compares the mean with `exact` in every mode: within four standard errors, which are small.
fn check(name: &str, scene: &Scene, camera: &Camera, depth: MaxDepth, expected: (u32, f64)) {
    check_modes(&Mode::ALL, name, (scene, camera, depth), expected);
}

/// Area sampling has no finite variance where light and surface touch; such scenes leave it out.
const BUT_IMPORTANCE: [Mode; 2] = [Mode::Hemisphere, Mode::Best];

fn check_modes(
    modes: &[Mode],
    name: &str,
    (scene, camera, depth): (&Scene, &Camera, MaxDepth),
    (samples, exact): (u32, f64),
) {
    let scene = prepared(scene);
    for &mode in modes {
        // Uniform directions need more samples for the same precision.
        let samples = if mode == Mode::Hemisphere {
            2 * samples
        } else {
            samples
        };
        let by_themselves = settings(mode, depth);
        check_mode(
            (name, mode),
            (&scene, camera, by_themselves),
            samples,
            exact,
        );
        if mode == Mode::Best {
            let shared = PathSettings {
                reuse: 4,
                ..by_themselves
            };
            let name = format!("{name}, shared");
            check_mode((&name, mode), (&scene, camera, shared), samples, exact);
        }
    }
}

fn check_mode(
    (name, mode): (&str, Mode),
    (scene, camera, settings): (&PreparedScene, &Camera, PathSettings),
    samples: u32,
    exact: f64,
) {
    let depth = settings.max_depth;
    let estimate = measure(scene, camera, settings, samples);
    let (mean, error) = (estimate.mean(0), estimate.standard_error(0));
    // Single precision of the scene itself.
    let rounding = 2e-6 * exact;
    assert!(
        (mean - exact).abs() <= 4.0 * error + rounding,
        "{name}, {mode:?}, depth {depth}: {mean} ± {error}, exactly {exact}"
    );
    assert!(
        error <= PRECISION * exact + 1e-12,
        "{name}, {mode:?}: standard error {error} of {exact}"
    );
}

fn power_sum(rho: f64, terms: MaxDepth) -> f64 {
    if terms == MaxDepth::INFINITE {
        1.0 / (1.0 - rho)
    } else {
        (1.0 - rho.powi(terms.0 as i32)) / (1.0 - rho)
    }
}

#[test]
fn c1_furnace_sphere() {
    let mut builder = SceneBuilder::new("furnace");
    let wall = glowing(&mut builder, 0.5, 0.5);
    builder.sphere("wall", DVec3::new(3.0, 1.0, -2.0), 2.0, wall);
    let scene = builder.finish();
    let camera = camera(DVec3::new(3.5, 1.2, -2.1), DVec3::new(3.0, 2.0, 0.0), 60.0);
    for depth in DEPTHS {
        let terms = if depth == MaxDepth::INFINITE {
            depth
        } else {
            MaxDepth(depth.0 + 1)
        };
        check(
            "furnace sphere",
            &scene,
            &camera,
            depth,
            (200_000, 0.5 * power_sum(0.5, terms)),
        );
    }
}

#[test]
fn c1_furnace_cube() {
    let mut builder = SceneBuilder::new("furnace");
    let wall = glowing(&mut builder, 0.5, 0.5);
    for axis in 0..3 {
        let (u, v, w) = (
            [DVec3::X, DVec3::Y, DVec3::Z][axis],
            [DVec3::Y, DVec3::Z, DVec3::X][axis],
            [DVec3::Z, DVec3::X, DVec3::Y][axis],
        );
        builder.quad("wall", DVec3::ZERO, u, v, wall);
        builder.quad("wall", w, v, u, wall);
    }
    let scene = builder.finish();
    let camera = camera(DVec3::new(0.3, 0.4, 0.6), DVec3::ONE, 70.0);
    for depth in DEPTHS {
        let terms = if depth == MaxDepth::INFINITE {
            depth
        } else {
            MaxDepth(depth.0 + 1)
        };
        check_modes(
            &BUT_IMPORTANCE,
            "furnace cube",
            (&scene, &camera, depth),
            (200_000, 0.5 * power_sum(0.5, terms)),
        );
    }
}

#[test]
fn c2_point_light_in_a_sphere() {
    let (rho, intensity, radius) = (0.5, 3.0, 2.5_f64);
    let mut builder = SceneBuilder::new("cavity");
    let wall = builder.diffuse("wall", Rgb::splat(rho as f32));
    builder.sphere("wall", DVec3::ZERO, radius, wall);
    builder.light(
        "lamp",
        LightKind::Point {
            intensity: Rgb::splat(intensity as f32),
        },
        DMat4::IDENTITY,
    );
    let scene = builder.finish();
    let camera = camera(DVec3::new(0.5, 0.3, -0.4), DVec3::new(2.0, 0.1, 0.0), 40.0);
    for depth in &DEPTHS[1..] {
        let exact = rho / PI * intensity / radius.powi(2) * power_sum(rho, *depth);
        check("point in sphere", &scene, &camera, *depth, (100_000, exact));
    }
}

#[test]
fn c3_emitting_cap_of_a_cavity() {
    // A cap of the polar angle with 1 − cos θ = 2 f covers the fraction f of the sphere.
    let (f, rho, radiance) = (0.05_f64, 0.8, 4.0);
    let cap = (1.0 - 2.0 * f).acos();
    let mut builder = SceneBuilder::new("cavity");
    let wall = builder.diffuse("wall", Rgb::splat(rho as f32));
    let light = builder.emitter("light", Rgb::splat(radiance as f32));
    let (positions, triangles) = sphere_mesh(1.0, (0.0, cap), 24, 384);
    builder.mesh("cap", positions, &inside_out(&triangles), light);
    let (positions, triangles) = sphere_mesh(1.0, (cap, PI), 160, 384);
    builder.mesh("wall", positions, &inside_out(&triangles), wall);
    // The formula is about a true sphere: flat triangles, no smooth normals that fake one.
    let scene = builder.finish();
    let camera = camera(DVec3::new(0.1, -0.3, 0.2), DVec3::new(0.3, -1.0, 0.1), 50.0);
    for depth in [1, 2, 6] {
        let irradiance = PI * radiance * f * power_sum(rho * (1.0 - f), MaxDepth(depth));
        let scene = prepared(&scene);
        for mode in [Mode::Importance, Mode::Best] {
            let estimate = measure(&scene, &camera, settings(mode, MaxDepth(depth)), 200_000);
            let exact = rho / PI * irradiance;
            // The polyhedron differs from the sphere by about 1e-4.
            let bound = 4.0 * estimate.standard_error(0) + 4e-4 * exact;
            assert!(
                (estimate.mean(0) - exact).abs() <= bound,
                "depth {depth} {mode:?}: {} {exact}",
                estimate.mean(0)
            );
            assert!(estimate.standard_error(0) <= PRECISION * exact);
        }
    }
}

#[test]
fn c4_concentric_spheres() {
    // B1 = 1.2258065, B2 = 0.4516129 for exitance 1 inside, albedos 0.5 and 0.7, radii 1 and 2.
    let mut builder = SceneBuilder::new("concentric");
    let inner = builder.material(softbox::scene::Material {
        name: "inner".to_owned(),
        surface: Surface::Diffuse {
            reflectance: Rgb::splat(0.5),
        },
        emission: Rgb::splat((1.0 / PI) as f32),
        double_sided: false,
    });
    let outer = builder.diffuse("outer", Rgb::splat(0.7));
    builder.sphere("inner", DVec3::ZERO, 1.0, inner);
    builder.sphere("outer", DVec3::ZERO, 2.0, outer);
    let scene = builder.finish();
    let (eye, away) = (DVec3::new(0.0, 0.0, 1.5), DVec3::new(0.3, 0.2, 2.0));
    check(
        "inner",
        &scene,
        &camera(eye, DVec3::ZERO, 20.0),
        MaxDepth::INFINITE,
        (400_000, 1.225_806_5 / PI),
    );
    check(
        "outer",
        &scene,
        &camera(eye, away, 20.0),
        MaxDepth::INFINITE,
        (400_000, 0.451_612_9 / PI),
    );
}

/// A plane of albedo 0.5 at y = 0 and a camera that looks at a tiny spot around the origin.
fn plane() -> (SceneBuilder, Camera) {
    let mut builder = SceneBuilder::new("plane");
    let grey = builder.diffuse("grey", Rgb::splat(0.5));
    builder.quad(
        "plane",
        DVec3::new(-4.0, 0.0, -4.0),
        DVec3::Z * 8.0,
        DVec3::X * 8.0,
        grey,
    );
    (
        builder,
        camera(DVec3::new(1.0, 0.6, 0.9), DVec3::ZERO, 0.01),
    )
}

#[test]
fn c5_rectangle_over_a_plane() {
    let (mut builder, camera) = plane();
    let light = builder.emitter("light", Rgb::splat(2.0));
    builder.quad(
        "light",
        DVec3::new(-0.5, 1.0, -0.5),
        DVec3::X,
        DVec3::Z,
        light,
    );
    check(
        "rectangle",
        &builder.finish(),
        &camera,
        MaxDepth(1),
        (1_500_000, 0.5 / PI * 2.0 * 0.752_274_7),
    );
}

#[test]
fn c6_disk_on_axis() {
    let (radius, height) = (0.7_f64, 0.9_f64);
    let (mut builder, camera) = plane();
    let light = builder.emitter("light", Rgb::splat(2.0));
    let n = 2048_u32;
    let mut positions = vec![DVec3::Y * height];
    positions.extend((0..n).map(|i| {
        let (sin, cos) = (2.0 * PI * f64::from(i) / f64::from(n)).sin_cos();
        DVec3::new(radius * cos, height, radius * sin)
    }));
    let triangles: Vec<[u32; 3]> = (0..n).map(|i| [0, 1 + i, 1 + (i + 1) % n]).collect();
    builder.mesh("light", positions, &triangles, light);
    let irradiance = PI * 2.0 * radius.powi(2) / (radius.powi(2) + height.powi(2));
    check(
        "disk",
        &builder.finish(),
        &camera,
        MaxDepth(1),
        (1_500_000, 0.5 / PI * irradiance),
    );
}

#[test]
fn c7_sphere_light() {
    let (radius, center) = (0.6_f64, DVec3::new(0.4, 1.5, -0.3));
    let (mut builder, camera) = plane();
    let light = builder.emitter("light", Rgb::splat(2.0));
    builder.sphere("light", center, radius, light);
    let distance = center.length();
    let irradiance = PI * 2.0 * (radius / distance).powi(2) * (center.y / distance);
    check(
        "sphere light",
        &builder.finish(),
        &camera,
        MaxDepth(1),
        (2_500_000, 0.5 / PI * irradiance),
    );
}

#[test]
fn c8_form_factors_of_unit_squares() {
    for (name, corner, u, v, factor) in [
        (
            "parallel",
            DVec3::new(-0.5, 1.0, -0.5),
            DVec3::X,
            DVec3::Z,
            0.199_824_9,
        ),
        (
            "at a right angle",
            DVec3::new(-0.5, 0.0, -0.5),
            DVec3::Z,
            DVec3::Y,
            0.200_043_8,
        ),
    ] {
        let mut builder = SceneBuilder::new("squares");
        let grey = builder.diffuse("grey", Rgb::splat(0.5));
        let light = builder.emitter("light", Rgb::splat(1.0));
        builder.quad(
            "receiver",
            DVec3::new(-0.5, 0.0, -0.5),
            DVec3::Z,
            DVec3::X,
            grey,
        );
        // The square at a right angle emits towards +x.
        let (u, v) = if name == "parallel" { (u, v) } else { (v, u) };
        builder.quad("emitter", corner, u, v, light);
        // From half a unit above its middle the receiver fills the picture.
        let camera = camera(DVec3::Y * 0.5, DVec3::ZERO, 90.0);
        let modes: &[Mode] = if name == "parallel" {
            &Mode::ALL
        } else {
            &BUT_IMPORTANCE
        };
        check_modes(
            modes,
            name,
            (&builder.finish(), &camera, MaxDepth(1)),
            (2_000_000, 0.5 * factor),
        );
    }
}

#[test]
fn c13_delta_lights_have_no_variance() {
    let towards = DVec3::new(0.3, -1.0, 0.2).normalize();
    let turn = DMat4::from_quat(glam::DQuat::from_rotation_arc(DVec3::NEG_Z, towards));
    let position = DVec3::new(0.5, 1.5, -0.7);
    for (name, kind, place, irradiance) in [
        (
            "directional",
            LightKind::Directional {
                irradiance: Rgb::splat(3.0),
            },
            turn,
            3.0 * -towards.y,
        ),
        (
            "point",
            LightKind::Point {
                intensity: Rgb::splat(3.0),
            },
            DMat4::from_translation(position),
            3.0 * position.y / position.length().powi(3),
        ),
    ] {
        let (mut builder, camera) = plane();
        builder.light(name, kind, place);
        // A spot small enough that the irradiance does not change across it.
        let camera = Camera {
            framing: softbox::camera::Framing::Horizontal(1e-7),
            ..camera
        };
        let scene = prepared(&builder.finish());
        for mode in Mode::ALL {
            let estimate = measure(&scene, &camera, settings(mode, MaxDepth(1)), 1000);
            let exact = 0.5 / PI * irradiance;
            assert!(
                (estimate.mean(0) / exact - 1.0).abs() < 1e-6,
                "{name} {mode:?}: {} {exact}",
                estimate.mean(0)
            );
            assert!(estimate.standard_error(0) < 1e-6 * exact);
        }
    }
}

#[test]
fn light_trapped_between_perfect_mirrors_ends() {
    let mut builder = SceneBuilder::new("mirrors");
    let mirror = builder.surface(
        "mirror",
        Surface::Mirror {
            reflectance: Rgb::ONE,
        },
    );
    builder.sphere("room", DVec3::ZERO, 1.0, mirror);
    let scene = prepared(&builder.finish());
    let camera = camera(DVec3::new(0.2, 0.1, 0.0), DVec3::X, 60.0);
    let estimate = measure(
        &scene,
        &camera,
        settings(Mode::Best, MaxDepth::INFINITE),
        1000,
    );
    assert_eq!(estimate.mean(0), 0.0, "no light was let in");
}
