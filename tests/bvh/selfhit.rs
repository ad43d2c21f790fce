//! G9, G10: rays that leave a surface neither meet it again nor escape through it.

use glam::Vec3;
use softbox::bvh::BvhSettings;
use softbox::geometry::{Aggregate, Shapes, Sphere, triangle_point_and_error};
use softbox::math::{Ray, offset_origin};

use crate::scenes::{self, Random};

/// A closed cube, rotated so that no face is parallel to an axis.
fn rotated_cube(scale: f32) -> Shapes {
    let turn = glam::Quat::from_euler(glam::EulerRot::XYZ, 0.3, 0.7, 1.1);
    let mut shapes = scenes::cube();
    for p in &mut shapes.positions {
        *p = turn * *p * scale;
    }
    shapes
}

/// A direction on the side of `normal`; one in five at a cosine of 1e-6 to 1e-1.
fn leaving(random: &mut Random, normal: Vec3) -> Vec3 {
    loop {
        let mut d = random.direction();
        if random.unit() < 0.2 {
            let along = (d - normal * d.dot(normal)).normalize();
            d = (along + normal * 10.0_f32.powf(-1.0 - 5.0 * random.unit())).normalize();
        }
        if d.dot(normal) > 0.0 {
            return d;
        }
    }
}

#[test]
fn g10_rays_from_the_faces_of_a_closed_cube_stay_on_their_side() {
    for scale in [1e-3, 1.0, 1e3] {
        let shapes = rotated_cube(scale);
        let aggregate = Aggregate::build(shapes.clone(), BvhSettings::default());
        let mut random = Random::new(1);
        let (mut self_hits, mut escapes) = (0, 0);
        for i in 0..200_000 {
            let id = random.below(12);
            let corners = shapes.vertices(id);
            // Half of the points near an edge.
            let b1 = if i % 2 == 0 {
                10.0_f32.powf(-7.0 * random.unit())
            } else {
                random.unit()
            };
            let b2 = (1.0 - b1) * random.unit();
            let (point, error) = triangle_point_and_error(&corners, b1, b2);
            let outward = (corners[1] - corners[0])
                .cross(corners[2] - corners[0])
                .normalize();
            let inside = i % 4 < 2;
            let normal = if inside { -outward } else { outward };
            let direction = leaving(&mut random, normal);
            let origin = offset_origin(point, error, outward, direction);
            let hit = aggregate.closest(&Ray::new(origin, direction));
            // From outside a convex body a leaving ray meets nothing at all.
            if inside {
                escapes += usize::from(hit.is_miss());
                self_hits += usize::from(hit.primitive == id as u32);
            } else {
                self_hits += usize::from(!hit.is_miss());
            }
        }
        assert_eq!((self_hits, escapes), (0, 0), "at scale {scale}");
    }
}

#[test]
fn g9_rays_from_a_sphere_stay_on_their_side() {
    for (center, radius) in [
        (Vec3::ZERO, 1.0),
        (Vec3::new(3.0, -2.0, 5.0), 0.25),
        (Vec3::X, 1e-3),
    ] {
        let sphere = Sphere { center, radius };
        let spheres = vec![sphere];
        let aggregate = Aggregate::build(
            Shapes {
                spheres,
                ..Shapes::default()
            },
            BvhSettings::default(),
        );
        let mut random = Random::new(2);
        for i in 0..200_000 {
            let (point, error) = sphere.point_and_error(center + random.direction() * radius);
            let outward = (point - center).normalize();
            let inside = i % 2 == 0;
            let direction = leaving(&mut random, if inside { -outward } else { outward });
            let origin = offset_origin(point, error, outward, direction);
            let hit = aggregate.closest(&Ray::new(origin, direction));
            assert_eq!(
                hit.is_miss(),
                !inside,
                "{center} {radius} {direction} {hit:?}"
            );
        }
    }
}
