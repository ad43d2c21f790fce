use super::super::node::{WIDTH, WideNode};
use super::super::slab::FAR_MARGIN;
use super::rays::{PacketRays, PerRay, groups};
use crate::math::Lanes;

/// What bounds all rays of a packet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interval {
    /// Per axis the coordinate of an origin that is nearest to the near planes of boxes, and to the
    /// far planes.
    origin: [[f32; 2]; 3],
    /// Per axis least and largest inverse direction.
    inverse: [[f32; 2]; 3],
    /// The least.
    t_min: f32,
}

/// How far the near and the far planes of all children of a node are from the origins, per axis.
pub(super) type Planes = [[[f32; WIDTH]; 2]; 3];

impl Interval {
    /// Of `rays`, which start at one point if `shared`.
    #[inline(always)]
    pub(super) fn new<V: Lanes>(rays: &PacketRays, shared: bool) -> Self {
        let mut out = Self {
            origin: [[0.0; 2]; 3],
            inverse: [[0.0; 2]; 3],
            t_min: least::<V>(&rays.t_min),
        };
        for axis in 0..3 {
            let first = rays.first_origin(axis);
            let (low, high) = if shared {
                (first, first)
            } else {
                ends::<V>(&rays.origin[axis])
            };
            out.origin[axis] = if rays.octant >> axis & 1 == 0 {
                [high, low]
            } else {
                [low, high]
            };
            let (least, most) = ends::<V>(&rays.inverse[axis]);
            out.inverse[axis] = [least, most];
        }
        out
    }

    /// The children of `node` that some ray of the packet may meet before `limit`: a bit for each
    /// slot. All operations of [`super::super::SlabRay::enter`] are monotonic in the origin and, for a
    /// given distance of the plane, in the inverse direction; so its near end is nowhere below, and
    /// its far end nowhere above, what this computes with the ends of the intervals.
    ///
    /// Writes the planes, seen from the origin if `SHARED`.
    #[inline(always)]
    pub(super) fn enter<V: Lanes, const SHARED: bool>(
        &self,
        node: &WideNode,
        octant: u32,
        limit: f32,
        planes: &mut Planes,
    ) -> (V, u32) {
        let mut near = V::splat(self.t_min);
        let mut far = V::splat(limit);
        for (axis, planes) in planes.iter_mut().enumerate() {
            let side = (octant >> axis & 1) as usize;
            let least = V::splat(self.inverse[axis][0]);
            let most = V::splat(self.inverse[axis][1]);
            let first = V::load(&node.planes[axis][side]);
            let second = V::load(&node.planes[axis][side ^ 1]);
            let a = first - V::splat(self.origin[axis][0]);
            let b = second - V::splat(self.origin[axis][1]);
            near = near.max((a * least).min(a * most));
            far = far.min((b * least).max(b * most));
            if SHARED {
                a.store(&mut planes[0]);
                b.store(&mut planes[1]);
            } else {
                first.store(&mut planes[0]);
                second.store(&mut planes[1]);
            }
        }
        (near, V::bits(near.le(far * V::splat(FAR_MARGIN))))
    }
}

/// The least and the largest number.
#[inline(always)]
fn ends<V: Lanes>(values: &PerRay) -> (f32, f32) {
    (least::<V>(values), largest::<V>(values))
}

/// The least number.
#[inline(always)]
fn least<V: Lanes>(values: &PerRay) -> f32 {
    let mut lanes = values.group::<V>(0);
    for group in 1..groups::<V>() {
        lanes = lanes.min(values.group(group));
    }
    fold(lanes, |a, b| if b < a { b } else { a })
}

/// The largest number.
#[inline(always)]
pub(super) fn largest<V: Lanes>(values: &PerRay) -> f32 {
    let mut lanes = values.group::<V>(0);
    for group in 1..groups::<V>() {
        lanes = lanes.max(values.group(group));
    }
    fold(lanes, |a, b| if b > a { b } else { a })
}

#[inline(always)]
fn fold<V: Lanes>(values: V, better: impl Fn(f32, f32) -> f32) -> f32 {
    let mut all = values.to_array();
    let mut half = V::N / 2;
    while half > 0 {
        for i in 0..half {
            all[i] = better(all[i], all[i + half]);
        }
        half /= 2;
    }
    all[0]
}
