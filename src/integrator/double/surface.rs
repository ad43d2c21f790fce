use glam::DVec3;

use super::trace::{Hit, Ray};
use crate::scene::PreparedScene;

/// How far off its surface a ray starts and ends. Scenes are of unit size, so this is a million
/// roundings in double precision and a thousandth of one in single precision.
const OFFSET: f64 = 1e-10;

/// A point that a ray has met.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface {
    pub(super) point: DVec3,
    /// Unit normal of the true surface: by winding, or outwards for spheres.
    pub(super) geometric_normal: DVec3,
    /// Unit normal for scattering.
    pub(super) shading_normal: DVec3,
    pub(super) primitive: u32,
}

impl Surface {
    /// The surface where `ray` met `hit`.
    pub(super) fn new(scene: &PreparedScene, ray: &Ray, hit: &Hit) -> Self {
        let primitive = hit.primitive;
        if let Some(sphere) = scene.shapes().sphere(primitive) {
            let center = sphere.center.as_dvec3();
            let normal = (ray.origin + ray.direction * hit.t - center).normalize();
            return Self {
                point: center + normal * f64::from(sphere.radius),
                geometric_normal: normal,
                shading_normal: normal,
                primitive,
            };
        }
        let [a, b, c] = scene.aggregate().vertices(primitive);
        let geometric_normal = (b - a).cross(c - a).normalize();
        let (b1, b2) = hit.weights;
        let shading_normal = scene
            .corner_normals(primitive)
            .map_or(geometric_normal, |normals| {
                let [na, nb, nc] = normals.map(|n| n.as_dvec3());
                (na * (1.0 - b1 - b2) + nb * b1 + nc * b2).normalize_or(geometric_normal)
            });
        Self {
            point: a + (b - a) * b1 + (c - a) * b2,
            geometric_normal,
            shading_normal,
            primitive,
        }
    }

    /// Where a ray along `direction` starts.
    pub(super) fn leave(&self, direction: DVec3) -> DVec3 {
        off_surface(self.point, self.geometric_normal, direction)
    }
}

/// `point` a little off its surface, to the side of `direction`.
pub(super) fn off_surface(point: DVec3, normal: DVec3, direction: DVec3) -> DVec3 {
    point + normal * OFFSET.copysign(normal.dot(direction))
}
