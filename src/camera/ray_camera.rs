use glam::{DVec2, DVec3, Vec2, Vec3};

use super::Camera;
use crate::math::{Normalization, Ray};

/// A camera made ready for one picture size: rays in tracing space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayCamera {
    eye: DVec3,
    pub(super) right: DVec3,
    pub(super) up: DVec3,
    pub(super) forward: DVec3,
    pub(super) half_width: f64,
    pub(super) half_height: f64,
    pub(super) width: f64,
    pub(super) height: f64,
    pub(super) lens_radius: f64,
    focal_distance: f64,
}

impl RayCamera {
    /// The rays of `camera` for a picture of `width` × `height` pixels of a scene that was moved
    /// by `normalization`.
    pub fn new(camera: &Camera, width: u32, height: u32, normalization: &Normalization) -> Self {
        let (right, up, back) = camera.basis();
        let (half_width, half_height) = camera.half_extent(width, height);
        Self {
            eye: normalization.point_to_scene_f64(camera.eye),
            right,
            up,
            forward: -back,
            half_width,
            half_height,
            width: f64::from(width.max(1)),
            height: f64::from(height.max(1)),
            lens_radius: camera.lens_radius * normalization.scale,
            focal_distance: camera.focal_distance * normalization.scale,
        }
    }

    /// The ray through `position` (pixels, x right, y down, (0, 0) the top left corner of the
    /// picture). `lens` is uniform on the unit disk and is used only by cameras with a lens.
    /// The direction is of unit length.
    pub fn generate_ray(&self, position: Vec2, lens: impl FnOnce() -> Vec2) -> Ray {
        let (origin, direction) = self.generate_ray_f64(position.as_dvec2(), || lens().as_dvec2());
        Ray::new(origin.as_vec3(), direction.as_vec3())
    }

    /// Where the rays of a camera without a lens start, in tracing space.
    pub fn eye(&self) -> Vec3 {
        self.eye.as_vec3()
    }

    /// Origin and unit direction of [`Self::generate_ray`] in double precision.
    pub fn generate_ray_f64(
        &self,
        position: DVec2,
        lens: impl FnOnce() -> DVec2,
    ) -> (DVec3, DVec3) {
        let x = (2.0 * position.x / self.width - 1.0) * self.half_width;
        let y = (1.0 - 2.0 * position.y / self.height) * self.half_height;
        let direction = self.right * x + self.up * y + self.forward;
        if self.lens_radius == 0.0 {
            return (self.eye, unit(direction));
        }
        let lens = lens() * self.lens_radius;
        let origin = self.eye + self.right * lens.x + self.up * lens.y;
        let in_focus = self.eye + direction * self.focal_distance;
        (origin, unit(in_focus - origin))
    }
}

fn unit(direction: DVec3) -> DVec3 {
    direction.normalize_or(DVec3::NEG_Z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Framing;

    fn camera(lens_radius: f64) -> RayCamera {
        let camera = Camera {
            eye: DVec3::new(0.0, 0.0, 2.0),
            framing: Framing::Horizontal(90_f64.to_radians()),
            lens_radius,
            focal_distance: 3.0,
            ..Camera::default()
        };
        RayCamera::new(&camera, 200, 100, &Normalization::IDENTITY)
    }

    #[test]
    fn corners_look_where_they_should() {
        let ray = camera(0.0).generate_ray(Vec2::new(0.0, 0.0), || Vec2::ZERO);
        assert!((ray.direction - Vec3::new(-1.0, 0.5, -1.0).normalize()).length() < 1e-6);
        let middle = camera(0.0).generate_ray(Vec2::new(100.0, 50.0), || Vec2::ZERO);
        assert_eq!(middle.direction, Vec3::NEG_Z);
        assert_eq!(middle.origin, Vec3::new(0.0, 0.0, 2.0));
    }

    #[test]
    fn all_lens_rays_of_a_pixel_meet_in_the_focal_plane() {
        let lens_points = [Vec2::ZERO, Vec2::X, Vec2::NEG_Y, Vec2::new(0.3, -0.6)];
        let met = lens_points.map(|lens| {
            let ray = camera(0.25).generate_ray(Vec2::new(37.0, 81.0), || lens);
            ray.at((-1.0 - ray.origin.z) / ray.direction.z)
        });
        assert!(met.iter().all(|p| (*p - met[0]).length() < 1e-5), "{met:?}");
    }
}
