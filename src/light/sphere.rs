use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::{EmissionBounds, LightHit, LightSample, usable_pdf};
use crate::color::{Rgb, luminance};
use crate::geometry::{Shapes, Sphere};
use crate::math::Frame;
use crate::sampling::{UNIFORM_SPHERE_PDF, uniform_cone, uniform_cone_pdf, uniform_sphere};

/// Points whose distance to the centre differs from the radius by less, relatively, are on the sphere.
const ON_SURFACE: f32 = 1e-5;

/// A sphere of the scene that emits constant radiance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereLight {
    /// Primitive id of the sphere.
    pub primitive: u32,
    /// Radiance.
    pub radiance: Rgb,
    /// True when the inside emits too, not only the outside.
    pub two_sided: bool,
}

impl SphereLight {
    /// Outside: the cone that the sphere fills, evenly (Pharr, Jakob, Humphreys 2016, section
    /// 14.2.2). Inside: all directions evenly, if the inside emits.
    pub(super) fn sample(&self, shapes: &Shapes, from: Vec3, u: Vec2) -> Option<LightSample> {
        let sphere = shapes.sphere(self.primitive)?;
        let placed = match self.cone(from, sphere) {
            Some(cone) => cone.sample(sphere, u),
            None if self.two_sided => sample_inside(from, sphere, u),
            None => return None,
        };
        let (wi, distance, normal, pdf) = placed;
        Some(LightSample {
            wi,
            distance: (distance > 0.0).then_some(distance)?,
            radiance: self.radiance,
            pdf: usable_pdf(pdf)?,
            is_delta: false,
            point: sphere.center + sphere.radius * normal,
            normal,
        })
    }

    pub(super) fn pdf(&self, shapes: &Shapes, from: Vec3, wi: Vec3, hit: LightHit) -> f32 {
        let Some(sphere) = shapes.sphere(self.primitive) else {
            return 0.0;
        };
        match self.cone(from, sphere) {
            Some(cone) if hit.normal.dot(wi) < 0.0 => uniform_cone_pdf(cone.one_minus_cos),
            None if self.two_sided => UNIFORM_SPHERE_PDF,
            _ => 0.0,
        }
    }

    /// The cone that the sphere fills as seen from `from`; `None` where the inside is sampled.
    ///
    /// A point on the sphere itself may have been rounded to either side. It sees nothing of a
    /// sphere that emits outwards only, and the inside of one that emits on both sides.
    fn cone(&self, from: Vec3, sphere: &Sphere) -> Option<Cone> {
        let is_on_surface = (from.distance(sphere.center) / sphere.radius - 1.0).abs() < ON_SURFACE;
        (!is_on_surface)
            .then(|| Cone::seen_from(from, sphere))
            .flatten()
    }

    pub(super) fn radiance_at(&self, normal: Vec3, wi: Vec3) -> Rgb {
        if self.two_sided || normal.dot(wi) < 0.0 {
            self.radiance
        } else {
            Rgb::ZERO
        }
    }

    pub(super) fn power(&self, shapes: &Shapes) -> f32 {
        let radius = shapes.sphere(self.primitive).map_or(0.0, |s| s.radius);
        let sides = if self.two_sided { 2.0 } else { 1.0 };
        PI * sides * 4.0 * PI * radius * radius * luminance(self.radiance)
    }

    /// From far away the sphere looks like a disk.
    pub(super) fn bounds(&self, shapes: &Shapes) -> Option<EmissionBounds> {
        let sphere = shapes.sphere(self.primitive)?;
        let intensity = PI * sphere.radius * sphere.radius * luminance(self.radiance);
        EmissionBounds::round(sphere.center, sphere.radius, intensity)
    }
}

/// The directions in which a sphere is seen from outside.
struct Cone {
    axis: Vec3,
    distance: f32,
    /// Distance to the surface, (d − r) first so that it survives far away and close by.
    tangent2: f32,
    one_minus_cos: f32,
}

impl Cone {
    /// `None` on and inside the sphere.
    fn seen_from(from: Vec3, sphere: &Sphere) -> Option<Self> {
        let to_center = sphere.center - from;
        let distance = to_center.length();
        let tangent2 = (distance - sphere.radius) * (distance + sphere.radius);
        let ratio = sphere.radius / distance;
        let sin2 = ratio * ratio;
        if !(tangent2 > 0.0 && sin2 < 1.0 && distance.is_finite()) {
            return None;
        }
        Some(Self {
            axis: to_center / distance,
            distance,
            tangent2,
            // 1 − √(1 − s) without cancellation for small spheres.
            one_minus_cos: sin2 / (1.0 + (tangent2.sqrt() / distance)),
        })
    }

    /// Direction, distance, normal at the near side of the sphere, density.
    fn sample(&self, sphere: &Sphere, u: Vec2) -> (Vec3, f32, Vec3, f32) {
        let local = uniform_cone(u, self.one_minus_cos);
        let frame = Frame::from_normal(self.axis);
        let sin2 = local.x * local.x + local.y * local.y;
        let (radius, d) = (sphere.radius, self.distance);
        // Half the chord, from the distance of the ray to the centre.
        let offset2 = (d * d * sin2).min(radius * radius);
        let half_chord = (radius * radius - offset2).max(0.0).sqrt();
        let distance = self.tangent2 / (d * local.z + half_chord);
        let across = Vec3::new(local.x, local.y, 0.0) * (distance / radius);
        let toward = (1.0 - across.length_squared()).max(0.0).sqrt();
        let normal = frame.to_world(Vec3::new(across.x, across.y, -toward));
        (
            frame.to_world(local).normalize(),
            distance,
            normal.normalize(),
            uniform_cone_pdf(self.one_minus_cos),
        )
    }
}

/// As [`Cone::sample`], for a point inside: the far side along an even direction.
fn sample_inside(from: Vec3, sphere: &Sphere, u: Vec2) -> (Vec3, f32, Vec3, f32) {
    let wi = uniform_sphere(u);
    let to_center = sphere.center - from;
    let along = to_center.dot(wi);
    let offset2 = (to_center - along * wi).length_squared();
    let half_chord = (sphere.radius * sphere.radius - offset2).max(0.0).sqrt();
    let distance = along + half_chord;
    let normal = (distance * wi - to_center).normalize_or_zero();
    (wi, distance, normal, UNIFORM_SPHERE_PDF)
}
