//! Scenes made by formula, so that a large BVH is worth looking at without any download.

use std::f64::consts::TAU;

use glam::DVec3;

use super::{Scene, SceneBuilder};
use crate::color::Rgb;

/// Names of the procedural scenes and what they show.
pub const PROCEDURAL: [(&str, &str); 2] = [
    (
        "knot-70k",
        "a torus knot of 70 000 triangles in a Cornell box",
    ),
    (
        "knot-1m",
        "a torus knot of 1 000 000 triangles in a Cornell box",
    ),
];

/// The procedural scene called `name`, one of [`PROCEDURAL`].
pub fn procedural(name: &str) -> Option<Scene> {
    match name {
        "knot-70k" => Some(cornell_knot(name, 1000, 35)),
        "knot-1m" => Some(cornell_knot(name, 5000, 100)),
        _ => None,
    }
}

/// A Cornell box (2 × 1.5 × 2, open towards +z, one-sided light below the ceiling) without
/// anything in it; materials white, red, blue, light.
pub fn cornell_box(name: &str) -> SceneBuilder {
    let mut builder = SceneBuilder::new(name);
    let white = builder.diffuse("white", Rgb::splat(0.6));
    let red = builder.diffuse("red", Rgb::new(0.6, 0.2, 0.2));
    let blue = builder.diffuse("blue", Rgb::new(0.2, 0.2, 0.6));
    let light = builder.emitter("light", Rgb::splat(10.0));
    let (x, y, z) = (DVec3::X * 2.0, DVec3::Y * 1.5, DVec3::Z * 2.0);
    let corner = DVec3::new(-1.0, 0.0, -1.0);
    builder.quad("floor", corner, z, x, white);
    builder.quad("ceiling", corner + y, x, z, white);
    builder.quad("back wall", corner, x, y, white);
    builder.quad("left wall", corner, y, z, red);
    builder.quad("right wall", corner + x, z, y, blue);
    builder.quad(
        "light",
        DVec3::new(-0.3, 1.49, -0.4),
        DVec3::X * 0.6,
        DVec3::Z * 0.8,
        light,
    );
    builder.camera(
        DVec3::new(0.0, 0.75, 4.8),
        DVec3::new(0.0, 0.75, 0.0),
        31_f64.to_radians(),
    );
    builder
}

fn cornell_knot(name: &str, along: u32, around: u32) -> Scene {
    let mut builder = cornell_box(name);
    let object = builder.diffuse("object", Rgb::splat(0.8));
    let (positions, triangles) = knot(along, around);
    builder.mesh("knot", positions, &triangles, object);
    builder.finish()
}

/// A (2, 3) torus knot as a tube: `along` × `around` quads, two triangles each.
fn knot(along: u32, around: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let center = DVec3::new(0.0, 0.62, 0.0);
    let curve = |t: f64| {
        let r = 0.36 + 0.16 * (3.0 * t).cos();
        center
            + DVec3::new(
                r * (2.0 * t).cos(),
                r * (2.0 * t).sin(),
                0.22 * (3.0 * t).sin(),
            )
    };
    let mut positions = Vec::with_capacity((along * around) as usize);
    for i in 0..along {
        let t = TAU * f64::from(i) / f64::from(along);
        let tangent = (curve(t + 1e-4) - curve(t - 1e-4)).normalize_or(DVec3::X);
        let side = tangent.cross(DVec3::Z).normalize_or(DVec3::Y);
        let up = tangent.cross(side);
        for j in 0..around {
            let (sin, cos) = (TAU * f64::from(j) / f64::from(around)).sin_cos();
            positions.push(curve(t) + 0.085 * (side * cos + up * sin));
        }
    }
    let vertex = |i: u32, j: u32| (i % along) * around + j % around;
    let triangles = (0..along)
        .flat_map(|i| (0..around).map(move |j| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [
                vertex(i, j),
                vertex(i + 1, j),
                vertex(i + 1, j + 1),
                vertex(i, j + 1),
            ];
            [[a, c, b], [a, d, c]]
        })
        .collect();
    (positions, triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Geometry;

    #[test]
    fn the_knot_is_closed_and_its_front_is_outside() {
        let (positions, triangles) = knot(200, 20);
        assert_eq!(triangles.len(), 8000);
        let volume: f64 = triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| positions[i as usize] - DVec3::new(0.0, 0.62, 0.0));
                a.dot(b.cross(c)) / 6.0
            })
            .sum();
        assert!(volume > 0.0, "counter-clockwise seen from outside");
        let inside = |p: &DVec3| p.x.abs() < 1.0 && p.y > 0.0 && p.y < 1.49 && p.z.abs() < 1.0;
        assert!(positions.iter().all(inside));
    }

    #[test]
    fn every_listed_scene_exists_with_its_size() {
        for ((name, _), expected) in PROCEDURAL.into_iter().zip([70_000, 1_000_000]) {
            let scene = procedural(name).expect("listed");
            let triangles: usize = scene
                .geometries
                .iter()
                .map(|g| match g.as_ref() {
                    Geometry::Mesh(mesh) => mesh.triangles.len(),
                    Geometry::Sphere { .. } => 0,
                })
                .sum();
            assert_eq!(triangles, expected + 12);
        }
    }
}
