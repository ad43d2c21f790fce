use glam::Vec3;

use super::PreparedScene;
use crate::geometry::Hit;
use crate::math::{Ray, gamma};

/// The surface at a hit, in tracing space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceInteraction {
    /// The point, rounded onto the surface.
    pub point: Vec3,
    /// Bound of the absolute error of each coordinate of `point`.
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
            // Moved back onto the sphere, the point is as good as f32 can hold it
            // (Pharr, Jakob, Humphreys 2016, section 3.9.4).
            let normal = (ray.at(hit.t) - sphere.center).normalize_or(Vec3::Z);
            let point = sphere.center + normal * sphere.radius;
            return SurfaceInteraction {
                point,
                error: gamma(6) * (sphere.center.abs() + normal.abs() * sphere.radius),
                geometric_normal: normal,
                shading_normal: normal,
                primitive: hit.primitive,
            };
        }
        let [a, b, c] = shapes.vertices(hit.primitive as usize);
        let b0 = 1.0 - hit.b1 - hit.b2;
        let point = b0 * a + hit.b1 * b + hit.b2 * c;
        let error = gamma(7) * ((b0 * a).abs() + (hit.b1 * b).abs() + (hit.b2 * c).abs());
        let (ab, ac) = ((b - a).as_dvec3(), (c - a).as_dvec3());
        let geometric_normal = ab.cross(ac).normalize_or(glam::DVec3::Z).as_vec3();
        let shading_normal = self
            .corner_normals(hit.primitive)
            .map_or(geometric_normal, |[n0, n1, n2]| {
                (b0 * n0 + hit.b1 * n1 + hit.b2 * n2).normalize_or(geometric_normal)
            });
        SurfaceInteraction {
            point,
            error,
            geometric_normal,
            shading_normal,
            primitive: hit.primitive,
        }
    }
}
