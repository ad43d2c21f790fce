//! Small scenes for the tests.

use std::f64::consts::PI;

use glam::DVec3;
use softbox::color::Rgb;
use softbox::scene::{Material, SceneBuilder, Surface};

/// A surface that reflects and emits, on both sides.
pub fn glowing(builder: &mut SceneBuilder, reflectance: f32, radiance: f32) -> usize {
    builder.material(Material {
        name: "glowing".to_owned(),
        surface: Surface::Diffuse {
            reflectance: Rgb::splat(reflectance),
        },
        emission: Rgb::splat(radiance),
        double_sided: true,
    })
}

/// A sphere of triangles around the origin between two polar angles, front outside.
pub fn sphere_mesh(
    radius: f64,
    theta: (f64, f64),
    rows: u32,
    columns: u32,
) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut positions = Vec::new();
    for row in 0..=rows {
        let t = theta.0 + (theta.1 - theta.0) * f64::from(row) / f64::from(rows);
        for column in 0..columns {
            let phi = 2.0 * PI * f64::from(column) / f64::from(columns);
            positions.push(radius * DVec3::new(t.sin() * phi.cos(), t.cos(), t.sin() * phi.sin()));
        }
    }
    let vertex = |row: u32, column: u32| row * columns + column % columns;
    let triangles = (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (row, column)))
        .flat_map(|(r, c)| {
            let [a, b, d, e] = [
                vertex(r, c),
                vertex(r, c + 1),
                vertex(r + 1, c + 1),
                vertex(r + 1, c),
            ];
            [[a, b, d], [a, d, e]]
        })
        .collect();
    (positions, triangles)
}

/// The same triangles seen from the other side.
pub fn inside_out(triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    triangles.iter().map(|&[a, b, c]| [a, c, b]).collect()
}
