use std::f32::consts::PI;
use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::*;
use crate::geometry::Sphere;
use crate::image::Image;
use crate::sampling::{ONE_MINUS_EPSILON, PathSampler, Slot};

fn random(i: u32) -> (f32, Vec2) {
    let numbers = PathSampler::new(21, [i, 0], 0);
    let choice = numbers.get_1d(0, Slot::LightChoice(0));
    (choice, numbers.get_2d(0, Slot::LightPoint(0)))
}

fn corners() -> impl Iterator<Item = Vec2> {
    let edge = [0.0, f32::EPSILON * 0.5, 0.5, ONE_MINUS_EPSILON];
    edge.into_iter()
        .flat_map(move |x| edge.into_iter().map(move |y| Vec2::new(x, y)))
}

/// The unit square at height 1 over the origin, looking down.
fn square() -> AreaShape {
    AreaShape::Rectangle {
        corner: Vec3::new(-0.5, 1.0, -0.5),
        edge_u: Vec3::X,
        edge_v: Vec3::Z,
    }
}

/// The same square as two triangles, and a zero-area triangle that must not matter.
fn square_of_triangles() -> (Shapes, AreaShape) {
    let at = |x: f32, z: f32| Vec3::new(x - 0.5, 1.0, z - 0.5);
    let shapes = Shapes {
        positions: vec![at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)],
        triangles: vec![[0, 1, 2], [1, 1, 2], [0, 2, 3]],
        spheres: vec![],
    };
    let shape = AreaShape::Triangles {
        primitives: vec![0, 1, 2],
    };
    (shapes, shape)
}

fn ball(center: Vec3, radius: f32, two_sided: bool) -> (Shapes, Light) {
    let shapes = Shapes {
        spheres: vec![Sphere { center, radius }],
        ..Shapes::default()
    };
    let light = SphereLight {
        primitive: 0,
        radiance: Rgb::ONE,
        two_sided,
    };
    (shapes, Light::Sphere(light))
}

/// The irradiance at `from` on a surface of normal `normal`, by an even grid of random numbers.
fn irradiance(light: &Light, shapes: &Shapes, from: Vec3, normal: Vec3) -> f64 {
    let n: u16 = 300;
    let mut sum = 0.0;
    for k in 0..u32::from(n) * u32::from(n) {
        let (i, j) = (k % u32::from(n), k / u32::from(n));
        let u = Vec2::new(i as f32 + 0.5, j as f32 + 0.5) / f32::from(n);
        let choice = (k as f32 * 0.618_034).fract();
        if let Some(s) = light.sample(shapes, from, choice, u) {
            sum += f64::from(s.radiance.x * normal.dot(s.wi).max(0.0) / s.pdf);
        }
    }
    sum / f64::from(n).powi(2)
}

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
                .sample(&shapes, from, choice, u)
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
    assert!(dark.sample(&shapes, from, 0.5, Vec2::splat(0.4)).is_none());
    let e = irradiance(&lit, &shapes, from, Vec3::Y);
    assert!((e / f64::from(PI) - 1.0).abs() < 1e-3, "{e}");
    for i in 0..1000 {
        let (choice, u) = random(i);
        let s = lit
            .sample(&shapes, from, choice, u)
            .expect("lit everywhere");
        assert!((s.point.length() - 2.0).abs() < 1e-5);
        assert!((from + s.wi * s.distance - s.point).length() < 1e-5);
    }
}

/// C13 of the closed forms, and the cone of a spot light.
#[test]
fn point_spot_and_directional_lights_are_exact() {
    let none = Shapes::default();
    let intensity = Rgb::new(2.0, 3.0, 4.0);
    let point = Light::Point(PointLight {
        position: Vec3::Y * 2.0,
        intensity,
    });
    let s = point
        .sample(&none, Vec3::ZERO, 0.0, Vec2::ZERO)
        .expect("lit");
    assert_eq!(
        (s.radiance, s.wi, s.distance, s.pdf),
        (intensity / 4.0, Vec3::Y, 2.0, 1.0)
    );
    assert!(s.is_delta && point.is_delta() && !point.is_infinite());
    assert!(
        point
            .sample(&none, Vec3::Y * 2.0, 0.0, Vec2::ZERO)
            .is_none()
    );

    let spot = SpotLight {
        position: Vec3::Y * 2.0,
        axis: Vec3::NEG_Y,
        intensity,
        cos_half_angle: 0.8,
        exponent: 2.0,
    };
    let at = |x: f32| Light::Spot(spot).sample(&none, Vec3::X * x, 0.0, Vec2::ZERO);
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
    let s = sun.sample(&none, Vec3::ONE, 0.0, Vec2::ZERO).expect("lit");
    assert_eq!(
        (s.radiance, s.wi, s.distance),
        (intensity, Vec3::X, f32::INFINITY)
    );
    assert!(sun.is_infinite() && sun.is_delta());
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

/// Test S6 of the stress list: in the plane of the light, on it, at its corner, extremely near; and
/// lights of no area, no colour or with NaN.
#[test]
fn degenerate_placements_give_usable_samples_or_none() {
    let (shapes, triangles) = square_of_triangles();
    let (ball_shapes, sphere) = ball(Vec3::Y, 0.5, true);
    let flat = AreaShape::Rectangle {
        corner: Vec3::ZERO,
        edge_u: Vec3::X,
        edge_v: Vec3::X,
    };
    let area = |shape: AreaShape, two_sided| {
        Light::Area(AreaLight::new(&shapes, shape, Rgb::ONE, two_sided))
    };
    let lights = [
        (area(square(), true), &shapes),
        (area(triangles, true), &shapes),
        (area(flat.clone(), true), &shapes),
        (sphere, &ball_shapes),
    ];
    let height = 1.0_f32;
    let places = [
        Vec3::new(0.0, height, 0.0),
        Vec3::new(-0.5, height, -0.5),
        Vec3::new(3.0, height, 0.2),
        Vec3::new(0.0, height.next_down(), 0.0),
        Vec3::new(0.0, height.next_up(), 0.0),
        Vec3::new(0.0, 0.5, 0.0),
        Vec3::new(0.0, 0.5_f32.next_down(), 0.0),
        Vec3::new(1e30, 0.0, 0.0),
        Vec3::splat(f32::NAN),
    ];
    for (light, shapes) in lights {
        for from in places {
            for u in corners() {
                let Some(s) = light.sample(shapes, from, u.x, u) else {
                    continue;
                };
                assert!(s.pdf > 0.0 && s.pdf.is_finite() && s.distance > 0.0);
                assert!(s.wi.is_finite() && s.point.is_finite() && s.normal.is_finite());
            }
        }
    }
    assert_eq!(area(flat, true).power(&shapes, 1.0), 0.0);
    let broken = [Rgb::ZERO, Rgb::splat(f32::NAN)].map(|radiance| {
        Light::Area(AreaLight::new(&shapes, square(), radiance, false)).power(&shapes, 1.0)
    });
    let sampler = LightSampler::new(&[broken[0], 1.0, broken[1], 3.0]);
    for i in 0..1000 {
        let (index, pmf) = sampler.sample(i as f32 / 1000.0);
        assert_eq!((index, pmf), if i < 250 { (1, 0.25) } else { (3, 0.75) });
    }
    assert_eq!(LightSampler::new(&broken).sample(0.5), (0, 0.0));
    assert_eq!(sampler.pmf(0) + sampler.pmf(7), 0.0);
}

fn picture() -> Arc<Image<Rgb>> {
    let pixels = (0..16 * 8)
        .map(|i| match i {
            0..16 | 48..64 => Rgb::ZERO,
            100 => Rgb::splat(500.0),
            _ => Rgb::new(0.1, 0.2, 0.3) * (i % 7) as f32,
        })
        .collect();
    Arc::new(Image::from_pixels(16, 8, pixels))
}

/// The orientation that the importer promises: top row at +y, column φ/2π, φ = atan2(−z, x) + π.
#[test]
fn the_picture_is_the_right_way_up_and_round() {
    let mut pixels = vec![Rgb::ZERO; 8 * 4];
    for (i, pixel) in pixels.iter_mut().enumerate() {
        *pixel = Rgb::splat(i as f32);
    }
    let map = Arc::new(Image::from_pixels(8, 4, pixels));
    let light = EnvironmentLight::new(Rgb::ZERO, Rgb::ZERO, Some(map));
    let seen = |x: f32, y: f32, z: f32| light.radiance(Vec3::new(x, y, z).normalize(), true).x;
    assert_eq!(seen(0.0, 1.0, 0.0) as usize / 8, 0);
    assert_eq!(seen(0.0, -1.0, 0.0) as usize / 8, 3);
    // φ just above π along +x; −z is a quarter turn further.
    assert_eq!(seen(1.0, 0.1, -0.1) as usize, 8 + 4);
    assert_eq!(seen(0.1, 0.1, -1.0) as usize, 8 + 5);
    assert_eq!(seen(-0.1, 0.1, 1.0) as usize, 8 + 1);
}

/// C9 of the closed forms, with b = 0: sky and ambient; the camera does not see the ambient part.
#[test]
fn constant_environments_give_their_irradiance() {
    let none = Shapes::default();
    let light = Light::Environment(EnvironmentLight::new(
        Rgb::splat(0.5),
        Rgb::splat(2.0),
        None,
    ));
    let e = irradiance(&light, &none, Vec3::ZERO, Vec3::Y);
    assert!((e / f64::from(2.5 * PI) - 1.0).abs() < 0.02, "{e}");
    assert_eq!(light.radiance_from_infinity(Vec3::Y, true), Rgb::splat(0.5));
    assert_eq!(
        light.radiance_from_infinity(Vec3::Y, false),
        Rgb::splat(2.5)
    );
    assert_eq!(
        light.radiance_from_infinity(Vec3::NEG_Y, false),
        Rgb::splat(0.5)
    );
    assert!((light.power(&none, 1.0) / (PI * PI * 6.0) - 1.0).abs() < 1e-5);
    let black = Light::Environment(EnvironmentLight::new(Rgb::ZERO, Rgb::ZERO, None));
    assert!(
        black
            .sample(&none, Vec3::ZERO, 0.5, Vec2::splat(0.5))
            .is_none()
    );
    assert_eq!((black.power(&none, 1.0), black.is_infinite()), (0.0, true));
}

/// A picture alone is sampled without variance: luminance over density is its flux.
#[test]
fn the_picture_is_its_own_density() {
    let none = Shapes::default();
    let light = Light::Environment(EnvironmentLight::new(Rgb::ZERO, Rgb::ZERO, Some(picture())));
    let flux = light.power(&none, 1.0) / PI;
    let every_number = (0..20_000).map(random).chain(corners().map(|u| (u.x, u)));
    for (choice, u) in every_number {
        let Some(s) = light.sample(&none, Vec3::ZERO, choice, u) else {
            continue;
        };
        assert!((s.wi.length() - 1.0).abs() < 1e-6);
        let ratio = crate::color::luminance(s.radiance) / s.pdf;
        assert!((ratio / flux - 1.0).abs() < 1e-4, "{u}: {ratio} {flux}");
    }
}
