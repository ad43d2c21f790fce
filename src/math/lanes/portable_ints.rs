use std::ops::{Add, BitAnd, BitOr, BitXor, Mul};

use super::{IntLanes, LANES, ROW};

/// Eight integers as an array.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PortableInts(pub(super) [u32; LANES]);

macro_rules! operators {
    ($($trait:ident $name:ident $operation:path;)*) => {
        $(impl $trait for PortableInts {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(std::array::from_fn(|lane| $operation(self.0[lane], other.0[lane])))
            }
        })*
    };
}

operators! {
    Add add u32::wrapping_add;
    Mul mul u32::wrapping_mul;
    BitAnd bitand BitAnd::bitand;
    BitOr bitor BitOr::bitor;
    BitXor bitxor BitXor::bitxor;
}

impl IntLanes for PortableInts {
    #[inline(always)]
    fn splat(value: u32) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn load(from: &[u32; ROW]) -> Self {
        Self(std::array::from_fn(|lane| from[lane]))
    }

    #[inline(always)]
    fn store(self, to: &mut [u32; ROW]) {
        to[..LANES].copy_from_slice(&self.0);
    }

    #[inline(always)]
    fn shl<const BY: i32>(self) -> Self {
        Self(self.0.map(|value| value << BY))
    }

    #[inline(always)]
    fn shr<const BY: i32>(self) -> Self {
        Self(self.0.map(|value| value >> BY))
    }

    #[inline(always)]
    fn sar<const BY: i32>(self) -> Self {
        Self(
            self.0
                .map(|value| (value.cast_signed() >> BY).cast_unsigned()),
        )
    }

    #[inline(always)]
    fn reverse_bits(self) -> Self {
        Self(self.0.map(u32::reverse_bits))
    }
}
