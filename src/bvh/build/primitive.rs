use glam::{Vec3, Vec4, Vec4Swizzles};

use crate::math::{Aabb, LANES};

/// A box in vector registers; the fourth lane means nothing.
#[derive(Clone, Copy, Debug)]
pub(in crate::bvh) struct Bounds {
    pub(super) min: Vec4,
    pub(super) max: Vec4,
}

impl Bounds {
    pub(super) const EMPTY: Self = Self {
        min: Vec4::INFINITY,
        max: Vec4::NEG_INFINITY,
    };

    #[inline(always)]
    pub(super) fn of_lanes(lanes: &BoxLanes) -> Self {
        Self {
            min: -Vec4::from_slice(&lanes[..4]),
            max: Vec4::from_slice(&lanes[4..]),
        }
    }

    #[inline(always)]
    pub(super) fn grow(&mut self, min: Vec4, max: Vec4) {
        self.min = self.min.min(min);
        self.max = self.max.max(max);
    }

    #[inline(always)]
    pub(super) fn union(mut self, other: &Self) -> Self {
        self.grow(other.min, other.max);
        self
    }

    /// Half the surface area; of an empty box not a number that means anything.
    #[inline(always)]
    pub(super) fn half_area(&self) -> f32 {
        let e = self.max - self.min;
        let products = e * e.yzxw();
        products.x + products.y + products.z
    }

    /// True for what lies in one plane across an axis.
    pub(super) fn is_flat(&self) -> bool {
        self.min.truncate().cmpeq(self.max.truncate()).any()
    }

    pub(super) fn aabb(&self) -> Aabb {
        Aabb {
            min: self.min.truncate(),
            max: self.max.truncate(),
        }
    }
}

/// Bit of an id that is flipped where it is held as a float, so that it is not a denormal number,
/// which processors are slow with.
pub(super) const NORMAL: u32 = 1 << 30;

/// A box in eight lanes: the minimum with the other sign, one lane, the maximum, one lane. So the
/// larger of two, lane by lane, holds both.
pub(super) type BoxLanes = [f32; LANES];

/// [`BoxLanes`] of nothing.
pub(super) const NO_BOX: BoxLanes = [f32::NEG_INFINITY; LANES];

/// A primitive on its way into the tree: its bounds, and its id in the lane behind the minimum; or
/// several with ids in a row, one less than their number in the lane behind the maximum.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct PrimitiveRef {
    pub(super) lanes: BoxLanes,
}

impl PrimitiveRef {
    pub(super) const NOTHING: Self = Self { lanes: NO_BOX };

    /// Primitive `id` with the box `bounds`; [`Self::NOTHING`] if that is empty or not finite.
    pub(super) fn new(id: u32, bounds: &Aabb) -> Self {
        if bounds.is_empty() || !bounds.min.is_finite() || !bounds.max.is_finite() {
            return Self::NOTHING;
        }
        Self::of(bounds.min, bounds.max, id, 0.0)
    }

    #[inline(always)]
    fn of(min: Vec3, max: Vec3, id: u32, more: f32) -> Self {
        let id = f32::from_bits(id ^ NORMAL);
        let lanes = [-min.x, -min.y, -min.z, id, max.x, max.y, max.z, more];
        Self { lanes }
    }

    /// `count` things in a row, the first of number `first`, that stay together; their bounds.
    pub(super) fn run(first: u32, count: usize, bounds: &Bounds) -> Self {
        let Bounds { min, max } = bounds;
        Self::of(min.truncate(), max.truncate(), first, count as f32 - 1.0)
    }

    /// Both as one, if the area of their box is at most `close` times the sum of their own, and the
    /// ids of `next` go on where those of this end.
    pub(super) fn joined(&self, next: &Self, close: f32) -> Option<Self> {
        let (a, b) = (self.bounds(), next.bounds());
        let both = a.union(&b);
        let is_close = both.half_area() <= close * (a.half_area() + b.half_area());
        let ids = self.ids();
        (is_close && ids.end == next.id())
            .then(|| Self::run(ids.start, ids.len() + next.count(), &both))
    }

    #[inline(always)]
    pub(super) fn bounds(&self) -> Bounds {
        Bounds::of_lanes(&self.lanes)
    }

    pub(super) fn is_nothing(&self) -> bool {
        self.lanes[0] == f32::NEG_INFINITY
    }

    /// Index among the boxes given to the build.
    pub(super) fn id(&self) -> u32 {
        self.lanes[3].to_bits() ^ NORMAL
    }

    /// The id and those behind it that belong to the same run.
    pub(super) fn ids(&self) -> std::ops::Range<u32> {
        self.id()..self.id() + self.count() as u32
    }

    /// Number of primitives.
    pub(super) fn count(&self) -> usize {
        self.lanes[7] as usize + 1
    }

    /// The middle; halved before the sum, which then cannot overflow.
    #[inline(always)]
    pub(super) fn center(&self) -> Vec4 {
        let Bounds { min, max } = self.bounds();
        min * 0.5 + max * 0.5
    }
}

/// Bounds of some primitives and of their centres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extents {
    pub(super) bounds: Bounds,
    pub(super) centers: Bounds,
}

impl Extents {
    pub(super) const EMPTY: Self = Self {
        bounds: Bounds::EMPTY,
        centers: Bounds::EMPTY,
    };

    pub(super) fn of(refs: &[PrimitiveRef]) -> Self {
        let mut all = Self::EMPTY;
        for r in refs {
            all.bounds = all.bounds.union(&r.bounds());
            let center = r.center();
            all.centers.grow(center, center);
        }
        all
    }

    pub(super) fn union(self, other: Self) -> Self {
        Self {
            bounds: self.bounds.union(&other.bounds),
            centers: self.centers.union(&other.centers),
        }
    }

    /// The axis on which the centres lie farthest apart.
    pub(super) fn longest_axis(&self) -> usize {
        let extent: Vec3 = (self.centers.max - self.centers.min).truncate();
        extent.max_position()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reference_gives_its_box_and_id_back() {
        assert_eq!(size_of::<PrimitiveRef>(), 32);
        let bounds = Aabb::from_points([Vec3::new(-1.0, 2.0, 3.0), Vec3::new(5.0, 2.5, 9.0)]);
        for id in [0, 1, (1 << 30) - 1, 1 << 30, (1 << 31) - 1] {
            let r = PrimitiveRef::new(id, &bounds);
            assert_eq!((r.id(), r.is_nothing()), (id, false));
            assert_eq!(Extents::of(&[r]).bounds.aabb(), bounds);
            assert_eq!(r.center().truncate(), Vec3::new(2.0, 2.25, 6.0));
        }
        let area = Extents::of(&[PrimitiveRef::new(7, &bounds)]).bounds;
        assert_eq!(area.half_area(), bounds.half_area());
    }

    #[test]
    fn a_run_gives_its_members_back() {
        let bounds = Extents::of(&[]).bounds;
        for (first, count) in [(0, 1), (7, 4), ((1 << 31) - 9, 8)] {
            let run = PrimitiveRef::run(first, count, &bounds);
            assert_eq!(run.ids(), first..first + count as u32);
            assert_eq!(run.count(), count);
        }
        let single = PrimitiveRef::new(5, &Aabb::from_points([Vec3::ZERO]));
        assert_eq!((single.ids(), single.count()), (5..6, 1));
    }

    #[test]
    fn boxes_without_a_place_are_nothing() {
        let far = Vec3::new(0.0, f32::INFINITY, 0.0);
        for bounds in [Aabb::EMPTY, Aabb::from_points([Vec3::ZERO, far])] {
            assert!(PrimitiveRef::new(3, &bounds).is_nothing());
        }
        let nan = Aabb {
            min: Vec3::NAN,
            max: Vec3::ONE,
        };
        assert!(PrimitiveRef::new(3, &nan).is_nothing());
    }
}
