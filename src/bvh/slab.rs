use glam::{Vec3, Vec4};

use super::node::WIDTH;
use crate::math::{Aabb, Lanes, Ray, gamma};

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
pub const FAR_MARGIN: f32 = 1.0 + 2.0 * gamma(8);

/// Bytes of the planes of one side of all children of a node.
pub(super) const PLANES: u32 = size_of::<[f32; WIDTH]>() as u32;

/// A step of this fraction of a number's size changes it.
const ULP: f32 = f32::EPSILON;

/// The box that stands for `bounds` in the tree: slightly larger on every side, never flat.
///
/// Where `bounds` is flat it grows by hardly more than a rounding: what lies in one plane across an
/// axis is met in that plane, and its own test errs along it only. So a ray that leaves a floor for
/// good, lifted by its error bound ([`crate::math::offset_origin`]), is above its box.
#[inline]
pub fn padded(bounds: Aabb) -> Aabb {
    let extent = bounds.extent();
    let largest = bounds.min.abs().max(bounds.max.abs());
    let pad = Vec3::select(
        extent.cmpeq(Vec3::ZERO),
        largest * ULP + MIN_PAD,
        Vec3::splat(padding(extent.max_element(), largest.max_element())),
    );
    Aabb {
        min: bounds.min - pad,
        max: bounds.max + pad,
    }
}

/// By how much a box is padded whose longest edge is `extent` and whose largest coordinate is
/// `largest` away from 0. One coordinate moves by at least one rounding.
fn padding(extent: f32, largest: f32) -> f32 {
    extent * PAD + (largest * ULP + MIN_PAD)
}

/// The same as [`padded`] for many boxes, a lane each: minimum and maximum per axis.
#[inline(always)]
pub fn padded_each<V: Lanes>(boxes: &mut [[V; 2]; 3]) {
    let [[x0, x1], [y0, y1], [z0, z1]] = *boxes;
    let extents = [x1 - x0, y1 - y0, z1 - z0];
    let larger = |lo: V, hi: V| lo.abs().max(hi.abs());
    let larger = [larger(x0, x1), larger(y0, y1), larger(z0, z1)];
    let extent = extents[0].max(extents[1]).max(extents[2]);
    let largest = larger[0].max(larger[1]).max(larger[2]);
    let least = |largest: V| largest * V::splat(ULP) + V::splat(MIN_PAD);
    let pad = extent * V::splat(PAD) + least(largest);
    for axis in 0..3 {
        let is_flat = extents[axis].eq(V::splat(0.0));
        let pad = V::select(is_flat, least(larger[axis]), pad);
        let [lo, hi] = boxes[axis];
        boxes[axis] = [lo - pad, hi + pad];
    }
}

/// [`SlabRay::can_meet`] for many rays, a lane each: origins, directions, and the ends of the valid
/// intervals.
#[inline(always)]
pub(super) fn can_meet<V: Lanes>(
    origin: [V; 3],
    direction: [V; 3],
    [t_min, t_max]: [V; 2],
) -> V::Mask {
    let zero = V::splat(0.0);
    // Zero, or NaN if anything is infinite or NaN.
    let mut nothing = t_min * zero;
    let mut is_zero = zero.eq(zero);
    for axis in 0..3 {
        nothing = nothing + origin[axis] * zero + direction[axis] * zero;
        is_zero = is_zero & direction[axis].eq(zero);
    }
    V::without(nothing.eq(zero) & t_min.lt(t_max), is_zero)
}

/// One over a component of the direction as [`SlabRay::inverse_direction`] has it, for many rays.
#[inline(always)]
pub(super) fn inverse<V: Lanes>(direction: V) -> V {
    (V::splat(1.0) / (direction + V::splat(0.0)))
        .min(V::splat(f32::MAX))
        .max(V::splat(-f32::MAX))
}

/// A ray prepared for box tests.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub struct SlabRay {
    /// Origin and `t_min`. In memory, so that an axis can be chosen without a branch.
    pub(super) origin: [f32; 4],
    /// One over the direction, finite, and `t_max`.
    pub(super) inverse: [f32; 4],
    /// A bit for each axis on which the direction points down.
    pub(super) octant: u32,
    /// For each axis where in [`WideNode::planes`](super::node::WideNode) the planes begin that the ray
    /// meets first, in bytes. The others differ in the bit [`PLANES`].
    pub(super) near: [u32; 3],
}

impl SlabRay {
    /// Prepares `ray`; `None` when it cannot meet anything (a number that is not finite, no
    /// direction, nothing between `t_min` and `t_max`).
    pub fn new(ray: &Ray) -> Option<Self> {
        Self::can_meet(ray).then(|| Self::prepare(ray))
    }

    /// False when `ray` cannot meet anything; see [`Self::new`].
    #[inline(always)]
    pub(super) fn can_meet(ray: &Ray) -> bool {
        let direction = ray.direction.extend(0.0);
        // Zero, or NaN if anything is infinite or NaN.
        let nothing = ray.origin.extend(ray.t_min) * 0.0 + direction * 0.0;
        let is_finite = nothing.cmpeq(Vec4::ZERO).bitmask() == 0b1111;
        let is_zero = direction.cmpeq(Vec4::ZERO).bitmask() == 0b1111;
        // False for a t_max that is NaN.
        is_finite & !is_zero & (ray.t_min < ray.t_max)
    }

    /// Prepares a ray that [`Self::can_meet`] something.
    #[inline(always)]
    pub(super) fn prepare(ray: &Ray) -> Self {
        let direction = ray.direction.extend(0.0);
        // -0 becomes +0; the reciprocal stays finite, so that 0 · inf cannot arise.
        let inverse = (Vec4::ONE / (direction + Vec4::ZERO))
            .min(Vec4::splat(f32::MAX))
            .max(Vec4::splat(-f32::MAX));
        let t_max = if ray.t_max < T_FAR { ray.t_max } else { T_FAR };
        let octant = direction.cmplt(Vec4::ZERO).bitmask();
        Self {
            origin: ray.origin.extend(ray.t_min).to_array(),
            inverse: inverse.with_w(t_max).to_array(),
            octant,
            near: Self::near_planes(octant),
        }
    }

    /// Where the planes begin that a ray of this octant meets first.
    #[inline(always)]
    pub(super) fn near_planes(octant: u32) -> [u32; 3] {
        let sides = [octant & 1, 2 + (octant >> 1 & 1), 4 + (octant >> 2 & 1)];
        sides.map(|side| side * PLANES)
    }

    /// For an axis the side (0 minimum, 1 maximum) of a box that the ray meets first.
    #[inline(always)]
    pub(super) fn near_side(&self, axis: usize) -> usize {
        (self.octant >> axis & 1) as usize
    }

    /// The start of the valid interval.
    #[inline(always)]
    pub fn t_min(&self) -> f32 {
        self.origin[3]
    }

    /// The end of the valid interval, at most [`T_FAR`].
    #[inline(always)]
    pub fn t_max(&self) -> f32 {
        self.inverse[3]
    }

    /// The ray parameter at which the ray enters `bounds` (at least `t_min`), `None` if it misses.
    pub fn enter(&self, bounds: &Aabb) -> Option<f32> {
        let origin = Vec4::from_array(self.origin).truncate();
        let inverse = Vec4::from_array(self.inverse).truncate();
        let lo = (bounds.min - origin) * inverse;
        let hi = (bounds.max - origin) * inverse;
        let near = lo.min(hi).max_element().max(self.t_min());
        let far = lo.max(hi).min_element().min(self.t_max());
        (near <= far * FAR_MARGIN).then_some(near)
    }

    /// [`Self::enter`] for the [`padded`] forms of many boxes, a lane each with minimum and maximum
    /// per axis: the parameters, and a bit for each box that is met. The same numbers: of two planes
    /// of a box, the one that the direction meets first has the smaller parameter, in floating point
    /// too.
    #[inline(always)]
    pub fn enter_each_padded<V: Lanes>(&self, mut boxes: [[V; 2]; 3]) -> (V, u32) {
        padded_each(&mut boxes);
        let t = |axis: usize, side: usize| {
            (boxes[axis][side & 1] - V::splat(self.origin[axis])) * V::splat(self.inverse[axis])
        };
        let sides = |axis: usize| {
            let (low, high) = (t(axis, 0), t(axis, 1));
            (low.min(high), low.max(high))
        };
        let (x, y, z) = (sides(0), sides(1), sides(2));
        let near = x.0.max(y.0).max(z.0.max(V::splat(self.t_min())));
        let far = x.1.min(y.1).min(z.1.min(V::splat(self.t_max())));
        (near, V::bits(near.le(far * V::splat(FAR_MARGIN))))
    }

    /// The origin, then [`Self::t_min`].
    #[inline(always)]
    pub fn origin(&self) -> &[f32; 4] {
        &self.origin
    }

    /// One over the direction per axis, finite, then [`Self::t_max`].
    #[inline(always)]
    pub fn inverse_direction(&self) -> &[f32; 4] {
        &self.inverse
    }
}
