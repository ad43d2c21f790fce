use super::{IntLanes, Lanes, Vec3Lanes};

/// Eight of [`crate::math::Frame`], the same bits.
#[derive(Clone, Copy, Debug)]
pub struct FrameLanes<L> {
    /// First tangents.
    pub x: Vec3Lanes<L>,
    /// Second tangents.
    pub y: Vec3Lanes<L>,
    /// Normals.
    pub z: Vec3Lanes<L>,
}

impl<L: Lanes> FrameLanes<L> {
    /// The frames around unit vectors.
    #[inline(always)]
    pub fn from_normal(z: Vec3Lanes<L>) -> Self {
        let sign = L::splat(1.0).copysign(z.z);
        let a = L::splat(-1.0) / (sign + z.z);
        let b = z.x * z.y * a;
        Self {
            x: Vec3Lanes::new(
                L::splat(1.0) + sign * z.x * z.x * a,
                sign * b,
                sign.neg() * z.x,
            ),
            y: Vec3Lanes::new(b, sign + z.y * z.y * a, z.y.neg()),
            z,
        }
    }

    /// Directions of these frames expressed in the world.
    #[inline(always)]
    pub fn to_world(&self, local: Vec3Lanes<L>) -> Vec3Lanes<L> {
        self.x.scale(local.x) + self.y.scale(local.y) + self.z.scale(local.z)
    }
}

/// Eight times [`crate::math::offset_origin`], the same bits.
#[inline(always)]
pub fn offset_origin_lanes<L: Lanes>(
    point: Vec3Lanes<L>,
    error: Vec3Lanes<L>,
    normal: Vec3Lanes<L>,
    direction: Vec3Lanes<L>,
) -> Vec3Lanes<L> {
    let distance = normal.abs().dot(error);
    let is_behind = direction.dot(normal).lt(L::splat(0.0));
    let side = L::select(is_behind, L::splat(-1.0), L::splat(1.0));
    let offset = normal.scale(distance * side);
    let moved = point + offset;
    Vec3Lanes::new(
        outward(moved.x, offset.x),
        outward(moved.y, offset.y),
        outward(moved.z, offset.z),
    )
}

/// The neighbours of `values` in the directions of `offsets`.
#[inline(always)]
fn outward<L: Lanes>(values: L, offsets: L) -> L {
    let zero = L::splat(0.0);
    let (up, one) = (offsets.gt(zero), L::Ints::splat(1));
    let minus_one = L::Ints::splat(u32::MAX);
    let none = L::Ints::splat(0);
    let step = L::select_ints(up, one, L::select_ints(offsets.lt(zero), minus_one, none));
    let bits = values.to_ints();
    let sign = one | bits.sar::<31>();
    let moved = L::from_ints(bits + step * sign);
    let from_zero = L::splat(f32::from_bits(1)).copysign(offsets);
    let moved = L::select(values.eq(zero), from_zero, moved);
    L::select(L::ints_eq(step, none), values, moved)
}
