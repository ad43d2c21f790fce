//! Two triangles that share an edge are one primitive of the tree: no hit may show it.

use glam::Vec3;
use softbox::bvh::{BvhKind, BvhQuality, BvhSettings};
use softbox::geometry::{Aggregate, Hit, Shapes, TraceCounts};
use softbox::math::Ray;

use crate::scenes::{self, Random, bits};

/// A sheet of `n` × `n` cells in folds, each cut along one diagonal or the other; every seventh cell
/// is flat.
fn folds(n: usize) -> Shapes {
    let mut random = Random::new(21);
    let at = |i: usize| i as f32 / n as f32 * 2.0 - 1.0;
    let positions = (0..=n).flat_map(|j| (0..=n).map(move |i| (i, j)));
    let positions = positions.map(|(i, j)| {
        let height = if (i + j) % 7 < 2 {
            0.0
        } else {
            0.3 * random.unit()
        };
        Vec3::new(at(i), height, at(j))
    });
    let positions = positions.collect();
    let cells = (0..n).flat_map(|j| (0..n).map(move |i| j * (n + 1) + i));
    let triangles = cells.flat_map(|a| {
        let [a, b, c, d] = [a, a + 1, a + n + 2, a + n + 1].map(|i| i as u32);
        if a % 3 == 0 {
            [[b, c, d], [d, a, b]]
        } else {
            [[c, a, b], [d, a, c]]
        }
    });
    Shapes {
        positions,
        triangles: triangles.collect(),
        spheres: Vec::new(),
    }
}

/// A mesh with triangles without area and without numbers, edges of three triangles, triangles that
/// are there twice, and spheres.
fn rough() -> Shapes {
    let mut shapes = scenes::spiky_sphere();
    let again: Vec<_> = shapes.triangles.iter().step_by(3).copied().collect();
    shapes.triangles.extend(again);
    for vertex in [5, 50, 120] {
        shapes.positions[vertex] = shapes.positions[vertex + 1];
    }
    shapes.positions[77] = Vec3::NAN;
    shapes.spheres = scenes::mixed(30).spheres;
    shapes
}

fn meshes() -> [(&'static str, Shapes); 4] {
    [
        ("smooth", scenes::smooth_sphere()),
        ("spiky", scenes::spiky_sphere()),
        ("folds", folds(20)),
        ("rough", rough()),
    ]
    .map(|(name, mut shapes)| {
        shapes.turn_to_quads();
        (name, shapes)
    })
}

/// Rays everywhere, to points on edges and to vertices, and from points of triangles with an interval
/// that begins behind them.
fn rays(shapes: &Shapes) -> Vec<Ray> {
    let mut random = Random::new(9);
    let mut rays = scenes::random_rays(3_000, 31);
    for i in 0..3_000 {
        let [a, b, c] = shapes.vertices(random.below(shapes.triangles.len()));
        let target = match i % 3 {
            0 => a,
            1 => a + (c - a) * random.unit(),
            _ => a + (b - a) * 0.3 + (c - a) * 0.4,
        };
        let origin = match i % 2 {
            0 => random.direction() * 2.0,
            _ => target,
        };
        let mut ray = Ray::new(
            origin,
            target - origin + random.direction() * (i % 2) as f32,
        );
        ray.t_min = -((i % 4) as f32);
        rays.push(ray);
    }
    rays
}

fn coherent(aggregate: &Aggregate, rays: &[Ray]) -> Vec<Hit> {
    let mut hits = vec![Hit::MISS; rays.len()];
    aggregate.closest_hit_coherent(rays, &mut hits, &mut TraceCounts::default());
    hits
}

#[test]
fn hits_of_quads_are_those_of_their_triangles() {
    for (name, shapes) in meshes() {
        let rays = rays(&shapes);
        let expected = scenes::closest(&scenes::brute_force(shapes.clone()), &rays);
        let met = expected.iter().filter(|hit| !hit.is_miss()).count();
        assert!(met > 2_000, "{name}: {met}");
        for quality in [BvhQuality::Fast, BvhQuality::Standard, BvhQuality::High] {
            for leaf_size in [1, 3, 4, 16] {
                let settings = BvhSettings {
                    kind: BvhKind::Sah,
                    leaf_size,
                    quality,
                };
                for (variant, aggregate) in scenes::aggregates(&shapes, settings) {
                    let case = format!("{name} {variant} {settings:?}");
                    let hits = scenes::closest(&aggregate, &rays);
                    let packets = coherent(&aggregate, &rays);
                    let mut occluded = vec![false; rays.len()];
                    aggregate.any_hit(&rays, &mut occluded, &mut TraceCounts::default());
                    for (i, want) in expected.iter().enumerate() {
                        let ray = &rays[i];
                        assert_eq!(bits(&hits[i]), bits(want), "{case} {ray:?}");
                        assert_eq!(bits(&packets[i]), bits(want), "{case} packets {ray:?}");
                        assert_eq!(occluded[i], !want.is_miss(), "{case} {ray:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn nearly_all_triangles_of_a_mesh_are_halves_of_quads() {
    for (name, shapes) in meshes() {
        let triangles = shapes.triangles.len();
        let count = |kind| {
            let aggregate = Aggregate::build(shapes.clone(), scenes::settings(kind, 4));
            let root = aggregate.bvh().root().expect("not empty");
            let mut ids: Vec<_> = aggregate.primitives(root).collect();
            ids.sort_unstable();
            let stats = aggregate.stats();
            assert_eq!(ids.len(), stats.primitives + stats.quads);
            let per_shape = stats.bytes as f64 / ids.len() as f64;
            assert!((stats.bytes_per_shape - per_shape).abs() < 1e-6);
            (ids, stats.quads)
        };
        let (ids, quads) = count(BvhKind::Sah);
        assert_eq!(count(BvhKind::Median), (ids.clone(), 0), "{name}");
        let spheres = shapes.spheres.len();
        let share = 2.0 * quads as f64 / (ids.len() - spheres) as f64;
        let least = if name == "rough" { 0.6 } else { 0.9 };
        assert!(share > least, "{name}: {share} of {triangles}");
    }
}

#[test]
fn turning_moves_no_vertex() {
    let before = folds(20);
    let mut after = before.clone();
    after.turn_to_quads();
    assert_eq!(after.positions, before.positions);
    let mut turned = 0;
    for (now, then) in after.triangles.iter().zip(&before.triangles) {
        let by = (0..3).find(|&by| {
            let mut then = *then;
            then.rotate_left(by);
            then == *now
        });
        turned += usize::from(by.expect("the same triangle") > 0);
    }
    assert!(turned > 300, "{turned}");
}
