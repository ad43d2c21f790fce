use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::seen_from;
use crate::color::Rgb;
use crate::geometry::Shapes;
use crate::light::{DirectionalLight, Light, PointFalloff, PointLight, SpotLight};

/// C13 of the closed forms, and the cone of a spot light.
#[test]
fn point_spot_and_directional_lights_are_exact() {
    let none = Shapes::default();
    let intensity = Rgb::new(2.0, 3.0, 4.0);
    let point = Light::Point(PointLight {
        position: Vec3::Y * 2.0,
        intensity,
        falloff: PointFalloff::Correct,
    });
    let s = point
        .sample(&none, &seen_from(Vec3::ZERO), 0.0, Vec2::ZERO)
        .expect("lit");
    assert_eq!(
        (s.radiance, s.wi, s.distance, s.pdf),
        (intensity / 4.0, Vec3::Y, 2.0, 1.0)
    );
    assert!(s.is_delta && point.is_delta() && !point.is_infinite());
    assert!(
        point
            .sample(&none, &seen_from(Vec3::Y * 2.0), 0.0, Vec2::ZERO)
            .is_none()
    );

    let spot = SpotLight {
        position: Vec3::Y * 2.0,
        axis: Vec3::NEG_Y,
        intensity,
        cos_half_angle: 0.8,
        exponent: 2.0,
    };
    let at = |x: f32| Light::Spot(spot).sample(&none, &seen_from(Vec3::X * x), 0.0, Vec2::ZERO);
    let s = at(1.0).expect("inside the cone");
    assert!(
        (s.radiance - intensity * 0.8 / 5.0).length() < 1e-6,
        "cos² = 4/5, r² = 5"
    );
    assert!(at(1.6).is_none(), "outside the cone");
    let flux: f32 = (0..100_000)
        .map(|i| 1.0 - 0.2 * (i as f32 + 0.5) / 100_000.0)
        .map(|cos| cos * cos * 2.0 * PI * 0.2 / 100_000.0)
        .sum();
    let power = Light::Spot(SpotLight {
        intensity: Rgb::ONE,
        ..spot
    })
    .power(&none, 1.0);
    assert!((power / flux - 1.0).abs() < 1e-3, "{power} {flux}");

    let sun = Light::Directional(DirectionalLight {
        to_light: Vec3::X,
        irradiance: intensity,
    });
    let s = sun
        .sample(&none, &seen_from(Vec3::ONE), 0.0, Vec2::ZERO)
        .expect("lit");
    assert_eq!(
        (s.radiance, s.wi, s.distance),
        (intensity, Vec3::X, f32::INFINITY)
    );
    assert!(sun.is_infinite() && sun.is_delta());
}
