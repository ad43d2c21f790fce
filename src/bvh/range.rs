use glam::{Vec3, Vec3A};
use rayon::prelude::*;

use crate::math::Aabb;

/// A primitive on its way into the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct PrimitiveRef {
    /// Padded bounds.
    pub(super) bounds: Aabb,
    /// Index among the boxes given to the build.
    pub(super) id: u32,
}

impl PrimitiveRef {
    pub(super) fn center(&self) -> Vec3 {
        self.bounds.center()
    }
}

/// Ranges above this size are scanned in parallel, in chunks of this size.
///
/// Bounds and counts do not depend on the order of merging, so neither does the tree.
const PARALLEL_SCAN: usize = 32_768;

/// Bounds of the primitives and of their centres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extents {
    pub(super) bounds: Aabb,
    pub(super) centers: Aabb,
}

impl Extents {
    const EMPTY: Self = Self {
        bounds: Aabb::EMPTY,
        centers: Aabb::EMPTY,
    };

    pub(super) fn of(refs: &[PrimitiveRef]) -> Self {
        scan(refs, Self::EMPTY, Self::of_chunk, |a, b| Self {
            bounds: a.bounds.union(b.bounds),
            centers: a.centers.union(b.centers),
        })
    }

    fn of_chunk(refs: &[PrimitiveRef]) -> Self {
        let mut boxes = Bounds::EMPTY;
        let mut centers = Bounds::EMPTY;
        for r in refs {
            boxes.union(r.bounds.min.into(), r.bounds.max.into());
            let center = r.center().into();
            centers.union(center, center);
        }
        Self {
            bounds: boxes.into_aabb(),
            centers: centers.into_aabb(),
        }
    }
}

/// Reduces `refs` by `chunk` and `merge`, whose result must not depend on the order of merging.
pub(super) fn scan<T: Send + Copy + Sync>(
    refs: &[PrimitiveRef],
    identity: T,
    chunk: impl Fn(&[PrimitiveRef]) -> T + Sync + Send,
    merge: impl Fn(T, T) -> T + Sync + Send,
) -> T {
    if refs.len() <= PARALLEL_SCAN {
        return chunk(refs);
    }
    refs.par_chunks(PARALLEL_SCAN)
        .map(chunk)
        .reduce(|| identity, merge)
}

/// A box in vector registers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub(super) min: Vec3A,
    pub(super) max: Vec3A,
}

impl Bounds {
    pub(super) const EMPTY: Self = Self {
        min: Vec3A::INFINITY,
        max: Vec3A::NEG_INFINITY,
    };

    pub(super) fn union(&mut self, min: Vec3A, max: Vec3A) {
        self.min = self.min.min(min);
        self.max = self.max.max(max);
    }

    pub(super) fn half_area(&self) -> f32 {
        let e = self.max - self.min;
        e.x * e.y + e.y * e.z + e.z * e.x
    }

    fn into_aabb(self) -> Aabb {
        Aabb {
            min: self.min.into(),
            max: self.max.into(),
        }
    }
}

/// Moves the half with the smaller centres on the longest axis to the front; returns its length.
///
/// The id decides between equal centres, so that any range of two or more can be halved.
pub(super) fn split_at_median(refs: &mut [PrimitiveRef], centers: &Aabb) -> usize {
    let extent = centers.extent();
    let axis = extent.max_position();
    let mid = refs.len() / 2;
    refs.select_nth_unstable_by(mid, |a, b| {
        (a.center()[axis].total_cmp(&b.center()[axis])).then(a.id.cmp(&b.id))
    });
    mid
}
