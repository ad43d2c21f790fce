use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::{irradiance, random, square, square_of_triangles};
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
                .sample(&shapes, Vec3::Y * 2.0, 0.3, Vec2::splat(0.3))
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
    let right = AreaLight::new(&none, square(), Rgb::ONE, false);
    let wrong = Light::Area(right.clone().with_density(AreaDensity::Course));
    let right = Light::Area(right);
    let from = Vec3::new(0.7, -2.0, 0.1);
    for i in 0..100 {
        let (choice, u) = random(i);
        let r = right
            .sample(&none, from, choice, u)
            .expect("below the light");
        let w = wrong
            .sample(&none, from, choice, u)
            .expect("below the light");
        assert!((r.pdf / w.pdf / r.distance - 1.0).abs() < 1e-5);
    }
}
