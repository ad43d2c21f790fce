use glam::{DVec3, Vec3};

use super::departure::departure_weights;
use super::{Aggregate, Hit, Instance, triangle_departure, triangle_point_and_error};
use crate::math::gamma;

/// A point of a triangle that a ray has met, in the space of the rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, rounded onto the surface.
    pub point: Vec3,
    /// Where rays leave: `point`, but a little inwards of the edges.
    pub departure: Vec3,
    /// Bound of the absolute error of each coordinate of `departure`, as seen by the triangle test
    /// of a ray that leaves it.
    pub error: Vec3,
    /// Unit normal, by winding.
    pub normal: Vec3,
}

impl Aggregate {
    /// The vertices of triangle `primitive`, counter-clockwise seen from the front: those of the
    /// shapes as they are, those of instances in the space of the rays.
    ///
    /// # Panics
    /// If `primitive` is not a triangle.
    pub fn vertices(&self, primitive: u32) -> [DVec3; 3] {
        match self.find_instance(primitive) {
            Some((instance, triangle)) => instance.vertices(triangle),
            None => (self.shapes().vertices(primitive as usize)).map(|v| v.as_dvec3()),
        }
    }

    /// The point of the triangle that `hit` is on.
    ///
    /// # Panics
    /// If `hit` is a miss or on a sphere.
    pub fn surface_point(&self, hit: &Hit) -> SurfacePoint {
        if let Some((instance, triangle)) = self.find_instance(hit.primitive) {
            return instance_point(instance, triangle, hit);
        }
        let vertices = self.shapes().vertices(hit.primitive as usize);
        let at = triangle_point_and_error(&vertices, hit.b1, hit.b2);
        let (departure, error) = triangle_departure(&vertices, hit.b1, hit.b2, at);
        let [a, b, c] = vertices;
        let (ab, ac) = ((b - a).as_dvec3(), (c - a).as_dvec3());
        SurfacePoint {
            point: at.0,
            departure,
            error,
            normal: ab.cross(ac).normalize_or(DVec3::Z).as_vec3(),
        }
    }
}

/// The point in double precision: single precision rounds it once, at the end.
fn instance_point(instance: &Instance, triangle: usize, hit: &Hit) -> SurfacePoint {
    let object = instance.object_vertices(triangle);
    let to_world = instance.placement().world_from_object();
    let world = object.map(|vertex| to_world.transform_point3(vertex));
    let point = interpolate(&world, hit.b1, hit.b2).as_vec3();
    let error = point_error(instance, &object, point, (hit.b1, hit.b2));
    let vertices = world.map(|vertex| vertex.as_vec3());
    let weights = departure_weights(&vertices, hit.b1, hit.b2, error.max_element());
    let departure = weights.map_or(point, |[b1, b2]| interpolate(&world, b1, b2).as_vec3());
    let [a, b, c] = object;
    let [ab, ac] = [b - a, c - a].map(|edge| to_world.transform_vector3(edge));
    SurfacePoint {
        point,
        departure,
        error,
        normal: ab.cross(ac).normalize_or(DVec3::Z).as_vec3(),
    }
}

fn interpolate([a, b, c]: &[DVec3; 3], b1: f32, b2: f32) -> DVec3 {
    let (b1, b2) = (f64::from(b1), f64::from(b2));
    a * (1.0 - b1 - b2) + b * b1 + c * b2
}

/// How far the plane of the triangle can seem to be from `point` to a ray that leaves there.
///
/// Such a ray goes into the space of the mesh, where its origin is rounded once more and the test
/// rounds in proportion to the vertices seen from there, as in [`triangle_point_and_error`]. A
/// direction that is off by a rounding of each component has moved the ray by as many roundings of
/// the triangle's size at most where it would leave the triangle. An error e in the space of the
/// mesh is one of |M| e in the space of the rays, M the linear part of the map and |M| the same with
/// absolute values: n·M e is at most |n|·|M| e for any normal n.
fn point_error(
    instance: &Instance,
    object: &[DVec3; 3],
    point: Vec3,
    (b1, b2): (f32, f32),
) -> Vec3 {
    let inside = interpolate(object, b1, b2);
    let reach = object
        .map(|vertex| (vertex - inside).abs().max_element())
        .into_iter()
        .fold(0.0, f64::max);
    let error = inside.abs() * f64::from(gamma(2)) + DVec3::splat(reach * f64::from(gamma(12)));
    instance.placement().error_to_world(error) + point.abs() * gamma(2)
}
