use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Sub};

/// Numbers in one [`Lanes`].
pub(in super::super) const LANES: usize = 8;

/// Eight numbers side by side, for code that is written once for all instruction sets.
///
/// Every operation is that of the IEEE standard, rounded to nearest, and never fused. Implementations
/// differ in speed only.
pub trait Lanes:
    Copy + Debug + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// A truth value for each lane.
    type Mask: Copy + Debug + BitAnd<Output = Self::Mask> + BitOr<Output = Self::Mask>;

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
        self.max(Self::splat(0.0) - self)
    }
}
