use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::{ball, irradiance, random, seen_from};

/// C7 of the closed forms: E = π (r/d)² cos θ, near and far.
#[test]
fn a_sphere_gives_its_solid_angle_formula() {
    for (radius, distance) in [(0.5, 0.6), (1.0, 3.0), (0.01, 2.0), (1e-3, 30.0)] {
        let axis = Vec3::new(0.48, 0.8, 0.36);
        let (shapes, light) = ball(axis * distance, radius, false);
        // The whole sphere is above the horizon only for these.
        let normal = if radius / distance < 0.7 {
            Vec3::Y
        } else {
            axis
        };
        let e = irradiance(&light, &shapes, Vec3::ZERO, normal);
        let exact = f64::from(PI * (radius / distance).powi(2) * normal.dot(axis));
        assert!(
            (e / exact - 1.0).abs() < 1e-4,
            "{radius} {distance}: {e} {exact}"
        );
    }
}

/// Test S3 of the stress list: the cone of the sphere and its solid angle in area measure agree, and
/// the sampled point lies on the sphere, on the ray, on the near side.
#[test]
fn sphere_samples_lie_on_the_sphere_and_on_the_ray() {
    for (radius, distance) in [(1.0_f32, 1.001), (1.0, 2.0), (1e-2, 3.0), (1e-4, 3.0)] {
        let (shapes, light) = ball(Vec3::new(0.3, -0.2, distance), radius, false);
        for i in 0..20_000 {
            let (choice, u) = random(i);
            let from = Vec3::new(0.3, -0.2, 0.0);
            let s = light
                .sample(&shapes, &seen_from(from), choice, u)
                .expect("seen from outside");
            let on_ray = from + s.wi * s.distance;
            assert!(
                (on_ray - s.point).length() < 2e-3 * radius + 1e-6,
                "{radius} {distance}"
            );
            assert!((s.normal.length() - 1.0).abs() < 1e-5 && s.normal.dot(s.wi) < 2e-3);
        }
    }
}

#[test]
fn inside_a_sphere_light_there_is_light_only_if_it_is_two_sided() {
    let (shapes, dark) = ball(Vec3::ZERO, 2.0, false);
    let (_, lit) = ball(Vec3::ZERO, 2.0, true);
    let from = Vec3::new(0.5, 1.0, -0.7);
    assert!(
        dark.sample(&shapes, &seen_from(from), 0.5, Vec2::splat(0.4))
            .is_none()
    );
    let e = irradiance(&lit, &shapes, from, Vec3::Y);
    assert!((e / f64::from(PI) - 1.0).abs() < 1e-3, "{e}");
    for i in 0..1000 {
        let (choice, u) = random(i);
        let s = lit
            .sample(&shapes, &seen_from(from), choice, u)
            .expect("lit everywhere");
        assert!((s.point.length() - 2.0).abs() < 1e-5);
        assert!((from + s.wi * s.distance - s.point).length() < 1e-5);
    }
}
