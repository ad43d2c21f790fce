use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Sub};

use super::{DoubleLanes, IntLanes};
use crate::math::Ray;

/// Numbers in half a row, of which [`Lanes::load`] and [`Lanes::store`] know.
pub const LANES: usize = 8;

/// Numbers that [`Lanes::repeat`] puts side by side, and [`Lanes::alternate`] takes together.
pub(super) const FOUR: usize = 4;

/// Room in memory for one [`Lanes`] of any width.
pub const ROW: usize = 16;

/// Eight or more numbers side by side, for code that is written once for all instruction sets.
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

    /// How many numbers, 8 or 16.
    const N: usize;

    /// The first eight from memory; others are zero.
    fn load(from: &[f32; LANES]) -> Self;

    /// The first eight to memory.
    fn store(self, to: &mut [f32; LANES]);

    /// The same four numbers again and again.
    fn repeat(from: &[f32; FOUR]) -> Self;

    /// The first four lanes from `even`, the next four from `odd`, and so on.
    fn alternate(even: Self, odd: Self) -> Self;

    /// From the start of a row.
    fn load_row(from: &[f32; ROW]) -> Self;

    /// To the start of a row.
    fn store_row(self, to: &mut [f32; ROW]);

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
    #[inline(always)]
    fn select_ints(mask: Self::Mask, yes: Self::Ints, no: Self::Ints) -> Self::Ints {
        Self::select(mask, Self::from_ints(yes), Self::from_ints(no)).to_ints()
    }

    /// Origins, directions, `t_min` and `t_max` of rays, as many as there are lanes.
    fn of_rays(rays: &[&Ray; ROW]) -> [Self; 8];

    /// The same of the first rays of `rays`, at least one; the last again where there are fewer than
    /// lanes.
    #[inline(always)]
    fn of_first_rays(rays: &[Ray]) -> [Self; 8] {
        let last = rays.len() - 1;
        let mut some = [&rays[0]; ROW];
        for (i, ray) in some.iter_mut().enumerate().take(Self::N).skip(1) {
            *ray = &rays[i.min(last)];
        }
        Self::of_rays(&some)
    }

    /// The rays with these numbers, to the start of a row.
    fn to_rays(numbers: [Self; 8], rays: &mut [Ray; ROW]);

    /// A mask with the lanes whose bits are set.
    fn mask_of_bits(bits: u32) -> Self::Mask;

    /// The bits of all lanes.
    const ALL: u32 = (1 << Self::N) - 1;

    /// The numbers as an array.
    #[inline(always)]
    fn to_array(self) -> [f32; ROW] {
        let mut array = [0.0; ROW];
        self.store_row(&mut array);
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
