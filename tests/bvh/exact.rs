//! G4, G6, G7: the tree changes nothing, not even a bit.

use glam::Vec3;
use proptest::prelude::*;
use softbox::bvh::BvhKind;
use softbox::geometry::{Aggregate, Hit, Shapes, TraceCounts};
use softbox::math::Ray;

use crate::scenes::{self, Random, bits};

/// Compares every kind and leaf size with brute force; returns the number of hits.
fn compare(name: &str, shapes: &Shapes, rays: &[Ray]) -> usize {
    let expected = scenes::closest(&scenes::brute_force(shapes.clone()), rays);
    // Brute force has no leaf size.
    let none = [(BvhKind::None, 4)];
    let trees = [BvhKind::Median, BvhKind::Sah].map(|kind| [1, 2, 4, 16].map(|n| (kind, n)));
    for (kind, leaf_size) in none.into_iter().chain(trees.into_iter().flatten()) {
        let settings = scenes::settings(kind, leaf_size);
        for (variant, aggregate) in scenes::aggregates(shapes, settings) {
            let case = format!("{name} {variant} {settings:?}");
            assert_same(&case, &aggregate, rays, &expected);
        }
    }
    expected.iter().filter(|h| !h.is_miss()).count()
}

fn assert_same(case: &str, aggregate: &Aggregate, rays: &[Ray], expected: &[Hit]) {
    let hits = scenes::closest(aggregate, rays);
    let mut occluded = vec![false; rays.len()];
    aggregate.any_hit(rays, &mut occluded, &mut TraceCounts::default());
    for (((ray, hit), want), any) in rays.iter().zip(&hits).zip(expected).zip(occluded) {
        assert_eq!(bits(hit), bits(want), "{case} {ray:?}");
        assert_eq!(any, !want.is_miss(), "{case} {ray:?}");
    }
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

/// Every tree against brute force, `n` rays in each scene.
fn check_scenes(n: usize) {
    let rays = scenes::random_rays(n, 1);
    for (name, shapes, share) in [
        ("soup", scenes::random_soup(500, 0.3, 2), 0.25),
        ("one triangle", one_triangle(), 0.08),
        ("equal centres", equal_centers(), 0.25),
        ("diagonals", diagonals(), 0.025),
        ("mixed", scenes::mixed(200), 0.25),
        ("closed mesh", scenes::spiky_sphere(), 0.25),
        ("empty", Shapes::default(), 0.0),
    ] {
        let hits = compare(name, &shapes, &rays);
        assert!(hits as f64 >= share * n as f64, "{name}: {hits} hits only");
    }
}

#[test]
fn g7_every_tree_agrees_with_brute_force() {
    check_scenes(12_000);
}

#[test]
#[ignore = "the long form, a million rays in each scene"]
fn g7_every_tree_agrees_with_brute_force_at_length() {
    check_scenes(1_000_000);
}

#[test]
#[ignore = "the long form, a hundred thousand triangles"]
fn g7_coincident_triangles_at_length() {
    let shapes = scenes::soup((0..100_000).map(|_| one_triangle().vertices(0)));
    let rays = scenes::random_rays(1_000, 2);
    assert!(compare("coincident", &shapes, &rays) > 100);
}

#[test]
fn g7_ten_thousand_coincident_triangles_give_the_first() {
    let shapes = scenes::soup((0..10_000).map(|_| one_triangle().vertices(0)));
    let rays = scenes::random_rays(150, 2);
    assert!(compare("coincident", &shapes, &rays) > 20);
    for (variant, aggregate) in scenes::aggregates(&shapes, scenes::settings(BvhKind::Sah, 4)) {
        let stats = aggregate.stats();
        assert!(
            stats.largest_leaf <= 4 && stats.max_depth <= 14,
            "{variant} {stats:?}"
        );
        for hit in scenes::closest(&aggregate, &rays) {
            assert!(hit.is_miss() || hit.primitive == 0, "{variant} {hit:?}");
        }
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
    let single = scenes::closest(&scenes::brute_force(once), &rays);
    for (variant, aggregate) in scenes::aggregates(&twice, scenes::settings(BvhKind::Sah, 4)) {
        for (hit, single) in scenes::closest(&aggregate, &rays).iter().zip(&single) {
            assert_eq!(bits(hit), bits(single), "{variant}");
            assert!(hit.is_miss() || hit.primitive < n, "{variant}");
        }
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
    let settings = scenes::settings(BvhKind::Sah, 2);
    for (variant, aggregate) in scenes::aggregates(&scenes::mixed(300), settings) {
        check_signs_of_zero(variant, &aggregate);
    }
}

/// `v` with the signs of its zeros from the lowest bits of `signs`.
fn with_signs(v: Vec3, signs: u32) -> Vec3 {
    let pick = |axis: usize| match (v[axis] == 0.0, signs >> axis & 1) {
        (true, 0) => 0.0,
        (true, _) => -0.0,
        (false, _) => v[axis],
    };
    Vec3::new(pick(0), pick(1), pick(2))
}

fn check_signs_of_zero(variant: &str, aggregate: &Aggregate) {
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
        let rays: Vec<_> = (0..64)
            .map(|signs| Ray::new(with_signs(origin, signs >> 3), with_signs(direction, signs)))
            .collect();
        for (ray, hit) in rays.iter().zip(scenes::closest(aggregate, &rays)) {
            assert_eq!(bits(&hit), bits(&plain), "{variant} {ray:?}");
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
        for (variant, tree) in scenes::aggregates(&shapes, scenes::settings(kind, leaf_size)) {
            for (hit, want) in scenes::closest(&tree, &rays).iter().zip(&expected) {
                prop_assert_eq!(bits(hit), bits(want), "{}", variant);
            }
        }
    }
}
