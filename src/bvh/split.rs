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
    fn center(&self) -> Vec3 {
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

fn scan<T: Send + Copy + Sync>(
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
struct Bounds {
    min: Vec3A,
    max: Vec3A,
}

impl Bounds {
    const EMPTY: Self = Self {
        min: Vec3A::INFINITY,
        max: Vec3A::NEG_INFINITY,
    };

    fn union(&mut self, min: Vec3A, max: Vec3A) {
        self.min = self.min.min(min);
        self.max = self.max.max(max);
    }

    fn half_area(&self) -> f32 {
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

const BINS: usize = 16;

#[derive(Clone, Copy, Debug)]
struct Bin {
    bounds: Bounds,
    count: u32,
}

type Bins = [[Bin; BINS]; 3];

const EMPTY_BINS: Bins = [[Bin {
    bounds: Bounds::EMPTY,
    count: 0,
}; BINS]; 3];

/// A plane between two bins.
#[derive(Clone, Copy, Debug)]
pub(super) struct BinnedSplit {
    grid: Grid,
    axis: usize,
    /// Last bin on the left.
    bin: usize,
    /// Sum over both sides of half area times number of primitives.
    pub(super) cost: f32,
}

/// Maps centres to bins.
#[derive(Clone, Copy, Debug)]
struct Grid {
    origin: Vec3,
    scale: Vec3,
}

impl Grid {
    fn new(centers: &Aabb) -> Self {
        Self {
            origin: centers.min,
            scale: BINS as f32 / centers.extent(),
        }
    }

    fn bin(&self, center: Vec3, axis: usize) -> usize {
        // The cast takes NaN (no extent) to 0 and saturates.
        let x = (center[axis] - self.origin[axis]) * self.scale[axis];
        (x as usize).min(BINS - 1)
    }
}

impl BinnedSplit {
    /// The cheapest plane by the surface-area heuristic, `None` if no plane separates the centres
    /// or the areas overflow.
    ///
    /// Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies".
    pub(super) fn find(refs: &[PrimitiveRef], centers: &Aabb) -> Option<Self> {
        let grid = Grid::new(centers);
        let bins = scan(refs, EMPTY_BINS, |c| fill(c, &grid), merge);
        (0..3)
            .filter_map(|axis| {
                let (bin, cost) = cheapest(&bins[axis])?;
                Some(Self {
                    grid,
                    axis,
                    bin,
                    cost,
                })
            })
            .min_by(|a, b| a.cost.total_cmp(&b.cost))
    }

    /// Moves the left side to the front; returns its length.
    pub(super) fn partition(&self, refs: &mut [PrimitiveRef]) -> usize {
        let left = |r: &PrimitiveRef| self.grid.bin(r.center(), self.axis) <= self.bin;
        let (mut begin, mut end) = (0, refs.len());
        loop {
            while begin < end && left(&refs[begin]) {
                begin += 1;
            }
            while begin < end && !left(&refs[end - 1]) {
                end -= 1;
            }
            if begin >= end {
                return begin;
            }
            refs.swap(begin, end - 1);
        }
    }
}

fn fill(refs: &[PrimitiveRef], grid: &Grid) -> Bins {
    let mut bins = EMPTY_BINS;
    for r in refs {
        let center = r.center();
        let (min, max) = (r.bounds.min.into(), r.bounds.max.into());
        for (axis, bins) in bins.iter_mut().enumerate() {
            let bin = &mut bins[grid.bin(center, axis)];
            bin.bounds.union(min, max);
            bin.count += 1;
        }
    }
    bins
}

fn merge(mut a: Bins, b: Bins) -> Bins {
    for (a, b) in a.iter_mut().flatten().zip(b.iter().flatten()) {
        a.bounds.union(b.bounds.min, b.bounds.max);
        a.count += b.count;
    }
    a
}

fn cheapest(bins: &[Bin; BINS]) -> Option<(usize, f32)> {
    // Cost of everything right of plane i, for i = 0 .. BINS - 1; infinite if there is nothing.
    let mut right = [f32::INFINITY; BINS - 1];
    let mut bounds = Bounds::EMPTY;
    let mut count = 0;
    for i in (1..BINS).rev() {
        bounds.union(bins[i].bounds.min, bins[i].bounds.max);
        count += bins[i].count;
        if count > 0 {
            right[i - 1] = bounds.half_area() * count as f32;
        }
    }
    let mut best = None;
    let mut best_cost = f32::MAX;
    let (mut bounds, mut count) = (Bounds::EMPTY, 0);
    for (i, right) in right.into_iter().enumerate() {
        bounds.union(bins[i].bounds.min, bins[i].bounds.max);
        count += bins[i].count;
        if count == 0 {
            continue;
        }
        let cost = bounds.half_area() * count as f32 + right;
        if cost < best_cost {
            best_cost = cost;
            best = Some((i, cost));
        }
    }
    best
}
