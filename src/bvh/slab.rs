use glam::Vec3;

use crate::math::{Aabb, Ray, gamma};

/// Nothing at or beyond this ray parameter is ever reported.
///
/// Far below `f32::MAX` times the least padding, so that a ray parallel to a slab is decided by the
/// side of its origin alone.
pub const T_FAR: f32 = 1e18;

/// Least distance by which a box is padded.
const MIN_PAD: f32 = 1e-20;

/// Padding as a fraction of the longest edge: a primitive's own test may be off by a few roundings
/// of numbers as large as the primitive.
const PAD: f32 = gamma(16);

/// Factor on the far end of the interval: the primitive's own test may be off by a few roundings of
/// numbers as large as its distance too. Ize 2013, "Robust BVH Ray Traversal", derives 1 + 2γ(3)
/// for the roundings of the box test alone.
pub(super) const FAR_MARGIN: f32 = 1.0 + 2.0 * gamma(8);

/// The box that stands for `bounds` in the tree: slightly larger on every side, never flat.
pub fn padded(bounds: Aabb) -> Aabb {
    let pad = (bounds.extent().max_element() * PAD).max(MIN_PAD);
    let outward = |v: Vec3, sign: f32| {
        let moved = v + Vec3::splat(sign * pad);
        if sign < 0.0 {
            Vec3::from_array(moved.to_array().map(f32::next_down))
        } else {
            Vec3::from_array(moved.to_array().map(f32::next_up))
        }
    };
    Aabb {
        min: outward(bounds.min, -1.0),
        max: outward(bounds.max, 1.0),
    }
}

/// A ray prepared for box tests.
#[derive(Clone, Copy, Debug)]
pub struct SlabRay {
    pub(super) origin: Vec3,
    pub(super) inverse: Vec3,
    /// Whether the direction points down the axis.
    pub(super) negative: [bool; 3],
    pub(super) t_min: f32,
    t_max: f32,
}

impl SlabRay {
    /// Prepares `ray`; `None` when it cannot meet anything (a number that is not finite, no
    /// direction, nothing between `t_min` and `t_max`).
    pub fn new(ray: &Ray) -> Option<Self> {
        let valid = ray.origin.is_finite()
            && ray.direction.is_finite()
            && ray.direction != Vec3::ZERO
            && ray.t_min < ray.t_max
            && ray.t_min.is_finite();
        valid.then(|| Self {
            origin: ray.origin,
            // -0 becomes +0; the reciprocal stays finite, so that 0 · inf cannot arise.
            inverse: (ray.direction + Vec3::ZERO)
                .recip()
                .clamp(Vec3::splat(-f32::MAX), Vec3::splat(f32::MAX)),
            negative: ray.direction.to_array().map(|d| d < 0.0),
            t_min: ray.t_min,
            t_max: ray.t_max.min(T_FAR),
        })
    }

    /// The start of the valid interval.
    pub fn t_min(&self) -> f32 {
        self.t_min
    }

    /// The end of the valid interval, at most [`T_FAR`].
    pub fn t_max(&self) -> f32 {
        self.t_max
    }

    /// A bit for each axis on which the direction points down.
    pub(super) fn octant(&self) -> usize {
        let [x, y, z] = self.negative.map(usize::from);
        x | y << 1 | z << 2
    }

    /// The ray parameter at which the ray enters `bounds` (at least `t_min`), `None` if it misses.
    pub fn enter(&self, bounds: &Aabb) -> Option<f32> {
        let lo = (bounds.min - self.origin) * self.inverse;
        let hi = (bounds.max - self.origin) * self.inverse;
        let near = lo.min(hi).max_element().max(self.t_min);
        let far = lo.max(hi).min_element().min(self.t_max);
        (near <= far * FAR_MARGIN).then_some(near)
    }
}
