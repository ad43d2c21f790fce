use glam::{DAffine3, DMat3, DVec3, Vec3};

use crate::math::{Aabb, Ray, gamma};

/// Roundings by which a ray of an instance and the box test of its tree may be off together: one
/// each for origin and direction, three of the box test, sixteen of its margin at the far end, and
/// some to spare. In single precision; what is computed in double precision adds nothing to speak
/// of.
const ROUNDINGS: u32 = 32;

/// Where an instance of a mesh stands: an affine map that can be undone, in double precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    world_from_object: DAffine3,
    object_from_world: DAffine3,
    is_mirrored: bool,
}

impl Placement {
    /// The map from the space of the mesh to that of the rays; `None` if it is not finite or
    /// flattens the mesh, so that rays could not be brought into the space of the mesh.
    pub fn new(world_from_object: DAffine3) -> Option<Self> {
        let determinant = world_from_object.matrix3.determinant();
        let object_from_world = world_from_object.inverse();
        let is_usable = determinant != 0.0
            && world_from_object.is_finite()
            && object_from_world.is_finite()
            && object_from_world.translation.as_vec3().is_finite();
        is_usable.then_some(Self {
            world_from_object,
            object_from_world,
            is_mirrored: determinant < 0.0,
        })
    }

    /// From the space of the mesh to that of the rays.
    pub fn world_from_object(&self) -> &DAffine3 {
        &self.world_from_object
    }

    /// From the space of the rays to that of the mesh.
    pub fn object_from_world(&self) -> &DAffine3 {
        &self.object_from_world
    }

    /// True when the map turns triangles inside out. Their second and third vertices change places
    /// then, so that they are counter-clockwise seen from the front in the space of the rays too.
    pub fn is_mirrored(&self) -> bool {
        self.is_mirrored
    }

    /// `ray` in the space of the mesh, with the same ray parameters: its direction keeps the length
    /// that the map gives it. Each number is rounded once.
    #[inline]
    pub(super) fn ray_to_object(&self, ray: &Ray, t_max: f32) -> Ray {
        let to_object = &self.object_from_world;
        Ray {
            origin: to_object.transform_point3(ray.origin.as_dvec3()).as_vec3(),
            direction: to_object
                .transform_vector3(ray.direction.as_dvec3())
                .as_vec3(),
            t_min: ray.t_min,
            t_max,
        }
    }

    /// A box around whatever a ray can meet in `object`, the box of a mesh in its own space, if the
    /// coordinates of the ray's origin are at most `reach` away from 0.
    ///
    /// With u half the distance of 1 to the next number: a ray in the space of the mesh has an
    /// origin off by u of each coordinate o and a direction off by u of each component d, and is
    /// taken to meet a box that it passes within about 20 u of t·d. Where it meets the box, t·d is
    /// at most the size of o and of the box's coordinates. So the point of the true ray at t lies
    /// within γ(n) of those sizes of the box. The map brings that into the space of the rays, where
    /// the box test is off by roundings of `reach` once more.
    pub(super) fn bounds_in_world(&self, object: &Aabb, reach: f32) -> Aabb {
        if object.is_empty() {
            return Aabb::EMPTY;
        }
        let (min, max) = (object.min.as_dvec3(), object.max.as_dvec3());
        let (to_world, to_object) = (&self.world_from_object, &self.object_from_world);
        let rounding = f64::from(gamma(ROUNDINGS));
        let reach = f64::from(reach);
        let origin =
            absolute(&to_object.matrix3) * DVec3::splat(reach) + to_object.translation.abs();
        let slack = (origin + min.abs().max(max.abs())) * rounding;
        let center = to_world.transform_point3(min * 0.5 + max * 0.5);
        let half = absolute(&to_world.matrix3) * ((max - min) * 0.5 + slack)
            + DVec3::splat(reach * rounding);
        Aabb {
            min: (center - half).as_vec3().map(f32::next_down),
            max: (center + half).as_vec3().map(f32::next_up),
        }
    }

    /// Bounds of the absolute value of each coordinate in the space of the rays, of vectors with
    /// such bounds in the space of the mesh.
    pub(super) fn error_to_world(&self, object: DVec3) -> Vec3 {
        (absolute(&self.world_from_object.matrix3) * object).as_vec3()
    }
}

fn absolute(m: &DMat3) -> DMat3 {
    DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat4, DQuat, EulerRot};

    fn placed(scale: DVec3, translation: DVec3) -> Placement {
        let turn = DQuat::from_euler(EulerRot::XYZ, 0.4, 1.1, -0.7);
        let map = DMat4::from_scale_rotation_translation(scale, turn, translation);
        Placement::new(DAffine3::from_mat4(map)).expect("it has an inverse")
    }

    #[test]
    fn maps_without_an_inverse_place_nothing() {
        for scale in [DVec3::new(1.0, 0.0, 1.0), DVec3::NAN, DVec3::INFINITY] {
            assert_eq!(Placement::new(DAffine3::from_scale(scale)), None);
        }
        assert!(placed(DVec3::new(1.0, -2.0, 1.0), DVec3::ZERO).is_mirrored());
        assert!(!placed(DVec3::new(1.0, -2.0, -1.0), DVec3::ZERO).is_mirrored());
    }

    #[test]
    fn the_ray_parameter_stays() {
        let place = placed(DVec3::new(0.1, 3.0, 50.0), DVec3::new(4.0, 5.0, 6.0));
        let ray = Ray::new(Vec3::new(1.0, -2.0, 0.5), Vec3::new(0.3, 0.1, -0.8));
        let object = place.ray_to_object(&ray, 9.0);
        assert_eq!((object.t_min, object.t_max), (0.0, 9.0));
        for t in [0.0, 0.5, 7.0] {
            let there = place
                .world_from_object()
                .transform_point3(object.at(t).as_dvec3());
            assert!((there.as_vec3() - ray.at(t)).length() < 1e-5);
        }
    }

    #[test]
    fn the_box_holds_the_mesh_with_little_to_spare() {
        let unit = Aabb::from_points([Vec3::NEG_ONE, Vec3::ONE]);
        let place = placed(DVec3::splat(0.01), DVec3::X);
        let bounds = place.bounds_in_world(&unit, 16.0);
        for i in 0..8 {
            let corner = DVec3::from([0, 1, 2].map(|axis| f64::from(2 * (i >> axis & 1) - 1)));
            let at = place.world_from_object().transform_point3(corner).as_vec3();
            assert_eq!(bounds.grow(at), bounds);
        }
        assert!(bounds.extent().max_element() < 0.036, "{bounds:?}");
        assert!(place.bounds_in_world(&Aabb::EMPTY, 1.0).is_empty());
    }
}
