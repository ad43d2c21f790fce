//! What a ray meets: intersections in double precision under the boxes of the tree.

use glam::DVec3;

use crate::bvh::{Bvh, NodeId};
use crate::geometry::{Aggregate, Instance, Sphere};
use crate::math::Aabb;
use crate::scene::PreparedScene;

/// The points `origin + t · direction` with 0 < t < `t_max`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
    pub(super) t_max: f64,
}

/// Where a ray meets a primitive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    pub(super) t: f64,
    pub(super) primitive: u32,
    /// Barycentric weights of the second and third vertex; 0 for a sphere.
    pub(super) weights: (f64, f64),
}

/// The first hit of `ray`.
pub(super) fn closest(scene: &PreparedScene, ray: &Ray) -> Option<Hit> {
    let aggregate = scene.aggregate();
    let mut best: Option<Hit> = None;
    walk(aggregate.bvh(), ray, &mut best, &mut |node, best| {
        for primitive in aggregate.primitives(node) {
            take(best, ray, meet(aggregate, primitive, ray));
        }
    });
    let Some(instances) = aggregate.instances() else {
        return best;
    };
    walk(instances.bvh(), ray, &mut best, &mut |node, best| {
        for number in instances.below(node) {
            meet_instance(aggregate, &instances.list()[number], ray, best);
        }
    });
    best
}

/// Goes down the tree of the mesh in the space of the mesh; its triangles are met in the world.
fn meet_instance(aggregate: &Aggregate, instance: &Instance, ray: &Ray, best: &mut Option<Hit>) {
    let to_object = instance.placement().object_from_world();
    let inside = Ray {
        origin: to_object.transform_point3(ray.origin),
        direction: to_object.transform_vector3(ray.direction),
        t_max: ray.t_max,
    };
    let mesh = instance.mesh();
    walk(mesh.bvh(), &inside, best, &mut |node, best| {
        for triangle in mesh.primitives(node) {
            let primitive = instance.first_primitive() + triangle;
            take(best, ray, meet(aggregate, primitive, ray));
        }
    });
}

/// Shows `leaf` the leaves of a tree that `ray` meets before the best hit so far.
fn walk(
    bvh: &Bvh,
    ray: &Ray,
    best: &mut Option<Hit>,
    leaf: &mut dyn FnMut(NodeId, &mut Option<Hit>),
) {
    let mut stack: Vec<_> = bvh.root().into_iter().collect();
    while let Some(node) = stack.pop() {
        let t_max = best.map_or(ray.t_max, |hit| hit.t);
        if !meets_box(ray, &bvh.bounds(node), t_max) {
            continue;
        }
        match bvh.children(node) {
            Some(children) => stack.extend(children),
            None => leaf(node, best),
        }
    }
}

/// Keeps `hit` if it is nearer than the best so far.
fn take(best: &mut Option<Hit>, ray: &Ray, hit: Option<Hit>) {
    let t_max = best.map_or(ray.t_max, |hit| hit.t);
    *best = hit.filter(|hit| hit.t < t_max).or(*best);
}

/// True when anything lies on `ray`.
pub(super) fn is_occluded(scene: &PreparedScene, ray: &Ray) -> bool {
    closest(scene, ray).is_some()
}

/// Kay and Kajiya 1986, "Ray Tracing Complex Scenes". The boxes are padded by far more than a
/// rounding in double precision.
fn meets_box(ray: &Ray, bounds: &Aabb, t_max: f64) -> bool {
    let to_min = (bounds.min.as_dvec3() - ray.origin) / ray.direction;
    let to_max = (bounds.max.as_dvec3() - ray.origin) / ray.direction;
    let (mut near, mut far) = (0.0, t_max);
    for axis in 0..3 {
        near = f64::max(near, to_min[axis].min(to_max[axis]));
        far = f64::min(far, to_min[axis].max(to_max[axis]));
    }
    near <= far
}

fn meet(aggregate: &Aggregate, primitive: u32, ray: &Ray) -> Option<Hit> {
    let (t, weights) = match aggregate.shapes().sphere(primitive) {
        Some(sphere) => (meet_sphere(sphere, ray)?, (0.0, 0.0)),
        None => {
            let (t, b1, b2) = meet_triangle(aggregate.vertices(primitive), ray)?;
            (t, (b1, b2))
        }
    };
    (t > 0.0).then_some(Hit {
        t,
        primitive,
        weights,
    })
}

/// Parameter and weights of the second and third vertex. Möller and Trumbore 1997, "Fast, Minimum
/// Storage Ray/Triangle Intersection".
fn meet_triangle([a, b, c]: [DVec3; 3], ray: &Ray) -> Option<(f64, f64, f64)> {
    let (ab, ac, from_a) = (b - a, c - a, ray.origin - a);
    let p = ray.direction.cross(ac);
    let q = from_a.cross(ab);
    let determinant = ab.dot(p);
    let b1 = from_a.dot(p) / determinant;
    let b2 = ray.direction.dot(q) / determinant;
    let is_inside = b1 >= 0.0 && b2 >= 0.0 && b1 + b2 <= 1.0;
    is_inside.then(|| (ac.dot(q) / determinant, b1, b2))
}

/// The smallest positive parameter: the roots of |o + t d − c|² = r², the one without cancellation
/// first.
fn meet_sphere(sphere: &Sphere, ray: &Ray) -> Option<f64> {
    let radius = f64::from(sphere.radius);
    let from_center = ray.origin - sphere.center.as_dvec3();
    let a = ray.direction.length_squared();
    let half_b = ray.direction.dot(from_center);
    let c = from_center.length_squared() - radius * radius;
    let off_axis = (from_center - ray.direction * (half_b / a)).length_squared();
    let discriminant = a * (radius * radius - off_axis);
    if discriminant < 0.0 {
        return None;
    }
    let q = -(half_b + discriminant.sqrt().copysign(half_b));
    let (t0, t1) = (q / a, c / q);
    [t0.min(t1), t0.max(t1)].into_iter().find(|&t| t > 0.0)
}
