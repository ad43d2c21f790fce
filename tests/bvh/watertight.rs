//! G1, G2: no ray leaves a closed mesh.

use glam::Vec3;
use softbox::bvh::{BvhKind, BvhSettings};
use softbox::geometry::Shapes;
use softbox::math::Ray;

use crate::scenes::{self, Random};

/// Rays from inside: a third anywhere, a third at vertices, a third at points of edges.
fn rays_from_inside(shapes: &Shapes, center: Vec3, n: usize, seed: u64) -> Vec<Ray> {
    let mut random = Random::new(seed);
    (0..n)
        .map(|i| {
            let origin = center + random.in_cube() * 0.15;
            let [a, b, c] = shapes.vertices(random.below(shapes.triangles.len()));
            let target = match i % 3 {
                0 => return Ray::new(origin, random.direction()),
                1 => a,
                _ => [(a, b), (b, c), (c, a)].map(|(p, q)| p + (q - p) * random.unit())
                    [random.below(3)],
            };
            // Half of the directions as they come, half of unit length.
            let direction = target - origin;
            Ray::new(
                origin,
                if i % 2 == 0 {
                    direction
                } else {
                    direction.normalize()
                },
            )
        })
        .collect()
}

fn assert_no_leaks(shapes: &Shapes, settings: BvhSettings, rays: &[Ray]) {
    for (variant, aggregate) in scenes::aggregates(shapes, settings) {
        let hits = scenes::closest(&aggregate, rays);
        let leaks = hits.iter().filter(|h| h.is_miss()).count();
        assert_eq!(leaks, 0, "{variant} {settings:?}");
    }
}

/// Traces `n` rays through a tree, a twentieth of them past every triangle.
fn check(shapes: &Shapes, center: Vec3, n: usize) {
    const BATCH: usize = 100_000;
    for (batch, from) in (0..n).step_by(BATCH).enumerate() {
        let rays = rays_from_inside(shapes, center, BATCH.min(n - from), 3 + batch as u64);
        let leaf_size = if batch % 2 == 0 { 4 } else { 1 };
        assert_no_leaks(shapes, scenes::settings(BvhKind::Sah, leaf_size), &rays);
        let brute_force = scenes::settings(BvhKind::None, 1);
        assert_no_leaks(shapes, brute_force, &rays[..rays.len() / 20]);
    }
}

fn check_at_the_origin(n: usize) {
    for shapes in [
        scenes::smooth_sphere(),
        scenes::spiky_sphere(),
        scenes::cube(),
    ] {
        check(&shapes, Vec3::ZERO, n / 3);
    }
}

#[test]
fn g1_no_ray_leaves_a_closed_mesh() {
    check_at_the_origin(2_000_000);
}

#[test]
#[ignore = "the long form, ten million rays"]
fn g1_no_ray_leaves_a_closed_mesh_at_length() {
    check_at_the_origin(10_000_000);
}

#[test]
fn g2_nor_far_from_the_origin() {
    check_far_away(2_000_000);
}

#[test]
#[ignore = "the long form, ten million rays"]
fn g2_nor_far_from_the_origin_at_length() {
    check_far_away(10_000_000);
}

fn check_far_away(n: usize) {
    for center in [Vec3::new(148_376.0, 1_234.0, -223_423.0), Vec3::splat(1e6)] {
        for mut shapes in [
            scenes::smooth_sphere(),
            scenes::spiky_sphere(),
            scenes::cube(),
        ] {
            for p in &mut shapes.positions {
                // The mesh is much larger than the spacing of f32 at its place.
                *p = *p * 100.0 + center;
            }
            check(&shapes, center, n / 6);
        }
    }
}

/// Near a corner of a cube, where the far vertices round much more coarsely than the distance.
#[test]
fn g1_nor_does_a_ray_from_just_before_an_edge() {
    let shapes = scenes::cube();
    let mut random = Random::new(5);
    let rays: Vec<_> = (0..300_000)
        .map(|_| {
            let [a, b, c] = shapes.vertices(random.below(12));
            let on_edge =
                [(a, b), (b, c), (c, a)].map(|(p, q)| p + (q - p) * random.unit())[random.below(3)];
            let near = 10.0_f32.powf(-6.0 * random.unit());
            let origin = on_edge * (1.0 - near) + random.in_cube() * (0.3 * near);
            Ray::new(
                origin.clamp(Vec3::splat(-1.0 + 1e-7), Vec3::splat(1.0 - 1e-7)),
                on_edge - origin,
            )
        })
        .filter(|r| r.direction.length() > 1e-6)
        .collect();
    for kind in [BvhKind::Sah, BvhKind::Median, BvhKind::None] {
        assert_no_leaks(&shapes, scenes::settings(kind, 1), &rays);
    }
}
