//! G9, G10: rays that leave a surface neither meet it again nor escape through it.

use glam::Vec3;
use softbox::bvh::BvhSettings;
use softbox::geometry::{
    Aggregate, Hit, Shapes, Sphere, TraceCounts, triangle_departure, triangle_point_and_error,
};
use softbox::math::{Ray, offset_origin};

use crate::scenes::{self, Random};

/// `shapes` with all vertices moved.
fn mapped(mut shapes: Shapes, map: impl Fn(Vec3) -> Vec3) -> Shapes {
    shapes.positions.iter_mut().for_each(|p| *p = map(*p));
    shapes
}

/// A turn that leaves no face parallel to an axis.
fn turn(v: Vec3) -> Vec3 {
    glam::Quat::from_euler(glam::EulerRot::XYZ, 0.3, 0.7, 1.1) * v
}

/// A closed prism over a right triangle with this angle in degrees.
fn wedge(angle: f32) -> Shapes {
    let height = 2.0 * angle.to_radians().tan();
    let profile = [Vec3::ZERO, Vec3::X * 2.0, Vec3::new(2.0, height, 0.0)];
    let positions = profile
        .into_iter()
        .chain(profile.map(|p| p - Vec3::Z * 2.0));
    Shapes {
        positions: positions.map(turn).collect(),
        triangles: vec![
            [0, 1, 2],
            [5, 4, 3],
            [0, 3, 4],
            [0, 4, 1],
            [1, 4, 5],
            [1, 5, 2],
            [2, 5, 3],
            [2, 3, 0],
        ],
        spheres: Vec::new(),
    }
}

/// A direction on the side of `normal`; one in five at a cosine of 1e-6 to 1e-1.
pub(crate) fn leaving(random: &mut Random, normal: Vec3) -> Vec3 {
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

/// Where on a triangle a ray starts.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Start {
    Anywhere,
    NearEdge,
    Edge,
    Corner,
}

/// The three barycentric weights of a point.
pub(crate) fn weights(random: &mut Random, start: Start) -> [f32; 3] {
    let near = match start {
        Start::Anywhere => random.unit(),
        Start::NearEdge => 10.0_f32.powf(-7.0 * random.unit()),
        Start::Edge | Start::Corner => 0.0,
    };
    let other = match start {
        Start::Corner => 0.0,
        _ => (1.0 - near) * random.unit(),
    };
    let mut weights = [near, other, 1.0 - near - other];
    weights.rotate_left(random.below(3));
    weights
}

#[test]
fn a_ray_that_leaves_a_floor_for_good_tests_none_of_it() {
    let mut random = Random::new(3);
    let sizes = [1e-3, 1.0, 300.0];
    for (height, size) in [0.0, 1e-3, -0.7, 1000.1]
        .into_iter()
        .flat_map(|height| sizes.map(|size| (height, size)))
    {
        for axis in 0..3 {
            let corners = [[-1.0, -1.0], [1.0, -0.5], [0.9, 1.0], [-1.0, 0.3]];
            let at = |[x, z]: [f32; 2]| {
                let mut point = Vec3::new(x * size, height, z * size).to_array();
                point.swap(1, axis);
                Vec3::from_array(point)
            };
            let shapes = Shapes {
                positions: corners.map(at).to_vec(),
                triangles: vec![[0, 1, 2], [0, 2, 3]],
                spheres: Vec::new(),
            };
            let floor = Aggregate::build(shapes.clone(), BvhSettings::default()).without_sweep();
            let normal = Vec3::AXES[axis] * if random.unit() < 0.5 { -1.0 } else { 1.0 };
            let rays: Vec<Ray> = (0..300)
                .map(|i| {
                    let start = [Start::Anywhere, Start::NearEdge, Start::Corner][i % 3];
                    let vertices = shapes.vertices(i % 2);
                    let [_, b1, b2] = weights(&mut random, start);
                    let at = triangle_point_and_error(&vertices, b1, b2);
                    let (point, error) = triangle_departure(&vertices, b1, b2, at);
                    let direction = leaving(&mut random, normal);
                    Ray::new(offset_origin(point, error, normal, direction), direction)
                })
                .collect();
            let mut counts = TraceCounts::default();
            floor.any_hit(&rays, &mut vec![false; rays.len()], &mut counts);
            floor.closest_hit(&rays, &mut vec![Hit::MISS; rays.len()], &mut counts);
            assert_eq!(counts.primitive_tests, 0, "{height} {size} {axis}");
            assert_eq!(counts.rays, 600);
        }
    }
}

/// How rays that leave a closed mesh go astray.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Strays {
    /// They start inside and meet nothing.
    pub(crate) escapes: usize,
    /// They meet the triangle they leave.
    pub(crate) self_hits: usize,
    /// They meet a triangle from the side that they cannot be on.
    pub(crate) crossings: usize,
}

/// A closed mesh and the unit normals of its triangles by winding.
struct Body<'a> {
    shapes: &'a Shapes,
    normals: Vec<Vec3>,
}

/// A ray that leaves triangle `id` of a closed mesh.
struct Departure {
    id: usize,
    inside: bool,
    ray: Ray,
}

impl<'a> Body<'a> {
    fn new(shapes: &'a Shapes) -> Self {
        let normal = |id| {
            let [a, b, c] = shapes.vertices(id).map(Vec3::as_dvec3);
            (b - a).cross(c - a).normalize().as_vec3()
        };
        Self {
            shapes,
            normals: (0..shapes.triangles.len()).map(normal).collect(),
        }
    }

    fn departure(&self, random: &mut Random, start: Start) -> Departure {
        let id = random.below(self.normals.len());
        let [_, b1, b2] = weights(random, start);
        let corners = self.shapes.vertices(id);
        let at = triangle_point_and_error(&corners, b1, b2);
        let (point, error) = triangle_departure(&corners, b1, b2, at);
        let outward = self.normals[id];
        let inside = random.unit() < 0.5;
        let direction = leaving(random, if inside { -outward } else { outward });
        let origin = offset_origin(point, error, outward, direction);
        Departure {
            id,
            inside,
            ray: Ray::new(origin, direction),
        }
    }

    fn strays(&self, departures: &[Departure], hits: &[Hit]) -> Strays {
        let mut strays = Strays::default();
        for (from, hit) in departures.iter().zip(hits) {
            if hit.is_miss() {
                strays.escapes += usize::from(from.inside);
            } else if hit.primitive == from.id as u32 {
                strays.self_hits += 1;
            } else {
                let met = self.normals[hit.primitive as usize];
                let from_inside = from.ray.direction.dot(met) > 0.0;
                strays.crossings += usize::from(from_inside != from.inside);
            }
        }
        strays
    }
}

/// `n` rays, about half of them inwards, half of them from near edges, and a quarter more from
/// exactly on edges and corners.
fn check(name: &str, shapes: &Shapes, n: usize) {
    const BATCH: usize = 5_000;
    let body = Body::new(shapes);
    let aggregates = scenes::aggregates(shapes, BvhSettings::default());
    let mut random = Random::new(1);
    for (start, n) in [
        (Start::Anywhere, n / 2),
        (Start::NearEdge, n / 2),
        (Start::Edge, n / 8),
        (Start::Corner, n / 8),
    ] {
        for _ in 0..n / BATCH {
            let departures: Vec<_> = (0..BATCH)
                .map(|_| body.departure(&mut random, start))
                .collect();
            let rays: Vec<_> = departures.iter().map(|d| d.ray).collect();
            for (variant, aggregate) in &aggregates {
                let strays = body.strays(&departures, &scenes::closest(aggregate, &rays));
                assert_eq!(strays, Strays::default(), "{name} {variant} {start:?}");
            }
        }
    }
}

fn check_cubes(n: usize) {
    for scale in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
        let cube = mapped(scenes::cube(), |p| turn(p) * scale);
        check(&format!("scale {scale}"), &cube, n);
    }
}

#[test]
fn g10_rays_from_the_faces_of_a_closed_cube_stay_on_their_side() {
    check_cubes(1_000_000);
}

#[test]
#[ignore = "the long form"]
fn g10_rays_from_the_faces_of_a_closed_cube_stay_on_their_side_at_length() {
    check_cubes(10_000_000);
}

#[test]
fn g10_so_do_rays_from_other_closed_bodies() {
    let body = |map: fn(Vec3) -> Vec3| mapped(scenes::cube(), map);
    for (name, shapes) in [
        ("cube along the axes", scenes::cube()),
        ("plate", body(|p| turn(p * Vec3::new(1.0, 0.1, 1.0)))),
        ("rod", body(|p| turn(p * Vec3::new(0.1, 0.1, 1.0)))),
        ("small", body(|p| turn(p) * 1e-3 + Vec3::new(0.7, 0.8, 0.9))),
        ("corner at the origin", body(|p| turn(p + 1.0))),
        ("wedge of 45 degrees", wedge(45.0)),
        ("wedge of 10 degrees", wedge(10.0)),
        ("smooth sphere", scenes::smooth_sphere()),
        ("spiky sphere", scenes::spiky_sphere()),
    ] {
        check(name, &shapes, 80_000);
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
        let shapes = Shapes {
            spheres,
            ..Shapes::default()
        };
        let mut random = Random::new(2);
        let rays: Vec<_> = (0..200_000)
            .map(|i| {
                let (point, error) = sphere.point_and_error(center + random.direction() * radius);
                let outward = (point - center).normalize();
                let direction = leaving(&mut random, if i % 2 == 0 { -outward } else { outward });
                Ray::new(offset_origin(point, error, outward, direction), direction)
            })
            .collect();
        for (variant, aggregate) in scenes::aggregates(&shapes, BvhSettings::default()) {
            let hits = scenes::closest(&aggregate, &rays);
            for (i, (ray, hit)) in rays.iter().zip(hits).enumerate() {
                assert_eq!(hit.is_miss(), i % 2 == 1, "{variant} {ray:?} {hit:?}");
            }
        }
    }
}
