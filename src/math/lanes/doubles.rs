use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Sub};

/// Eight or more numbers of double precision side by side, for the steps that single precision would spoil.
pub trait DoubleLanes:
    Copy + Debug + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// The numbers in single precision.
    type Singles;

    /// The same number in all lanes.
    fn splat(value: f64) -> Self;

    /// Exactly the same numbers.
    fn widen(from: Self::Singles) -> Self;

    /// Rounded to nearest.
    fn narrow(self) -> Self::Singles;

    /// The square root, correctly rounded.
    fn sqrt(self) -> Self;

    /// 1 where the number is finite and above 0, else 0.
    fn is_positive_and_finite(self) -> Self;

    /// The numbers where `flag` is 1, `other` where it is 0.
    fn or_where_zero(self, flag: Self, other: Self) -> Self;
}
