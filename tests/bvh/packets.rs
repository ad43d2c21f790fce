//! Packets of coherent rays give the hits of single rays, bit for bit.

use glam::Vec3;
use softbox::bvh::BvhKind;
use softbox::geometry::{Aggregate, Hit, Shapes, TraceCounts};
use softbox::math::{Isa, Ray};

use crate::scenes::{self, Random, bits};

/// Rays in a bundle: as many as the tracer takes at a time.
const BUNDLE: usize = 32;

/// Rays of 8 x 4 pixels of size `pixel` from near `origin` (within `lens`) through `target`.
fn bundle(random: &mut Random, origin: Vec3, target: Vec3, pixel: f32, lens: f32) -> Vec<Ray> {
    let forward = target - origin;
    let right = forward.any_orthonormal_vector();
    let up = right.cross(forward).normalize();
    (0..BUNDLE)
        .map(|i| {
            let x = (i % 8) as f32 - 3.5 + random.unit();
            let y = (i / 8) as f32 - 1.5 + random.unit();
            let origin = origin + random.in_cube() * lens;
            Ray::new(origin, target + (right * x + up * y) * pixel - origin)
        })
        .collect()
}

/// `n` bundles towards points in the cube, from one point each or from a lens, from one that covers
/// less than a triangle to one as wide as the scene.
fn bundles(n: usize, seed: u64) -> Vec<Ray> {
    let mut random = Random::new(seed);
    (0..n)
        .flat_map(|i| {
            let (origin, target) = (random.in_cube() * 3.0, random.in_cube() * 0.7);
            let lens = [0.0, 0.0, 0.0, 0.02][i % 4];
            let pixel = 10.0_f32.powf(-4.0 * random.unit());
            let mut rays = bundle(&mut random, origin, target, pixel, lens);
            if i % 5 == 0 {
                // Bounds of their own, and parallel to an axis.
                for ray in &mut rays {
                    ray.direction[i % 3] = 0.0;
                    ray.t_min = random.unit();
                    ray.t_max = 2.0 * random.unit();
                }
            }
            if i % 7 == 0 {
                rays[i % BUNDLE].direction = Vec3::new(0.0, f32::NAN, 1.0);
                rays[(i + 9) % BUNDLE].direction = Vec3::ZERO;
            }
            rays
        })
        .collect()
}

fn coherent(aggregate: &Aggregate, rays: &[Ray]) -> Vec<Hit> {
    let mut hits = vec![Hit::MISS; rays.len()];
    let mut counts = TraceCounts::default();
    aggregate.closest_hit_coherent(rays, &mut hits, &mut counts);
    assert_eq!(counts.rays, rays.len() as u64);
    hits
}

/// Packets on every instruction set and tree against `expected`; returns the number of hits.
fn compare(name: &str, shapes: &Shapes, rays: &[Ray], expected: &[Hit]) -> usize {
    for (kind, leaf_size) in [
        (BvhKind::Sah, 4),
        (BvhKind::Sah, 1),
        (BvhKind::Median, 16),
        (BvhKind::None, 4),
    ] {
        let aggregate = Aggregate::build(shapes.clone(), scenes::settings(kind, leaf_size));
        for isa in Isa::available() {
            let hits = coherent(&aggregate.clone().with_isa(isa), rays);
            for ((ray, hit), want) in rays.iter().zip(&hits).zip(expected) {
                assert_eq!(bits(hit), bits(want), "{name} {kind:?} {isa} {ray:?}");
            }
        }
    }
    expected.iter().filter(|hit| !hit.is_miss()).count()
}

fn by_brute_force(shapes: &Shapes, rays: &[Ray]) -> Vec<Hit> {
    scenes::closest(&scenes::brute_force(shapes.clone()), rays)
}

#[test]
fn g7_packets_agree_with_brute_force() {
    let mut rays = bundles(600, 3);
    // The last bundle is not full.
    rays.truncate(rays.len() - 5);
    let twice = {
        let mut shapes = scenes::spiky_sphere();
        shapes
            .triangles
            .extend_from_within(..shapes.triangles.len());
        shapes
    };
    for (name, shapes, share) in [
        ("soup", scenes::random_soup(500, 0.3, 2), 0.2),
        ("mixed", scenes::mixed(200), 0.2),
        ("closed mesh", scenes::spiky_sphere(), 0.2),
        ("cube", scenes::cube(), 0.2),
        ("coincident", twice, 0.2),
        ("dense", scenes::closed_sphere(70, |_, _| 0.9), 0.2),
        ("empty", Shapes::default(), 0.0),
    ] {
        let hits = compare(name, &shapes, &rays, &by_brute_force(&shapes, &rays));
        assert!(
            hits as f64 >= share * rays.len() as f64,
            "{name}: {hits} hits only"
        );
    }
}

#[test]
fn g7_rays_without_a_common_way_agree_too() {
    let rays = scenes::random_rays(4_000, 8);
    let shapes = scenes::mixed(200);
    assert!(compare("mixed", &shapes, &rays, &by_brute_force(&shapes, &rays)) > 1_000);
}

#[test]
fn g4_the_sign_of_zero_does_not_matter_in_a_packet() {
    let shapes = scenes::mixed(300);
    let mut random = Random::new(6);
    let grid = |v: Vec3| (v * 4.0).round() / 4.0;
    let zeros = |v: Vec3, i: usize| v.map(|x| if i % 3 == 1 && x == 0.0 { -x } else { x });
    let rays: Vec<_> = (0..400)
        .flat_map(|_| {
            let (origin, direction) = (grid(random.in_cube()), grid(random.in_cube() * 0.8));
            (0..BUNDLE).map(move |i| Ray::new(zeros(origin, i), zeros(direction, i / 2)))
        })
        .collect();
    let plain: Vec<_> = rays
        .iter()
        .map(|ray| Ray::new(ray.origin + Vec3::ZERO, ray.direction + Vec3::ZERO))
        .collect();
    let hits = compare("mixed", &shapes, &rays, &by_brute_force(&shapes, &plain));
    assert!(hits > 1_000);
}

#[test]
fn g1_no_ray_of_a_packet_leaves_a_closed_mesh() {
    let mut random = Random::new(11);
    for shapes in [
        scenes::smooth_sphere(),
        scenes::spiky_sphere(),
        scenes::cube(),
    ] {
        let rays: Vec<_> = (0..6_000)
            .flat_map(|i| {
                let [a, b, _] = shapes.vertices(random.below(shapes.triangles.len()));
                let origin = random.in_cube() * 0.15;
                let lens = if i % 3 == 0 { 0.01 } else { 0.0 };
                let mut rays = bundle(&mut random, origin, a, 1e-3, lens);
                // Half of them exactly at a vertex or at points of an edge.
                for (j, ray) in rays.iter_mut().enumerate().step_by(2) {
                    let along = if j % 8 == 0 { 0.0 } else { j as f32 / 100.0 };
                    ray.direction = a + (b - a) * along - ray.origin;
                }
                rays
            })
            .collect();
        for (variant, aggregate) in scenes::aggregates(&shapes, scenes::settings(BvhKind::Sah, 4)) {
            for isa in Isa::available() {
                let hits = coherent(&aggregate.clone().with_isa(isa), &rays);
                let leaks = hits.iter().filter(|hit| hit.is_miss()).count();
                assert_eq!(leaks, 0, "{variant} {isa}");
            }
        }
    }
}

#[test]
fn a_packet_counts_the_work_for_each_of_its_rays() {
    let aggregate = Aggregate::build(scenes::cube(), scenes::settings(BvhKind::Sah, 4));
    let towards = Vec3::new(0.3, 0.2, 0.0);
    let rays = bundle(
        &mut Random::new(1),
        Vec3::new(1.0, 2.0, 5.0),
        towards,
        1e-4,
        0.0,
    );
    let (mut packet, mut single) = (TraceCounts::default(), TraceCounts::default());
    let mut hits = [Hit::MISS; BUNDLE];
    aggregate.closest_hit_coherent(&rays, &mut hits, &mut packet);
    aggregate.closest_hit(&rays, &mut hits, &mut single);
    assert!(packet.box_tests >= 8 * BUNDLE as u64);
    assert!(packet.box_tests <= single.box_tests);
    assert!(packet.primitive_tests >= 4 * BUNDLE as u64);
}
