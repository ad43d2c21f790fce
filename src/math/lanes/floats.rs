use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Sub};

use super::{DoubleLanes, IntLanes};
use crate::math::Ray;

/// Numbers in one [`Lanes`].
pub const LANES: usize = 8;

/// Eight numbers side by side, for code that is written once for all instruction sets.
///
/// Every operation is that of the IEEE standard, rounded to nearest, and never fused. Implementations
/// differ in speed only.
pub trait Lanes:
    Copy + Debug + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// A truth value for each lane.
    type Mask: Copy + Debug + BitAnd<Output = Self::Mask> + BitOr<Output = Self::Mask>;

    /// Eight integers.
    type Ints: IntLanes;

    /// Eight numbers of double precision.
    type Doubles: DoubleLanes<Singles = Self>;

    /// The same number in all lanes.
    fn splat(value: f32) -> Self;

    /// From memory.
    fn load(from: &[f32; LANES]) -> Self;

    /// To memory.
    fn store(self, to: &mut [f32; LANES]);

    /// The smaller number. With NaN the same as [`glam::Vec4::min`].
    fn min(self, other: Self) -> Self;

    /// The larger number. With NaN the same as [`glam::Vec4::max`].
    fn max(self, other: Self) -> Self;

    /// Where `self` is less; false with NaN, as the others.
    fn lt(self, other: Self) -> Self::Mask;

    /// Where `self` is less or equal.
    fn le(self, other: Self) -> Self::Mask;

    /// Where both are equal; the zeros are.
    fn eq(self, other: Self) -> Self::Mask;

    /// `yes` where the mask is true, else `no`; bit for bit, so that any 32 bits may travel in a lane.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// Where `mask` is true and `other` is not.
    fn without(mask: Self::Mask, other: Self::Mask) -> Self::Mask;

    /// A bit for each lane.
    fn bits(mask: Self::Mask) -> u32;

    /// The square root, correctly rounded.
    fn sqrt(self) -> Self;

    /// The bits of the numbers.
    fn to_ints(self) -> Self::Ints;

    /// The numbers with these bits.
    fn from_ints(ints: Self::Ints) -> Self;

    /// The values of integers below 2³¹, rounded to nearest.
    fn of_ints(ints: Self::Ints) -> Self;

    /// Where two integers are equal.
    fn ints_eq(a: Self::Ints, b: Self::Ints) -> Self::Mask;

    /// `yes` where the mask is true, else `no`.
    fn select_ints(mask: Self::Mask, yes: Self::Ints, no: Self::Ints) -> Self::Ints;

    /// Origin, direction, `t_min` and `t_max` of a ray.
    fn load_ray(ray: &Ray) -> Self;

    /// The ray with these numbers, see [`Self::load_ray`].
    fn to_ray(self) -> Ray;

    /// Rows and columns exchanged.
    fn transpose(rows: [Self; LANES]) -> [Self; LANES];

    /// A mask with the lanes whose bits are set.
    #[inline(always)]
    fn mask_of_bits(bits: u32) -> Self::Mask {
        let lane = Self::Ints::load(&[1, 2, 4, 8, 16, 32, 64, 128]);
        Self::ints_eq(lane & Self::Ints::splat(bits), lane)
    }

    /// The numbers as an array.
    #[inline(always)]
    fn to_array(self) -> [f32; LANES] {
        let mut array = [0.0; LANES];
        self.store(&mut array);
        array
    }

    /// The same numbers with the other sign.
    #[inline(always)]
    fn neg(self) -> Self {
        Self::from_ints(self.to_ints() ^ Self::Ints::splat(1 << 31))
    }

    /// The sizes of these numbers with the signs of `sign`.
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        let mask = Self::Ints::splat(1 << 31);
        let size = self.to_ints() & Self::Ints::splat(!(1 << 31));
        Self::from_ints(size | (sign.to_ints() & mask))
    }

    /// Where `self` is greater.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }

    /// Where `self` is greater or equal.
    #[inline(always)]
    fn ge(self, other: Self) -> Self::Mask {
        other.le(self)
    }

    /// Without sign.
    #[inline(always)]
    fn abs(self) -> Self {
        Self::from_ints(self.to_ints() & Self::Ints::splat(!(1 << 31)))
    }
}
