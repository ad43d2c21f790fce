use std::collections::HashMap;

use glam::Vec3;
use softbox::bvh::{BvhKind, BvhSettings};
use softbox::geometry::{Aggregate, Hit, Shapes};
use softbox::math::Ray;

use crate::ray_bench::mesh::{add_box, bumps, geodesic, knot, serpent};
use crate::ray_bench::result::Mismatches;
use crate::ray_bench::{Exact, Random, median};

/// Whether every edge is used once in each direction.
fn is_closed(shapes: &Shapes) -> bool {
    let mut edges = HashMap::new();
    for t in &shapes.triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            *edges.entry((a, b)).or_insert(0) += 1;
        }
    }
    edges
        .iter()
        .all(|(&(a, b), &n)| n == 1 && edges.get(&(b, a)) == Some(&1))
}

#[test]
fn the_closed_meshes_are_closed_and_have_their_size() {
    let ball = geodesic(7, |d| 1.0 + bumps(d, 0.01));
    assert_eq!((ball.triangles.len(), ball.positions.len()), (980, 492));
    assert!(is_closed(&ball));
    let knot = knot(50, 7, 0.0);
    assert_eq!(knot.triangles.len(), 700);
    assert!(is_closed(&knot));
}

#[test]
fn the_serpent_has_its_size() {
    assert_eq!(serpent().triangles.len(), 100_000);
}

#[test]
fn a_closed_box_has_twelve_triangles_and_an_open_one_ten() {
    for (is_open, triangles) in [(false, 12), (true, 10)] {
        let mut shapes = Shapes::default();
        add_box(&mut shapes, Vec3::NEG_ONE, Vec3::ONE, is_open);
        assert_eq!(shapes.triangles.len(), triangles);
        let at_front = |t: &&[u32; 3]| t.iter().all(|i| shapes.positions[*i as usize].z == 1.0);
        let front = shapes.triangles.iter().filter(at_front).count();
        assert_eq!(front, if is_open { 0 } else { 2 });
    }
}

#[test]
fn other_hits_are_counted() {
    let at = |t: f32| Hit {
        t,
        primitive: 3,
        ..Hit::MISS
    };
    let expected = [at(1.0), at(1.0), Hit::MISS, Hit::MISS, at(1.0), at(1.0)];
    let found = [
        at(1.00005),
        Hit::MISS,
        at(1.0),
        Hit::MISS,
        at(1.001),
        at(f32::NAN),
    ];
    let mismatches = Mismatches::of_closest(&expected, &found);
    assert_eq!((mismatches.hit_or_miss, mismatches.distance), (2, 2));
    let occluded = [true, false, false, true, true, true];
    assert_eq!(Mismatches::of_any(&expected, &occluded).hit_or_miss, 2);
}

#[test]
fn the_median_is_in_the_middle() {
    let of = |values: &[f64]| median(values.iter().copied());
    assert_eq!(of(&[3.0, 1.0, 2.0]), 2.0);
    assert_eq!(of(&[4.0, 1.0, 2.0, 3.0]), 2.5);
    assert!(of(&[]).is_nan());
}

#[test]
fn double_precision_needs_no_tree() {
    let shapes = knot(60, 20, 0.0);
    let mut random = Random::new(5);
    let rays: Vec<Ray> = (0..2000)
        .map(|_| Ray::new(random.direction() * 0.8, random.direction()))
        .collect();
    let hits = |kind| {
        let settings = BvhSettings {
            kind,
            ..BvhSettings::default()
        };
        Exact(&Aggregate::build(shapes.clone(), settings)).closest_hits(&rays)
    };
    let (all, by_tree) = (hits(BvhKind::None), hits(BvhKind::Sah));
    assert_eq!(all, by_tree);
    let met = all.iter().filter(|hit| !hit.is_miss()).count();
    assert!((200..1800).contains(&met), "{met}");
}
