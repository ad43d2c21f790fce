use std::f64::consts::PI;

use glam::{DVec3, Vec2, Vec3};

use super::{corners, of_triangles, random, square};
use crate::color::Rgb;
use crate::geometry::Shapes;
use crate::light::{AreaLight, AreaShape, Light, LightSampleContext};

fn panel(corner: Vec3, edge_u: Vec3, edge_v: Vec3) -> Light {
    let shape = AreaShape::Rectangle {
        corner,
        edge_u,
        edge_v,
    };
    let light = AreaLight::new(&Shapes::default(), shape, Rgb::ONE, true);
    Light::Area(light)
}

/// The triangle of three corners, both sides of which shine.
fn triangle(corners: [Vec3; 3]) -> Light {
    let (shapes, shape) = of_triangles(corners.to_vec(), &[[0, 1, 2]]);
    Light::Area(AreaLight::new(&shapes, shape, Rgb::ONE, true))
}

/// Lambert's formula for the irradiance of a polygon of radiance 1 (Lambert 1760, "Photometria"),
/// clipped at the horizon.
fn irradiance(corners: &[Vec3], from: Vec3, normal: Vec3) -> f64 {
    let (from, normal) = (from.as_dvec3(), normal.as_dvec3());
    let mut clipped: Vec<DVec3> = Vec::new();
    for i in 0..corners.len() {
        let [a, b] = [i, (i + 1) % corners.len()].map(|k| corners[k].as_dvec3() - from);
        let (above, below) = (a.dot(normal), b.dot(normal));
        if above >= 0.0 {
            clipped.push(a);
        }
        if (above > 0.0) != (below > 0.0) && above != below {
            clipped.push(a + (b - a) * (above / (above - below)));
        }
    }
    let n = clipped.len();
    let sum: f64 = (0..n)
        .map(|i| {
            let (a, b) = (clipped[i].normalize(), clipped[(i + 1) % n].normalize());
            let edge = a.cross(b);
            edge.length().atan2(a.dot(b)) * edge.normalize_or_zero().dot(normal)
        })
        .sum();
    (0.5 * sum).abs()
}

/// Mean and largest of what samples count for, over an even grid of random numbers.
fn sampled(light: &Light, from: &LightSampleContext) -> (f64, f64) {
    let n: u16 = 200;
    let (mut sum, mut most) = (0.0, 0.0_f64);
    for i in 0..n {
        for j in 0..n {
            let u = Vec2::new(f32::from(i) + 0.5, f32::from(j) + 0.5) / f32::from(n);
            if let Some(s) = light.sample(&Shapes::default(), from, 0.5, u) {
                let value = f64::from(from.normal.dot(s.wi).max(0.0) / s.pdf);
                sum += value;
                most = most.max(value);
            }
        }
    }
    (sum / f64::from(n).powi(2), most)
}

/// From over the light to its edge, from touching to a thousand sizes away, tilted every way; and no
/// sample counts for much more than all light there can be.
#[test]
fn irradiance_is_that_of_the_polygon_formula() {
    let (edge_u, edge_v) = (Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.3, 0.0, 0.6));
    let corner = Vec3::new(-0.6, 0.0, -0.3);
    let outline = [
        corner,
        corner + edge_u,
        corner + edge_u + edge_v,
        corner + edge_v,
    ];
    check_irradiance(&panel(corner, edge_u, edge_v), &outline);
    let outline = [corner, corner + edge_u, corner + 0.7 * edge_v];
    check_irradiance(&triangle(outline), &outline);
}

fn check_irradiance(light: &Light, outline: &[Vec3]) {
    for height in [1e-4, 1e-2, 0.3, 0.9, 1.1, 30.0, 1000.0] {
        for aside in [0.0, 0.39, 0.6, 0.75, 3.0] {
            for normal in [
                Vec3::Y,
                Vec3::new(-0.6, 0.8, 0.0),
                Vec3::new(-1.0, 0.0, 0.0),
                Vec3::new(0.0, -0.6, 0.8),
            ] {
                let point = Vec3::new(aside, -height, 0.05 * aside);
                let exact = irradiance(outline, point, normal);
                let (mean, most) = sampled(light, &LightSampleContext { point, normal });
                let name = format!("{point} {normal}: {mean} for {exact}, at most {most}");
                assert!((mean - exact).abs() < 4e-3 * exact + 1e-6, "{name}");
                assert!(most < 8.0 * PI, "{name}");
            }
        }
    }
}

/// The samples for the corners of the random numbers, all of which must be usable.
fn usable_samples(light: &Light, from: &LightSampleContext) -> usize {
    corners()
        .filter_map(|u| light.sample(&Shapes::default(), from, u.x, u))
        .inspect(|s| {
            assert!(s.pdf > 0.0 && s.pdf.is_finite() && s.distance > 0.0);
            assert!(s.wi.is_finite() && s.point.is_finite());
        })
        .count()
}

/// Test S6 for both warps: anywhere near a plane, an edge or a corner, and for needles.
#[test]
fn densities_are_usable_wherever_the_light_is_seen_from() {
    let lights = [
        panel(Vec3::ZERO, Vec3::X, Vec3::Z),
        panel(Vec3::ZERO, Vec3::X * 1e-6, Vec3::Z * 1e-6),
        panel(Vec3::ZERO, Vec3::X, Vec3::Z * 1e-7),
        panel(Vec3::ZERO, Vec3::X * 1e-7, Vec3::new(0.3, 0.2, 1.0)),
        triangle([Vec3::ZERO, Vec3::X, Vec3::Z]),
        triangle([Vec3::ZERO, Vec3::X * 1e-6, Vec3::Z * 1e-6]),
        triangle([Vec3::ZERO, Vec3::X, Vec3::Z * 1e-7]),
        triangle([Vec3::ZERO, Vec3::X * 1e-7, Vec3::new(0.3, 0.2, 1.0)]),
    ];
    let steps = [0.0, 1e-30, 1e-9, 1e-5, 0.1, 0.5, 1.0, 1.000_001, 3.0, 1e6];
    for light in lights {
        let mut found = 0;
        for (i, x) in steps.into_iter().enumerate() {
            for y in [0.0, 1e-30, 1e-12, -1e-7, 1e-3, -0.3, 1e4] {
                let z = steps[(i * 7 + 3) % steps.len()];
                let point = Vec3::new(x, y, z);
                let (_, turn) = random(i as u32);
                for normal in [Vec3::ZERO, Vec3::Y, Vec3::X, turn.extend(0.3).normalize()] {
                    let from = LightSampleContext { point, normal };
                    found += usable_samples(&light, &from);
                }
            }
        }
        assert!(found > 1000, "{found}");
    }
}

#[test]
fn a_light_below_the_horizon_is_not_sampled() {
    let light = AreaLight::new(&Shapes::default(), square(), Rgb::ONE, false);
    let light = Light::Area(light);
    for height in [0.2, 0.9, -7.0] {
        let from = LightSampleContext {
            point: Vec3::Y * height,
            normal: Vec3::NEG_Y,
        };
        for u in corners() {
            assert!(light.sample(&Shapes::default(), &from, u.x, u).is_none());
        }
    }
}
