use std::ops::{Add, Div, Mul, Sub};

use super::{DoubleLanes, LANES, Lanes, PortableLanes};

/// Eight numbers of double precision as an array.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PortableDoubles([f64; LANES]);

macro_rules! operators {
    ($($trait:ident $name:ident;)*) => {
        $(impl $trait for PortableDoubles {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(std::array::from_fn(|lane| self.0[lane].$name(other.0[lane])))
            }
        })*
    };
}

operators! { Add add; Sub sub; Mul mul; Div div; }

impl DoubleLanes for PortableDoubles {
    type Singles = PortableLanes;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn widen(from: PortableLanes) -> Self {
        let from = from.to_eight();
        Self(from.map(f64::from))
    }

    #[inline(always)]
    fn narrow(self) -> PortableLanes {
        PortableLanes::load(&self.0.map(|value| value as f32))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }

    #[inline(always)]
    fn is_positive_and_finite(self) -> Self {
        let flag = |value: f64| f64::from(u8::from(value > 0.0 && value < f64::INFINITY));
        Self(self.0.map(flag))
    }

    #[inline(always)]
    fn or_where_zero(self, flag: Self, other: Self) -> Self {
        let pick = |lane: usize| {
            if flag.0[lane] == 0.0 {
                other.0[lane]
            } else {
                self.0[lane]
            }
        };
        Self(std::array::from_fn(pick))
    }
}
