use std::ops::{Add, Mul, Neg, Sub};

use glam::Vec3;

use super::{DoubleLanes, Lanes};

/// Eight vectors side by side. Every operation is that of [`Vec3`], in the same order.
#[derive(Clone, Copy, Debug)]
pub struct Vec3Lanes<L> {
    /// First components.
    pub x: L,
    /// Second components.
    pub y: L,
    /// Third components.
    pub z: L,
}

impl<L: Lanes> Vec3Lanes<L> {
    /// From the components.
    #[inline(always)]
    pub fn new(x: L, y: L, z: L) -> Self {
        Self { x, y, z }
    }

    /// The same vector in all lanes.
    #[inline(always)]
    pub fn splat(value: Vec3) -> Self {
        Self::new(L::splat(value.x), L::splat(value.y), L::splat(value.z))
    }

    /// Times a number.
    #[inline(always)]
    pub fn scale(self, by: L) -> Self {
        Self::new(self.x * by, self.y * by, self.z * by)
    }

    /// As [`Vec3::dot`].
    #[inline(always)]
    pub fn dot(self, other: Self) -> L {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// As [`Vec3::cross`].
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - other.y * self.z,
            self.z * other.x - other.z * self.x,
            self.x * other.y - other.x * self.y,
        )
    }

    /// As [`Vec3::length_squared`].
    #[inline(always)]
    pub fn length_squared(self) -> L {
        self.dot(self)
    }

    /// As [`Vec3::length`].
    #[inline(always)]
    pub fn length(self) -> L {
        self.length_squared().sqrt()
    }

    /// Sizes of the components.
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self::new(self.x.abs(), self.y.abs(), self.z.abs())
    }

    /// The largest component.
    #[inline(always)]
    pub fn max_element(self) -> L {
        self.x.max(self.y.max(self.z))
    }

    /// As [`Vec3::normalize_or`].
    #[inline(always)]
    pub fn normalize_or(self, fallback: Self) -> Self {
        let inverse = L::splat(1.0) / self.length();
        let works = inverse.lt(L::splat(f32::INFINITY)) & inverse.gt(L::splat(0.0));
        Self::select(works, self.scale(inverse), fallback)
    }

    /// `yes` where the mask is true, else `no`.
    #[inline(always)]
    pub fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self::new(
            L::select(mask, yes.x, no.x),
            L::select(mask, yes.y, no.y),
            L::select(mask, yes.z, no.z),
        )
    }

    /// The unit vector along `self` × `other`, computed in double precision and rounded once; +z
    /// where there is none. As `cross` and `normalize_or` of [`glam::DVec3`].
    #[inline(always)]
    pub fn unit_cross(self, other: Self) -> Self {
        let [ax, ay, az] = self.widen();
        let [bx, by, bz] = other.widen();
        let cross = [ay * bz - by * az, az * bx - bz * ax, ax * by - bx * ay];
        let [x, y, z] = Self::unit_or(cross, [0.0, 0.0, 1.0]);
        Self::new(x.narrow(), y.narrow(), z.narrow())
    }

    /// Unit vectors in the directions of these, or `fallback`; as [`glam::DVec3::normalize_or`].
    #[inline(always)]
    pub fn unit_or([x, y, z]: [L::Doubles; 3], fallback: [f64; 3]) -> [L::Doubles; 3] {
        let length = (x * x + y * y + z * z).sqrt();
        let inverse = L::Doubles::splat(1.0) / length;
        let works = inverse.is_positive_and_finite();
        [
            (x * inverse).or_where_zero(works, L::Doubles::splat(fallback[0])),
            (y * inverse).or_where_zero(works, L::Doubles::splat(fallback[1])),
            (z * inverse).or_where_zero(works, L::Doubles::splat(fallback[2])),
        ]
    }

    /// The components in double precision.
    #[inline(always)]
    pub fn widen(self) -> [L::Doubles; 3] {
        [
            L::Doubles::widen(self.x),
            L::Doubles::widen(self.y),
            L::Doubles::widen(self.z),
        ]
    }

    /// The larger of each pair of components.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        Self::new(
            self.x.max(other.x),
            self.y.max(other.y),
            self.z.max(other.z),
        )
    }

    /// Plus a number.
    #[inline(always)]
    pub fn offset(self, by: L) -> Self {
        Self::new(self.x + by, self.y + by, self.z + by)
    }
}

impl<L: Lanes> Add for Vec3Lanes<L> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<L: Lanes> Sub for Vec3Lanes<L> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<L: Lanes> Mul for Vec3Lanes<L> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::new(self.x * other.x, self.y * other.y, self.z * other.z)
    }
}

impl<L: Lanes> Neg for Vec3Lanes<L> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(self.x.neg(), self.y.neg(), self.z.neg())
    }
}
