use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::{irradiance, random, seen_from, square, square_of_triangles};
use crate::color::Rgb;
use crate::geometry::Shapes;
use crate::light::{AreaDensity, AreaLight, Light, LightHit};

/// C5 of the closed forms, as one rectangle and as triangles.
#[test]
fn a_square_over_a_plane_gives_the_polygon_formula() {
    let (shapes, triangles) = square_of_triangles();
    for shape in [square(), triangles] {
        let light = Light::Area(AreaLight::new(&shapes, shape, Rgb::ONE, false));
        let e = irradiance(&light, &shapes, Vec3::ZERO, Vec3::Y);
        assert!((e - 0.752_274_7).abs() < 1e-3, "{e}");
        assert!((light.power(&shapes, 9.0) - PI).abs() < 1e-5);
        assert!(
            light
                .sample(&shapes, &seen_from(Vec3::Y * 2.0), 0.3, Vec2::splat(0.3))
                .is_none()
        );
        assert_eq!(
            light.radiance_at(
                LightHit {
                    normal: Vec3::NEG_Y,
                    ..LightHit::INFINITE
                },
                Vec3::Y
            ),
            Rgb::ONE
        );
        assert_eq!(
            light.radiance_at(
                LightHit {
                    normal: Vec3::NEG_Y,
                    ..LightHit::INFINITE
                },
                Vec3::NEG_Y
            ),
            Rgb::ZERO
        );
    }
}

/// The course's density makes light fall off as 1/r: the estimate is too bright by the distance.
#[test]
fn the_course_density_lacks_one_factor_of_the_distance() {
    let none = Shapes::default();
    let even = AreaLight::new(&none, square(), Rgb::ONE, false).with_density(AreaDensity::Course);
    let light = Light::Area(even);
    let from = Vec3::new(0.7, -2.0, 0.1);
    for i in 0..100 {
        let (choice, u) = random(i);
        let s = light
            .sample(&none, &seen_from(from), choice, u)
            .expect("below the light");
        let cos = s.normal.dot(-s.wi);
        let correct = s.distance * s.distance / cos;
        assert!((correct / s.pdf / s.distance - 1.0).abs() < 1e-5);
        assert_eq!(s.point, Vec3::new(u.x - 0.5, 1.0, u.y - 0.5));
    }
}
