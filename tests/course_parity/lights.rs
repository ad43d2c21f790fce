//! Lights as the course's program has them, on a plane at y = 0.

use std::f64::consts::PI;

use glam::{DMat4, DVec3};
use softbox::camera::{Camera, Framing};
use softbox::color::Rgb;
use softbox::integrator::PathSettings;
use softbox::scene::{LightKind, SceneBuilder};
use softbox::settings::{MaxDepth, Mode};

use crate::beside::{picture, prepared_as};

const ALBEDO: f32 = 0.5;

fn plane() -> SceneBuilder {
    let mut builder = SceneBuilder::new("plane");
    let grey = builder.diffuse("grey", Rgb::splat(ALBEDO));
    builder.quad(
        "plane",
        DVec3::new(-4.0, 0.0, -4.0),
        DVec3::Z * 8.0,
        DVec3::X * 8.0,
        grey,
    );
    builder
}

/// Radiance of the origin, seen from above.
fn radiance(builder: SceneBuilder, mode: Mode) -> f64 {
    let camera = Camera {
        eye: DVec3::new(0.5, 2.0, 1.0),
        target: DVec3::ZERO,
        framing: Framing::Horizontal(1e-6),
        ..Camera::default()
    };
    let settings = PathSettings {
        mode,
        light_samples: 1,
        max_depth: MaxDepth(2),
        only_last_bounce: false,
        seed: 0,
        replicates: 1,
        reuse: 1,
    };
    let scene = prepared_as(&builder.finish(), true);
    let (pixels, counts) = picture(&scene, &camera, settings, (2, 2), (0, 4000));
    assert_eq!(counts.invalid_samples, 0);
    pixels.iter().map(|p| p.mean()[0]).sum::<f64>() / 4.0
}

/// What the plane shows of `irradiance`.
fn shown(irradiance: f64) -> f64 {
    f64::from(ALBEDO) / PI * irradiance
}

fn assert_close(found: f64, exact: f64) {
    assert!((found - exact).abs() < 1e-5 * exact, "{found} {exact}");
}

#[test]
fn point_light_does_not_fade() {
    let intensity = Rgb::splat(3.0);
    for height in [0.5, 2.0, 8.0] {
        let mut builder = plane();
        let place = DMat4::from_translation(DVec3::Y * height);
        builder.light("lamp", LightKind::Point { intensity }, place);
        assert_close(radiance(builder, Mode::Importance), shown(3.0));
    }
}

#[test]
fn directional_light_comes_from_where_its_node_stands() {
    let mut builder = plane();
    let irradiance = Rgb::splat(2.0);
    let stand = DVec3::new(1.0, 4.0, -2.0);
    let place = DMat4::from_translation(stand);
    builder.light("sun", LightKind::Directional { irradiance }, place);
    let towards = (stand + DVec3::NEG_Z).normalize();
    assert_close(radiance(builder, Mode::Importance), shown(2.0 * towards.y));
}

#[test]
fn ambient_light_is_sampled_but_never_met() {
    let lit = || {
        let mut builder = plane();
        builder.scene_mut().environment.ambient = Rgb::ONE;
        builder
    };
    assert_eq!(radiance(lit(), Mode::Hemisphere), 0.0);
    let found = radiance(lit(), Mode::Importance);
    assert!((found - 0.5).abs() < 0.02, "{found}");
}

#[test]
fn spot_light_gives_nothing() {
    let mut builder = plane();
    let kind = LightKind::Spot {
        intensity: Rgb::ONE,
        cone_angle: 1.0,
        exponent: 0.0,
    };
    let down = DMat4::from_rotation_x(-PI / 2.0);
    builder.light("spot", kind, DMat4::from_translation(DVec3::Y) * down);
    assert_eq!(radiance(builder, Mode::Importance), 0.0);
}
