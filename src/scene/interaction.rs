use glam::Vec3;

use super::PreparedScene;
use crate::geometry::{Hit, SurfacePoint};
use crate::math::Ray;

/// The surface at a hit, in tracing space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceInteraction {
    /// The point, rounded onto the surface.
    pub point: Vec3,
    /// Where rays leave: `point`, but a little inwards of the edges of a triangle.
    pub departure: Vec3,
    /// Bound of the absolute error of each coordinate of `departure`.
    pub error: Vec3,
    /// Unit normal of the true surface: by winding, or outwards for spheres.
    pub geometric_normal: Vec3,
    /// Unit normal used for scattering, on the same side as `geometric_normal`.
    pub shading_normal: Vec3,
    /// Primitive id.
    pub primitive: u32,
}

impl PreparedScene {
    /// The surface where `ray` met `hit`, which is not a miss.
    pub fn interaction(&self, ray: &Ray, hit: &Hit) -> SurfaceInteraction {
        let shapes = self.aggregate().shapes();
        if let Some(sphere) = shapes.sphere(hit.primitive) {
            let (point, error) = sphere.point_and_error(ray.at(hit.t));
            let normal = (point - sphere.center).normalize_or(Vec3::Z);
            return SurfaceInteraction {
                point,
                departure: point,
                error,
                geometric_normal: normal,
                shading_normal: normal,
                primitive: hit.primitive,
            };
        }
        let SurfacePoint {
            point,
            departure,
            error,
            normal: geometric_normal,
        } = self.aggregate().surface_point(hit);
        let shading_normal =
            self.corner_normals(hit.primitive)
                .map_or(geometric_normal, |[n0, n1, n2]| {
                    let b0 = 1.0 - hit.b1 - hit.b2;
                    (b0 * n0 + hit.b1 * n1 + hit.b2 * n2).normalize_or(geometric_normal)
                });
        SurfaceInteraction {
            point,
            departure,
            error,
            geometric_normal,
            shading_normal,
            primitive: hit.primitive,
        }
    }
}
