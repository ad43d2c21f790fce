use glam::{Vec3, Vec4, Vec4Swizzles};

use super::node::Pair;
use crate::math::{Aabb, Ray, gamma};

/// Nothing at or beyond this ray parameter is ever reported.
///
/// Far below `f32::MAX` / [`MIN_PAD`], so that a ray parallel to a slab is decided by the side of
/// its origin alone.
pub const T_FAR: f32 = 1e18;

/// Least distance by which a box is padded.
const MIN_PAD: f32 = 1e-20;

/// A primitive's own test may be off by a few roundings of numbers as large as the primitive …
const PAD: f32 = gamma(16);

/// … and of numbers as large as its distance. Ize 2013, "Robust BVH Ray Traversal", derives
/// 1 + 2γ(3) for the roundings of the box test alone; the rest is for the primitive test.
const FAR_MARGIN: f32 = 1.0 + 2.0 * gamma(8);

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
    origin: Vec3,
    inverse: Vec3,
    t_min: f32,
    t_max: f32,
}

impl SlabRay {
    /// Prepares `ray`; `None` when it cannot meet anything (a number that is not finite, no
    /// direction, nothing between `t_min` and `t_max`).
    pub fn new(ray: &Ray) -> Option<Self> {
        // Sums are finite only if every term is, and a few finite terms of this size cannot overflow.
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

    /// The ray parameter at which the ray enters `bounds` (at least `t_min`), `None` if it misses.
    pub fn enter(&self, bounds: &Aabb) -> Option<f32> {
        let lo = (bounds.min - self.origin) * self.inverse;
        let hi = (bounds.max - self.origin) * self.inverse;
        let near = lo.min(hi).max_element().max(self.t_min);
        let far = lo.max(hi).min_element().min(self.t_max);
        (near <= far * FAR_MARGIN).then_some(near)
    }

    /// Entry parameters of both boxes of a pair, and which of them the ray meets before `limit`.
    ///
    /// The same operations as [`Self::enter`], hence the same numbers.
    #[inline(always)]
    pub(super) fn enter_pair(&self, pair: &Pair, limit: f32) -> ([f32; 2], [bool; 2]) {
        let t = |axis: usize| {
            (pair.planes[axis] - Vec4::splat(self.origin[axis])) * Vec4::splat(self.inverse[axis])
        };
        let (x, y, z) = (t(0), t(1), t(2));
        let (xs, ys, zs) = (x.zwxy(), y.zwxy(), z.zwxy());
        let near = x
            .min(xs)
            .max(y.min(ys))
            .max(z.min(zs).max(Vec4::splat(self.t_min)));
        let far = x
            .max(xs)
            .min(y.max(ys))
            .min(z.max(zs).min(Vec4::splat(limit)));
        let meets = near.cmple(far * FAR_MARGIN);
        ([near.x, near.y], [meets.test(0), meets.test(1)])
    }
}
