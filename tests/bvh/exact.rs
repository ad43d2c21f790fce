//! G4, G6, G7: the tree changes nothing, not even a bit.

use glam::Vec3;
use proptest::prelude::*;
use softbox::bvh::BvhKind;
use softbox::geometry::{Aggregate, Shapes, TraceCounts};
use softbox::math::Ray;

use crate::scenes::{self, Random, bits};

/// Compares every kind and leaf size with brute force; returns the number of hits.
fn compare(name: &str, shapes: &Shapes, rays: &[Ray]) -> usize {
    let expected = scenes::closest(&scenes::brute_force(shapes.clone()), rays);
    for kind in [BvhKind::None, BvhKind::Median, BvhKind::Sah] {
        for leaf_size in [1, 2, 4, 16] {
            let settings = scenes::settings(kind, leaf_size);
            let aggregate = Aggregate::build(shapes.clone(), settings);
            let hits = scenes::closest(&aggregate, rays);
            let mut occluded = vec![false; rays.len()];
            aggregate.any_hit(rays, &mut occluded, &mut TraceCounts::default());
            for (((ray, hit), want), any) in rays.iter().zip(&hits).zip(&expected).zip(occluded) {
                assert_eq!(bits(hit), bits(want), "{name} {settings:?} {ray:?}");
                assert_eq!(any, !want.is_miss(), "{name} {settings:?} {ray:?}");
            }
        }
    }
    expected.iter().filter(|h| !h.is_miss()).count()
}

fn one_triangle() -> Shapes {
    scenes::soup([[
        Vec3::new(-0.7, -0.5, 0.1),
        Vec3::new(0.8, -0.4, 0.0),
        Vec3::new(0.0, 0.9, -0.2),
    ]])
}

fn equal_centers() -> Shapes {
    let mut random = Random::new(8);
    scenes::soup((0..300).map(|_| {
        let [a, b] = [random.in_cube(), random.in_cube()];
        // The box of a, -a and anything between them has its middle at the origin.
        [a, -a, a * b]
    }))
}

fn diagonals() -> Shapes {
    let mut random = Random::new(4);
    scenes::soup((0..600).map(|_| {
        let [a, b] = [random.in_cube(), random.in_cube()];
        [a, b, b + random.in_cube() * 0.005]
    }))
}

#[test]
fn g7_every_tree_agrees_with_brute_force() {
    let rays = scenes::random_rays(12_000, 1);
    for (name, shapes, least) in [
        ("soup", scenes::random_soup(500, 0.3, 2), 3_000),
        ("one triangle", one_triangle(), 1_000),
        ("equal centres", equal_centers(), 3_000),
        ("diagonals", diagonals(), 300),
        ("mixed", scenes::mixed(200), 3_000),
        ("closed mesh", scenes::spiky_sphere(), 3_000),
        ("empty", Shapes::default(), 0),
    ] {
        let hits = compare(name, &shapes, &rays);
        assert!(hits >= least, "{name}: {hits} hits only");
    }
}

#[test]
fn g7_ten_thousand_coincident_triangles_give_the_first() {
    let shapes = scenes::soup((0..10_000).map(|_| one_triangle().vertices(0)));
    let rays = scenes::random_rays(150, 2);
    assert!(compare("coincident", &shapes, &rays) > 20);
    let aggregate = Aggregate::build(shapes, scenes::settings(BvhKind::Sah, 4));
    let stats = aggregate.stats();
    assert!(
        stats.largest_leaf <= 4 && stats.max_depth <= 14,
        "{stats:?}"
    );
    for hit in scenes::closest(&aggregate, &rays) {
        assert!(hit.is_miss() || hit.primitive == 0);
    }
}

#[test]
fn g6_duplicates_and_coplanar_triangles_are_decided_by_the_smaller_id() {
    let once = scenes::spiky_sphere();
    let mut twice = once.clone();
    twice.triangles.extend(once.triangles.iter().rev());
    let n = once.triangles.len() as u32;
    let rays = scenes::random_rays(10_000, 3);
    assert!(compare("twice", &twice, &rays) > 3_000);
    let hits = scenes::closest(
        &Aggregate::build(twice, scenes::settings(BvhKind::Sah, 4)),
        &rays,
    );
    let single = scenes::closest(&scenes::brute_force(once), &rays);
    for (hit, single) in hits.iter().zip(&single) {
        assert_eq!(bits(hit), bits(single));
        assert!(hit.is_miss() || hit.primitive < n);
    }
    // Overlapping triangles in common planes, in no order.
    let mut random = Random::new(12);
    let coplanar = scenes::soup((0..400).map(|i| {
        let mut corners = [random.in_cube(), random.in_cube(), random.in_cube()];
        corners.iter_mut().for_each(|v| v[i % 3] = 0.25);
        corners
    }));
    assert!(compare("coplanar", &coplanar, &rays) > 1_000);
}

#[test]
fn g4_the_sign_of_zero_does_not_matter() {
    let aggregate = Aggregate::build(scenes::mixed(300), scenes::settings(BvhKind::Sah, 2));
    let mut random = Random::new(6);
    let mut hits = 0;
    for _ in 0..20_000 {
        // Coordinates on a coarse grid, so that zeros arise everywhere.
        let grid = |v: Vec3| (v * 4.0).round() / 4.0;
        let (origin, direction) = (grid(random.in_cube()), grid(random.in_cube() * 0.6));
        if direction == Vec3::ZERO {
            continue;
        }
        let plain = aggregate.closest(&Ray::new(origin, direction));
        hits += usize::from(!plain.is_miss());
        for signs in 0..64 {
            let signed = |v: Vec3, shift: usize| {
                let zero = |axis: usize| {
                    if signs >> (axis + shift) & 1 == 1 {
                        -0.0
                    } else {
                        0.0
                    }
                };
                let pick = |axis: usize| if v[axis] == 0.0 { zero(axis) } else { v[axis] };
                Vec3::new(pick(0), pick(1), pick(2))
            };
            let ray = Ray::new(signed(origin, 3), signed(direction, 0));
            assert_eq!(bits(&aggregate.closest(&ray)), bits(&plain), "{ray:?}");
        }
    }
    assert!(hits > 1_000);
}

fn coordinate() -> impl Strategy<Value = f32> {
    // A grid makes shared planes, equal distances and zero components likely.
    prop_oneof![(-4..=4).prop_map(|i| i as f32 * 0.5), -2.0_f32..2.0]
}

fn point() -> impl Strategy<Value = Vec3> {
    [coordinate(), coordinate(), coordinate()].prop_map(Vec3::from_array)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_tree_over_any_triangles_agrees_with_brute_force(
        corners in prop::collection::vec([point(), point(), point()], 1..40),
        rays in prop::collection::vec((point(), point(), 0.1_f32..8.0), 20),
        leaf_size in 1_u32..6,
        median in any::<bool>(),
    ) {
        let kind = if median { BvhKind::Median } else { BvhKind::Sah };
        let rays: Vec<_> = rays.iter().map(|&(o, d, t_max)| Ray::segment(o, d, t_max)).collect();
        let shapes = scenes::soup(corners);
        let expected = scenes::closest(&scenes::brute_force(shapes.clone()), &rays);
        let tree = Aggregate::build(shapes, scenes::settings(kind, leaf_size));
        for (hit, want) in scenes::closest(&tree, &rays).iter().zip(&expected) {
            prop_assert_eq!(bits(hit), bits(want));
        }
    }
}
