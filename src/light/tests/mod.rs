//! Lights against closed forms, and in degenerate placements. What several of the tests need is here.

mod area;
mod degenerate;
mod environment;
mod merge;
mod points;
mod polygon;
mod sampler;
mod sphere;

use glam::{Vec2, Vec3};

use super::{AreaShape, Light, LightSampleContext, SphereLight};
use crate::color::Rgb;
use crate::geometry::{Shapes, Sphere};
use crate::sampling::{ONE_MINUS_EPSILON, PathSampler, Slot};

fn seen_from(point: Vec3) -> LightSampleContext {
    LightSampleContext::all_around(point)
}

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
    let corners = vec![at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
    of_triangles(corners, &[[0, 1, 2], [1, 1, 2], [0, 2, 3]])
}

/// Triangles all of which shine.
fn of_triangles(positions: Vec<Vec3>, triangles: &[[u32; 3]]) -> (Shapes, AreaShape) {
    let shapes = Shapes {
        positions,
        triangles: triangles.to_vec(),
        spheres: vec![],
    };
    let primitives = (0..triangles.len() as u32).collect();
    (shapes, AreaShape::Triangles { primitives })
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
        if let Some(s) = light.sample(shapes, &seen_from(from), choice, u) {
            sum += f64::from(s.radiance.x * normal.dot(s.wi).max(0.0) / s.pdf);
        }
    }
    sum / f64::from(n).powi(2)
}
