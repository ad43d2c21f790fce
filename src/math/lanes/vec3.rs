use std::ops::{Add, Mul, Sub};

use glam::Vec3;

use super::{DoubleLanes, LANES, Lanes};

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

    /// The vectors that `at` gives for each lane.
    #[inline(always)]
    pub fn gather(at: impl Fn(usize) -> Vec3) -> Self {
        let mut rows = [[0.0; LANES]; 3];
        for lane in 0..LANES {
            let value = at(lane);
            rows[0][lane] = value.x;
            rows[1][lane] = value.y;
            rows[2][lane] = value.z;
        }
        Self::new(L::load(&rows[0]), L::load(&rows[1]), L::load(&rows[2]))
    }

    /// The vectors as arrays.
    #[inline(always)]
    pub fn to_arrays(self) -> [[f32; LANES]; 3] {
        [self.x.to_array(), self.y.to_array(), self.z.to_array()]
    }

    /// What `of` does to each component.
    #[inline(always)]
    pub fn map(self, of: impl Fn(L) -> L) -> Self {
        Self::new(of(self.x), of(self.y), of(self.z))
    }

    /// What `of` makes of each pair of components.
    #[inline(always)]
    pub fn zip(self, other: Self, of: impl Fn(L, L) -> L) -> Self {
        Self::new(
            of(self.x, other.x),
            of(self.y, other.y),
            of(self.z, other.z),
        )
    }

    /// Times a number.
    #[inline(always)]
    pub fn scale(self, by: L) -> Self {
        self.map(|component| component * by)
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
        self.map(L::abs)
    }

    /// The other way.
    #[inline(always)]
    pub fn neg(self) -> Self {
        self.map(L::neg)
    }

    /// The largest component.
    #[inline(always)]
    pub fn max_element(self) -> L {
        self.x.max(self.y.max(self.z))
    }

    /// The smallest component.
    #[inline(always)]
    pub fn min_element(self) -> L {
        self.x.min(self.y.min(self.z))
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
        yes.zip(no, |yes, no| L::select(mask, yes, no))
    }

    /// The unit vector along `self` × `other`, computed in double precision and rounded once; +z
    /// where there is none. As `cross` and `normalize_or` of [`glam::DVec3`].
    #[inline(always)]
    pub fn unit_cross(self, other: Self) -> Self {
        let [ax, ay, az] = [self.x, self.y, self.z].map(L::Doubles::widen);
        let [bx, by, bz] = [other.x, other.y, other.z].map(L::Doubles::widen);
        let cross = [ay * bz - by * az, az * bx - bz * ax, ax * by - bx * ay];
        Self::unit(cross, [0.0, 0.0, 1.0])
    }

    /// `vector` made a unit vector, and rounded; `fallback` where it has no direction.
    #[inline(always)]
    pub fn unit([x, y, z]: [L::Doubles; 3], fallback: [f64; 3]) -> Self {
        let length = (x * x + y * y + z * z).sqrt();
        let inverse = L::Doubles::splat(1.0) / length;
        let works = inverse.is_positive_and_finite();
        let [fx, fy, fz] = fallback.map(L::Doubles::splat);
        Self::new(
            (x * inverse).or_where_zero(works, fx).narrow(),
            (y * inverse).or_where_zero(works, fy).narrow(),
            (z * inverse).or_where_zero(works, fz).narrow(),
        )
    }
}

impl<L: Lanes> Add for Vec3Lanes<L> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl<L: Lanes> Sub for Vec3Lanes<L> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl<L: Lanes> Mul for Vec3Lanes<L> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}
