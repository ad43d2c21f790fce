//! Test S3: the solid angle of a light, once from its sampler's densities, once in closed form.

use glam::{DVec3, Vec2, Vec3};
use softbox::color::Rgb;
use softbox::geometry::{Shapes, Sphere};
use softbox::light::{AreaLight, AreaShape, Light, LightSampleContext, SphereLight};
use softbox::sampling::{PathSampler, Slot, uniform_sphere};

/// The mean of 1/pdf over an even grid of random numbers: the solid angle that is sampled.
fn sampled_solid_angle(shapes: &Shapes, light: &Light) -> f64 {
    let n: u16 = 48;
    let mut sum = 0.0;
    for i in 0..n {
        for j in 0..n {
            let u = Vec2::new(f32::from(i) + 0.5, f32::from(j) + 0.5) / f32::from(n);
            let sample = light.sample(shapes, &LightSampleContext::all_around(Vec3::ZERO), 0.5, u);
            sum += sample.map_or(0.0, |s| 1.0 / f64::from(s.pdf));
        }
    }
    sum / f64::from(n).powi(2)
}

/// Van Oosterom and Strackee 1983, "The Solid Angle of a Plane Triangle", equation 8, from the
/// origin; positive from the front.
fn triangle_solid_angle(corners: [Vec3; 3]) -> f64 {
    let [a, b, c] = corners.map(|p| p.as_dvec3().normalize());
    let triple = (a).cross(b - a).dot(c - a);
    let below = 1.0 + a.dot(b) + b.dot(c) + c.dot(a);
    -2.0 * triple.atan2(below)
}

fn random_direction(i: u32, what: u32) -> Vec3 {
    uniform_sphere(PathSampler::new(77, [i, what], 0).get_2d(0, Slot::Scatter))
}

/// Sizes and distances over six decades, the light turned at random, its distance at least its size.
#[test]
fn area_and_solid_angle_measures_agree() {
    for i in 0..200 {
        let size = 10.0_f32.powf((i % 7) as f32 - 3.0);
        let distance = size * (1.0 + (i % 13) as f32 * 3.0);
        let p0 = distance * random_direction(i, 0);
        let (edge_u, edge_v) = (size * random_direction(i, 1), size * random_direction(i, 2));
        let (p1, p2, p3) = (p0 + edge_u, p0 + edge_v, p0 + edge_u + edge_v);

        let none = Shapes::default();
        let shape = AreaShape::Rectangle {
            corner: p0,
            edge_u,
            edge_v,
        };
        let rectangle = Light::Area(AreaLight::new(&none, shape, Rgb::ONE, true));
        let half = triangle_solid_angle([p0, p1, p2]);
        let exact = half + triangle_solid_angle([p1, p3, p2]);
        compare(
            "rectangle",
            sampled_solid_angle(&none, &rectangle),
            exact.abs(),
        );

        let shapes = Shapes {
            positions: vec![p0, p1, p2],
            triangles: vec![[0, 1, 2]],
            spheres: vec![],
        };
        let shape = AreaShape::Triangles {
            primitives: vec![0],
        };
        let front = Light::Area(AreaLight::new(&shapes, shape, Rgb::ONE, false));
        compare(
            "triangle",
            sampled_solid_angle(&shapes, &front),
            half.max(0.0),
        );

        let radius = size * 0.9;
        let shapes = Shapes {
            spheres: vec![Sphere { center: p0, radius }],
            ..none
        };
        let light = SphereLight {
            primitive: 0,
            radiance: Rgb::ONE,
            two_sided: false,
        };
        let sin2 = (f64::from(radius) / p0.as_dvec3().length()).powi(2);
        let exact = std::f64::consts::TAU * sin2 / (1.0 + (1.0 - sin2).sqrt());
        compare(
            "sphere",
            sampled_solid_angle(&shapes, &Light::Sphere(light)),
            exact,
        );
    }
}

fn compare(what: &str, sampled: f64, exact: f64) {
    // Seen on edge both vanish, and f32 corners decide what is left.
    let fits = (sampled - exact).abs() <= 1e-3 * exact + 1e-7;
    assert!(fits, "{what}: {sampled} against {exact}");
}

#[test]
fn the_octant_is_an_eighth_of_the_sphere() {
    let octant = triangle_solid_angle([Vec3::X, Vec3::Z, Vec3::Y]);
    assert!((octant - 0.5 * std::f64::consts::PI).abs() < 1e-12);
    assert!(DVec3::X.is_normalized());
}
