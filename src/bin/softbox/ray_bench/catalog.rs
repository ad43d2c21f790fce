use std::path::Path;

use anyhow::anyhow;
use glam::Vec3;
use softbox::geometry::Shapes;
use softbox::io::load_scene;

use super::mesh::{add_box, add_quad, append, bumps, geodesic, knot, serpent};
use super::subject::OFFSET;
use super::{Random, Subject};

/// The generated scenes, by size; the number of triangles is about what the name says.
pub(crate) const SCENES: [&str; 9] = [
    "box36",
    "ico10k",
    "knot70k",
    "dragon100k",
    "slivers",
    "city",
    "ico1m",
    "stadium",
    "knot5m",
];

/// The scene called `name`: one of [`SCENES`], or a file.
///
/// # Errors
/// When there is no such scene or the file cannot be read.
pub(crate) fn subject(name: &str) -> anyhow::Result<Subject> {
    Ok(match name {
        "box36" => in_box(name, &two_blocks(), 1.0),
        "ico10k" => in_box(name, &ball(22, 0.0), 0.6),
        "knot70k" => in_box(name, &knot(500, 70, 0.0), 0.95),
        "dragon100k" => in_box(name, &serpent(), 1.0),
        "slivers" => in_box(name, &slivers(), 1.0),
        "city" => city(name),
        "ico1m" => in_box(name, &ball(223, 0.01), 0.6),
        "stadium" => stadium(name),
        "knot5m" => in_box(name, &knot(5000, 500, 0.01), 0.95),
        _ if Path::new(name).extension().is_some() => {
            let mut ignore_progress = |_| std::ops::ControlFlow::Continue(());
            let loaded = load_scene(Path::new(name), &mut ignore_progress)?;
            Subject::of_scene(loaded.scene)?
        }
        _ => {
            let known = SCENES.join(", ");
            return Err(anyhow!("no scene '{name}'; give a file or one of {known}"));
        }
    })
}

/// A bumpy ball of 20 `n`² triangles.
fn ball(n: u32, fine: f64) -> Shapes {
    geodesic(n, |d| 1.0 + bumps(d, fine))
}

/// `object` in a box from -1 to 1, open at the front, with a lamp under the ceiling: 12 triangles
/// more.
fn in_box(name: &str, object: &Shapes, scale: f32) -> Subject {
    let lower = Vec3::new(
        0.0,
        if object.triangles.len() > 100 {
            -0.2
        } else {
            0.0
        },
        0.0,
    );
    let mut shapes = Shapes::default();
    append(&mut shapes, object, scale, lower);
    add_box(&mut shapes, Vec3::NEG_ONE, Vec3::ONE, true);
    let lamp = [Vec3::new(-0.3, 0.98, -0.3), Vec3::X * 0.6, Vec3::Z * 0.6];
    add_quad(&mut shapes, lamp[0], lamp[1], lamp[2]);
    let view = (Vec3::new(0.15, 0.1, 3.3), Vec3::new(0.0, -0.1, 0.0), 42.0);
    Subject::generated(name, shapes, view, lamp, OFFSET)
}

fn two_blocks() -> Shapes {
    let mut shapes = Shapes::default();
    let blocks = [
        (Vec3::new(-0.6, -1.0, -0.5), Vec3::new(-0.05, 0.1, 0.0)),
        (Vec3::new(0.1, -1.0, 0.0), Vec3::new(0.6, -0.4, 0.5)),
    ];
    for (min, max) in blocks {
        add_box(&mut shapes, min, max, false);
    }
    shapes
}

/// 60 000 long thin triangles in all directions, as a ball of wool.
fn slivers() -> Shapes {
    let mut random = Random::new(7);
    let mut shapes = Shapes::default();
    for _ in 0..60_000 {
        let middle = Vec3::new(
            random.between(-0.8, 0.8),
            random.between(-0.6, 0.8),
            random.between(-0.8, 0.8),
        );
        let along = random.direction();
        let across = along.cross(random.direction()).normalize_or(Vec3::Y);
        let half = along * random.between(0.25, 0.6);
        let i = shapes.positions.len() as u32;
        let corners = [
            middle - half,
            middle + half,
            middle + half * 0.2 + across * 0.003,
        ];
        // The box puts its content 0.2 lower.
        let (min, max) = (Vec3::new(-0.95, -0.75, -0.95), Vec3::new(0.95, 1.15, 0.95));
        shapes.positions.extend(corners.map(|p| p.clamp(min, max)));
        shapes.triangles.push([i, i + 1, i + 2]);
    }
    shapes
}

/// A million small triangles in one corner of a hall of twelve.
fn stadium(name: &str) -> Subject {
    let mut shapes = Shapes::default();
    append(
        &mut shapes,
        &ball(223, 0.01),
        0.3,
        Vec3::new(0.7, 0.4, -0.4),
    );
    let (min, max) = (Vec3::new(-60.0, 0.0, -60.0), Vec3::new(60.0, 40.0, 60.0));
    add_box(&mut shapes, min, max, false);
    let lamp = [Vec3::new(-8.0, 39.5, -8.0), Vec3::X * 16.0, Vec3::Z * 16.0];
    let view = (Vec3::new(1.9, 1.0, 1.4), Vec3::new(0.8, 0.45, -0.4), 40.0);
    Subject::generated(name, shapes, view, lamp, 10.0 * OFFSET)
}

/// 40 000 houses with walls along the axes.
fn city(name: &str) -> Subject {
    const HOUSES: u8 = 200;
    let mut random = Random::new(11);
    let mut shapes = Shapes::default();
    let size = f32::from(HOUSES) + 20.0;
    add_quad(
        &mut shapes,
        Vec3::new(-10.0, 0.0, -10.0),
        Vec3::X * size,
        Vec3::Z * size,
    );
    for (i, j) in (0..HOUSES).flat_map(|i| (0..HOUSES).map(move |j| (i, j))) {
        let corner = Vec3::new(
            f32::from(i) + random.between(0.0, 0.1),
            0.0,
            f32::from(j) + random.between(0.0, 0.1),
        );
        let tower = if random.unit() < 0.03 { 4.0 } else { 0.0 };
        let height = 0.3 + 3.0 * random.unit() * random.unit() + tower;
        let [width, depth] = [0; 2].map(|_| random.between(0.45, 0.8));
        add_box(
            &mut shapes,
            corner,
            corner + Vec3::new(width, height, depth),
            false,
        );
    }
    let lamp = [Vec3::splat(60.0), Vec3::X * 40.0, Vec3::Z * 40.0];
    add_quad(&mut shapes, lamp[0], lamp[1], lamp[2]);
    let view = (
        Vec3::new(92.0, 9.0, 112.0),
        Vec3::new(110.0, 1.0, 80.0),
        55.0,
    );
    Subject::generated(name, shapes, view, lamp, 10.0 * OFFSET)
}
