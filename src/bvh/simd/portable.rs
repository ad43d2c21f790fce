use glam::Vec4;

use super::super::node::{WIDTH, WideNode};
use super::super::slab::{FAR_MARGIN, SlabRay};
use super::NodeTest;
use crate::math::PortableLanes;

/// Two vectors of four, which every processor has.
#[derive(Debug)]
pub(in super::super) struct Portable;

impl NodeTest for Portable {
    type PerSlot = [f32; WIDTH];

    type Eight = PortableLanes;

    type Rays = PortableLanes;

    #[inline(always)]
    fn enter(node: &WideNode, ray: &SlabRay, limit: f32) -> (Self::PerSlot, u32) {
        let mut out = [0.0; WIDTH];
        let mut meets = 0;
        for half in [0, 4] {
            let t = |axis: usize, side: usize| {
                let planes = &node.planes[axis][side & 1];
                let planes = Vec4::from_slice(&planes[half..half + 4]);
                (planes - Vec4::splat(ray.origin[axis])) * Vec4::splat(ray.inverse[axis])
            };
            let [x, y, z] = [ray.near_side(0), ray.near_side(1), ray.near_side(2)];
            let near = t(0, x)
                .max(t(1, y))
                .max(t(2, z).max(Vec4::splat(ray.t_min())));
            let far = t(0, x ^ 1)
                .min(t(1, y ^ 1))
                .min(t(2, z ^ 1).min(Vec4::splat(limit)));
            meets |= near.cmple(far * FAR_MARGIN).bitmask() << half;
            out[half..half + 4].copy_from_slice(&near.to_array());
        }
        (out, meets)
    }

    #[inline(always)]
    fn at_most(values: &[f32; WIDTH], limit: f32) -> (Self::PerSlot, u32) {
        let half = |values: &[f32]| Vec4::from_slice(values).cmple(Vec4::splat(limit));
        let (low, high) = (half(&values[..4]), half(&values[4..]));
        (*values, low.bitmask() | high.bitmask() << 4)
    }

    #[inline(always)]
    fn arrange_near(order: u64, values: [f32; WIDTH], to: &mut [f32; WIDTH]) {
        for (to, slot) in to.iter_mut().zip(order.to_le_bytes()) {
            *to = values[slot as usize % WIDTH];
        }
    }

    #[inline(always)]
    fn arrange(order: u64, values: &[u32; WIDTH], to: &mut [u32; WIDTH]) {
        for (to, slot) in to.iter_mut().zip(order.to_le_bytes()) {
            *to = values[slot as usize % WIDTH];
        }
    }
}
