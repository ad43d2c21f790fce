//! G5, G16: input that is not geometry, and rays that are not rays.

use glam::Vec3;
use softbox::bvh::BvhKind;
use softbox::geometry::{Aggregate, Shapes, Sphere, TraceCounts};
use softbox::math::Ray;

use crate::scenes::{self, Random, bits};

/// Triangles without area or with vertices that are not finite.
fn nothing_to_hit() -> Vec<[Vec3; 3]> {
    let [a, b] = [Vec3::new(-0.5, 0.25, 0.125), Vec3::new(0.75, -0.5, 0.5)];
    let mut bad = vec![
        [a, a, a],
        [a, a, b],
        [a, b, a],
        [a, b, b],
        [a, (a + b) / 2.0, b],
    ];
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for corner in 0..3 {
            for axis in 0..3 {
                let mut corners = [a, b, Vec3::ONE];
                corners[corner][axis] = value;
                bad.push(corners);
            }
        }
    }
    bad
}

fn all_kinds(shapes: &Shapes) -> impl Iterator<Item = Aggregate> {
    [BvhKind::None, BvhKind::Median, BvhKind::Sah]
        .into_iter()
        .flat_map(|kind| scenes::aggregates(shapes, scenes::settings(kind, 2)))
        .map(|(_, aggregate)| aggregate)
}

#[test]
fn g5_bad_triangles_are_counted_and_change_nothing() {
    let good = scenes::random_soup(300, 0.4, 1);
    let bad = nothing_to_hit();
    let n_bad = bad.len();
    let corners = (0..300).map(|i| good.vertices(i)).chain(bad);
    let both = scenes::soup(corners);
    let rays = scenes::random_rays(100_000, 4);
    let expected = scenes::closest(&scenes::brute_force(good), &rays);
    for aggregate in all_kinds(&both) {
        let stats = aggregate.stats();
        assert_eq!((stats.excluded, stats.primitives), (n_bad, 300));
        for (hit, want) in scenes::closest(&aggregate, &rays).iter().zip(&expected) {
            assert_eq!(bits(hit), bits(want));
        }
    }
}

#[test]
fn g5_nothing_but_bad_primitives_is_an_empty_scene() {
    let mut shapes = scenes::soup(nothing_to_hit());
    for radius in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        shapes.spheres.push(Sphere {
            center: Vec3::ZERO,
            radius,
        });
    }
    let rays = scenes::random_rays(100_000, 5);
    for aggregate in all_kinds(&shapes) {
        assert_eq!(aggregate.stats().excluded, shapes.len());
        assert!(aggregate.bvh().root().is_none());
        assert!(
            scenes::closest(&aggregate, &rays)
                .iter()
                .all(|h| h.is_miss())
        );
    }
}

#[test]
fn g5_slivers_and_huge_triangles_give_finite_hits() {
    let mut random = Random::new(3);
    let shapes = scenes::soup((0..600).map(|i| {
        let (a, along) = (random.in_cube(), random.direction());
        match i % 3 {
            0 => [a, a + along, a + along * 0.5 + random.direction() * 1e-8],
            1 => [0; 3].map(|_| random.in_cube() * 1e30),
            _ => [a, a + along * 1e-20, a + random.direction() * 1e-20],
        }
    }));
    let rays = scenes::random_rays(100_000, 6);
    let expected = scenes::closest(&scenes::brute_force(shapes.clone()), &rays);
    for aggregate in all_kinds(&shapes) {
        for (hit, want) in scenes::closest(&aggregate, &rays).iter().zip(&expected) {
            assert_eq!(bits(hit), bits(want));
            assert!(hit.is_miss() || (hit.t + hit.b1 + hit.b2).is_finite());
        }
    }
}

#[test]
fn g16_rays_that_are_not_finite_hit_nothing() {
    let settings = scenes::settings(BvhKind::Sah, 4);
    for (variant, aggregate) in scenes::aggregates(&scenes::mixed(300), settings) {
        check_rays_that_are_not_finite(variant, &aggregate);
    }
}

fn check_rays_that_are_not_finite(variant: &str, aggregate: &Aggregate) {
    let good = Ray::new(Vec3::new(0.1, 0.2, 3.0), Vec3::new(0.0, 0.01, -1.0));
    let mut bad = Vec::new();
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for axis in 0..3 {
            let mut ray = good;
            ray.origin[axis] = value;
            bad.push(ray);
            let mut ray = good;
            ray.direction[axis] = value;
            bad.push(ray);
        }
        bad.push(Ray {
            t_min: value,
            ..good
        });
    }
    bad.push(Ray {
        t_max: f32::NAN,
        ..good
    });
    bad.push(Ray {
        t_max: f32::NEG_INFINITY,
        ..good
    });
    bad.push(Ray {
        direction: Vec3::ZERO,
        ..good
    });
    bad.push(Ray {
        t_min: 2.0,
        t_max: 1.0,
        ..good
    });
    let mut counts = TraceCounts::default();
    let mut occluded = vec![true; bad.len()];
    aggregate.any_hit(&bad, &mut occluded, &mut counts);
    assert!(!occluded.contains(&true), "{variant}");
    assert!(
        scenes::closest(aggregate, &bad).iter().all(|h| h.is_miss()),
        "{variant}"
    );
    assert_eq!(
        counts,
        TraceCounts {
            rays: bad.len() as u64,
            ..TraceCounts::default()
        }
    );
    assert!(!aggregate.closest(&good).is_miss());
}
