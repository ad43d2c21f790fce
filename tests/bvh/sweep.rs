//! Sweeps over small scenes give the hits of the tree and of brute force, bit for bit.

use glam::Vec3;
use softbox::bvh::{BvhKind, BvhSettings};
use softbox::geometry::{Aggregate, Shapes, Sphere, TraceCounts};
use softbox::math::{Isa, Ray};

use crate::scenes::{self, Random, bits};

/// Not a multiple of the number of lanes, and more than are sorted at once.
const RAYS: usize = 5_003;

/// The scene on every instruction set against brute force; returns the number of hits.
fn compare(name: &str, shapes: &Shapes, rays: &[Ray]) -> usize {
    let expected = scenes::closest(&scenes::brute_force(shapes.clone()), rays);
    let swept = Aggregate::build(shapes.clone(), BvhSettings::default());
    assert!(swept.is_swept(), "{name}");
    for isa in Isa::available() {
        let swept = swept.clone().with_isa(isa);
        // Whole, and in pieces of which the smallest go through the tree.
        for piece in [RAYS, 1_000, 65, 64, 63] {
            for (rays, expected) in rays.chunks(piece).zip(expected.chunks(piece)) {
                let mut occluded = vec![false; rays.len()];
                let mut counts = TraceCounts::default();
                swept.any_hit(rays, &mut occluded, &mut counts);
                assert_eq!(counts.rays, rays.len() as u64);
                let hits = scenes::closest(&swept, rays).into_iter().zip(occluded);
                for ((ray, want), (hit, any)) in rays.iter().zip(expected).zip(hits) {
                    assert_eq!(bits(&hit), bits(want), "{name} {isa} {ray:?}");
                    assert_eq!(any, !want.is_miss(), "{name} {isa} {ray:?}");
                }
            }
        }
    }
    expected.iter().filter(|hit| !hit.is_miss()).count()
}

/// A room with a block in it: quadrilaterals of two triangles, some turned.
fn room() -> Shapes {
    let mut shapes = scenes::cube();
    let block = scenes::cube();
    let base = shapes.positions.len() as u32;
    let turn = |v: Vec3| {
        Vec3::new(
            0.3 * v.x + 0.1 * v.z,
            0.4 * v.y - 0.6,
            0.3 * v.z - 0.1 * v.x,
        )
    };
    shapes
        .positions
        .extend(block.positions.iter().map(|&v| turn(v)));
    for (i, mut triangle) in block.triangles.into_iter().enumerate() {
        triangle.rotate_left(i % 3);
        shapes.triangles.push(triangle.map(|corner| corner + base));
    }
    shapes
}

fn with_spheres(mut shapes: Shapes, spheres: &[(Vec3, f32)]) -> Shapes {
    let spheres = spheres
        .iter()
        .map(|&(center, radius)| Sphere { center, radius });
    shapes.spheres.extend(spheres);
    shapes
}

/// Triangles in no order, of which some share edges, fold over, coincide or cannot be hit.
fn jumble() -> Shapes {
    let mut shapes = scenes::random_soup(12, 0.8, 31);
    let n = shapes.triangles.len() as u32;
    for i in 0..n {
        let [a, b, c] = shapes.triangles[i as usize];
        shapes
            .positions
            .push(shapes.positions[c as usize] * 0.9 + Vec3::Y * 0.1);
        let apex = shapes.positions.len() as u32 - 1;
        // The same way along the edge, the other way, and the same triangle again.
        shapes.triangles.push(match i % 4 {
            0 => [a, b, apex],
            1 => [b, a, apex],
            2 => [apex, b, a],
            _ => [b, c, a],
        });
    }
    shapes.positions.push(Vec3::new(f32::NAN, 0.0, 0.0));
    let nan = shapes.positions.len() as u32 - 1;
    shapes.triangles.insert(3, [0, 1, nan]);
    shapes.triangles.insert(9, [0, 1, 1]);
    shapes
}

/// Rays in all ways, with and without bounds, parallel to axes, from far away, and none at all.
fn rays(seed: u64) -> Vec<Ray> {
    let mut rays = scenes::random_rays(RAYS, seed);
    let mut random = Random::new(seed + 1);
    for (i, ray) in rays.iter_mut().enumerate() {
        match i % 41 {
            3 => ray.direction = Vec3::new(0.0, f32::NAN, 1.0),
            5 => ray.direction = Vec3::ZERO,
            7 => ray.origin *= 1e7,
            9 => ray.direction *= 1e-20,
            11 => ray.t_min = -random.unit(),
            13 => ray.t_max = f32::NAN,
            15 => ray.t_max = -1.0,
            _ => {}
        }
    }
    rays
}

/// From inside a scene exactly at its vertices, and at points of its edges.
fn at_edges(shapes: &Shapes) -> Vec<Ray> {
    let mut random = Random::new(5);
    (0..RAYS)
        .map(|i| {
            let [a, b, _] = shapes.vertices(random.below(shapes.triangles.len()));
            // On a grid, where edge functions are often exactly zero.
            let origin = (random.in_cube() * 4.0).round() / 8.0;
            let along = [0.0, 0.5, random.unit()][i % 3];
            Ray::new(origin, a + (b - a) * along - origin)
        })
        .collect()
}

#[test]
fn g7_sweeps_agree_with_brute_force() {
    let balls = [
        (Vec3::new(0.4, -0.5, 0.2), 0.4),
        (Vec3::new(-0.4, 0.1, -0.3), 0.3),
    ];
    let nested = [(Vec3::ZERO, 0.8), (Vec3::ZERO, 0.5), (Vec3::X * 0.3, 0.5)];
    let many: Vec<_> = (0..16_u8)
        .map(|i| {
            let [x, y, z] = [1, 4, 16].map(|unit| f32::from(i / unit % 4) * 0.4 - 0.6);
            (Vec3::new(x, y, z), 0.25)
        })
        .collect();
    let one = scenes::random_soup(1, 1.5, 3);
    for (name, shapes, share) in [
        ("cube", scenes::cube(), 0.4),
        ("room", room(), 0.4),
        ("room with spheres", with_spheres(room(), &balls), 0.4),
        ("room full of spheres", with_spheres(room(), &many), 0.4),
        (
            "spheres in spheres",
            with_spheres(scenes::cube(), &nested),
            0.4,
        ),
        ("one triangle", one, 0.01),
        ("jumble", jumble(), 0.2),
        ("soup", scenes::random_soup(32, 0.7, 8), 0.2),
    ] {
        let hits = compare(name, &shapes, &rays(40));
        assert!(
            hits as f64 >= share * RAYS as f64,
            "{name}: {hits} hits only"
        );
    }
}

#[test]
fn g1_no_ray_of_a_sweep_slips_through_an_edge() {
    for shapes in [scenes::cube(), room()] {
        let rays = at_edges(&shapes);
        // Directions of zero hit nothing.
        let real = rays
            .iter()
            .filter(|ray| ray.direction != Vec3::ZERO)
            .count();
        assert_eq!(compare("edges", &shapes, &rays), real);
    }
}

#[test]
fn rays_that_touch_spheres_or_start_on_them_agree() {
    let (center, radius) = (Vec3::new(0.25, -0.5, 0.125), 0.5);
    let shapes = with_spheres(scenes::cube(), &[(center, radius), (Vec3::ZERO, 1e-3)]);
    let mut random = Random::new(17);
    let rays: Vec<_> = (0..RAYS)
        .map(|i| {
            let out = random.direction();
            let side = out.any_orthonormal_vector();
            let touch = center + side * radius * [1.0, 1.0 - 1e-7, 1.0 + 1e-7][i % 3];
            match i % 4 {
                // Past the rim.
                0 => Ray::new(touch - out * 0.4, out),
                // From the surface, both ways.
                1 => Ray::new(center + out * radius, out),
                2 => Ray::new(center + out * radius, side - out),
                // Along an axis through the very rim: the discriminant is zero.
                _ => Ray::new(center + Vec3::new(radius, 0.0, -0.5), Vec3::Z),
            }
        })
        .collect();
    assert!(compare("rim", &shapes, &rays) > RAYS / 2);
}

#[test]
fn only_small_scenes_of_the_best_kind_are_swept() {
    let is_swept =
        |shapes: Shapes, kind| Aggregate::build(shapes, scenes::settings(kind, 4)).is_swept();
    assert!(is_swept(scenes::cube(), BvhKind::Sah));
    assert!(!is_swept(scenes::cube(), BvhKind::None));
    assert!(!is_swept(scenes::cube(), BvhKind::Median));
    assert!(!is_swept(scenes::random_soup(300, 0.1, 1), BvhKind::Sah));
    assert!(!is_swept(Shapes::default(), BvhKind::Sah));
    let mut huge = scenes::cube();
    huge.positions[0] *= 1e8;
    assert!(!is_swept(huge, BvhKind::Sah));
}

#[test]
fn a_sweep_follows_shapes_that_move() {
    let mut moved = Aggregate::build(room(), BvhSettings::default());
    let positions: Vec<_> = room()
        .positions
        .iter()
        .map(|v| *v * 0.9 + Vec3::X * 0.05)
        .collect();
    assert!(moved.refit(positions.clone()).is_some());
    assert!(moved.is_swept());
    let expected = scenes::brute_force(Shapes {
        positions,
        ..room()
    });
    let rays = rays(6);
    let want = scenes::closest(&expected, &rays);
    for (hit, want) in scenes::closest(&moved, &rays).iter().zip(&want) {
        assert_eq!(bits(hit), bits(want));
    }
}
