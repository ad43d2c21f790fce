use std::ops::{Add, BitAnd, BitOr, Div, Mul, Sub};

use glam::{BVec4A, Vec3, Vec4};

use super::portable_doubles::PortableDoubles;
use super::portable_ints::PortableInts;
use super::{FOUR, LANES, Lanes, ROW};
use crate::math::Ray;

/// Eight lanes as two vectors of four.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PortableLanes(Vec4, Vec4);

/// A truth value for each of [`PortableLanes`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct PortableMask(BVec4A, BVec4A);

macro_rules! operators {
    ($type:ty: $($trait:ident $name:ident;)*) => {
        $(impl $trait for $type {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(self.0.$name(other.0), self.1.$name(other.1))
            }
        })*
    };
}

operators! { PortableLanes: Add add; Sub sub; Mul mul; Div div; }
operators! { PortableMask: BitAnd bitand; BitOr bitor; }

impl Lanes for PortableLanes {
    type Mask = PortableMask;
    type Ints = PortableInts;
    type Doubles = PortableDoubles;

    const N: usize = LANES;

    #[inline(always)]
    fn repeat(from: &[f32; FOUR]) -> Self {
        Self(Vec4::from_array(*from), Vec4::from_array(*from))
    }

    #[inline(always)]
    fn alternate(even: Self, odd: Self) -> Self {
        Self(even.0, odd.1)
    }

    #[inline(always)]
    fn load_row(from: &[f32; ROW]) -> Self {
        Self(Vec4::from_slice(&from[..4]), Vec4::from_slice(&from[4..8]))
    }

    #[inline(always)]
    fn store_row(self, to: &mut [f32; ROW]) {
        self.0.write_to_slice(&mut to[..4]);
        self.1.write_to_slice(&mut to[4..8]);
    }

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self(Vec4::splat(value), Vec4::splat(value))
    }

    #[inline(always)]
    fn load(from: &[f32; LANES]) -> Self {
        Self(Vec4::from_slice(&from[..4]), Vec4::from_slice(&from[4..]))
    }

    #[inline(always)]
    fn store(self, to: &mut [f32; LANES]) {
        self.0.write_to_slice(&mut to[..4]);
        self.1.write_to_slice(&mut to[4..]);
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0), self.1.min(other.1))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0), self.1.max(other.1))
    }

    #[inline(always)]
    fn lt(self, other: Self) -> PortableMask {
        PortableMask(self.0.cmplt(other.0), self.1.cmplt(other.1))
    }

    #[inline(always)]
    fn le(self, other: Self) -> PortableMask {
        PortableMask(self.0.cmple(other.0), self.1.cmple(other.1))
    }

    #[inline(always)]
    fn eq(self, other: Self) -> PortableMask {
        PortableMask(self.0.cmpeq(other.0), self.1.cmpeq(other.1))
    }

    #[inline(always)]
    fn select(mask: PortableMask, yes: Self, no: Self) -> Self {
        Self(
            Vec4::select(mask.0, yes.0, no.0),
            Vec4::select(mask.1, yes.1, no.1),
        )
    }

    #[inline(always)]
    fn without(mask: PortableMask, other: PortableMask) -> PortableMask {
        PortableMask(mask.0 & !other.0, mask.1 & !other.1)
    }

    #[inline(always)]
    fn bits(mask: PortableMask) -> u32 {
        mask.0.bitmask() | mask.1.bitmask() << 4
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::load(&self.to_eight().map(f32::sqrt))
    }

    #[inline(always)]
    fn to_ints(self) -> PortableInts {
        PortableInts(self.to_eight().map(f32::to_bits))
    }

    #[inline(always)]
    fn from_ints(ints: PortableInts) -> Self {
        Self::load(&ints.0.map(f32::from_bits))
    }

    #[inline(always)]
    fn of_ints(ints: PortableInts) -> Self {
        Self::load(&ints.0.map(|value| value.cast_signed() as f32))
    }

    #[inline(always)]
    fn ints_eq(a: PortableInts, b: PortableInts) -> PortableMask {
        let equal = |lane: usize| a.0[lane] == b.0[lane];
        PortableMask(
            BVec4A::from_array(std::array::from_fn(equal)),
            BVec4A::from_array(std::array::from_fn(|lane| equal(lane + 4))),
        )
    }

    #[inline(always)]
    fn mask_of_bits(bits: u32) -> PortableMask {
        let lane = |lane: usize| bits >> lane & 1 == 1;
        PortableMask(
            BVec4A::from_array(std::array::from_fn(lane)),
            BVec4A::from_array(std::array::from_fn(|i| lane(i + 4))),
        )
    }

    #[inline(always)]
    fn of_rays(rays: &[&Ray; ROW]) -> [Self; 8] {
        let rows: [[f32; 8]; LANES] = std::array::from_fn(|lane| {
            let (o, d) = (&rays[lane].origin, &rays[lane].direction);
            [
                o.x,
                o.y,
                o.z,
                d.x,
                d.y,
                d.z,
                rays[lane].t_min,
                rays[lane].t_max,
            ]
        });
        std::array::from_fn(|column| Self::load(&rows.map(|row| row[column])))
    }

    #[inline(always)]
    fn to_rays(numbers: [Self; 8], rays: &mut [Ray; ROW]) {
        let columns = numbers.map(Self::to_eight);
        for (lane, ray) in rays.iter_mut().enumerate().take(LANES) {
            let [ox, oy, oz, dx, dy, dz, t_min, t_max] = columns.map(|column| column[lane]);
            *ray = Ray {
                origin: Vec3::new(ox, oy, oz),
                direction: Vec3::new(dx, dy, dz),
                t_min,
                t_max,
            };
        }
    }
}

impl PortableLanes {
    #[inline(always)]
    pub(super) fn to_eight(self) -> [f32; LANES] {
        let mut eight = [0.0; LANES];
        self.store(&mut eight);
        eight
    }
}
