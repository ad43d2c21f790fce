use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, BitXor, Mul};

use super::ROW;

/// Eight or more 32-bit integers side by side. Sums and products wrap around.
pub trait IntLanes:
    Copy
    + Debug
    + Add<Output = Self>
    + Mul<Output = Self>
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + BitXor<Output = Self>
{
    /// The same number in all lanes.
    fn splat(value: u32) -> Self;

    /// From the start of a row.
    fn load(from: &[u32; ROW]) -> Self;

    /// To the start of a row.
    fn store(self, to: &mut [u32; ROW]);

    /// Bits moved up by `BY`, zeros from below; `BY` is in 0..32.
    fn shl<const BY: i32>(self) -> Self;

    /// Bits moved down by `BY`, zeros from above; `BY` is in 0..32.
    fn shr<const BY: i32>(self) -> Self;

    /// Bits moved down by `BY`, the sign from above; `BY` is in 0..32.
    fn sar<const BY: i32>(self) -> Self;

    /// As [`u32::reverse_bits`].
    fn reverse_bits(self) -> Self;

    /// The numbers as an array.
    #[inline(always)]
    fn to_array(self) -> [u32; ROW] {
        let mut array = [0; ROW];
        self.store(&mut array);
        array
    }
}
