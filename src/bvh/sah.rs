use glam::Vec3;

use super::range::{Bounds, PrimitiveRef, scan};
use crate::math::Aabb;

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
    bins: usize,
    origin: Vec3,
    scale: Vec3,
}

impl Grid {
    fn new(centers: &Aabb, primitives: usize) -> Self {
        // A few primitives need no more planes than this.
        let bins = if primitives > BINS { BINS } else { BINS / 2 };
        Self {
            bins,
            origin: centers.min,
            scale: bins as f32 / centers.extent(),
        }
    }

    fn bin(&self, center: Vec3, axis: usize) -> usize {
        // The cast takes NaN (no extent) to 0 and saturates.
        let x = (center[axis] - self.origin[axis]) * self.scale[axis];
        (x as usize).min(self.bins - 1)
    }
}

impl BinnedSplit {
    /// The cheapest plane by the surface-area heuristic, `None` if no plane separates the centres
    /// or the areas overflow.
    ///
    /// Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies".
    pub(super) fn find(refs: &[PrimitiveRef], centers: &Aabb) -> Option<Self> {
        let grid = Grid::new(centers, refs.len());
        let bins = scan(refs, EMPTY_BINS, |c| fill(c, &grid), merge);
        (0..3)
            .filter_map(|axis| {
                let (bin, cost) = cheapest(&bins[axis][..grid.bins])?;
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

fn cheapest(bins: &[Bin]) -> Option<(usize, f32)> {
    // Cost of everything right of plane i, for i = 0 .. bins - 1; infinite if there is nothing.
    let mut right = [f32::INFINITY; BINS - 1];
    let mut bounds = Bounds::EMPTY;
    let mut count = 0;
    for i in (1..bins.len()).rev() {
        bounds.union(bins[i].bounds.min, bins[i].bounds.max);
        count += bins[i].count;
        if count > 0 {
            right[i - 1] = bounds.half_area() * count as f32;
        }
    }
    let mut best = None;
    let mut best_cost = f32::MAX;
    let (mut bounds, mut count) = (Bounds::EMPTY, 0);
    for (i, right) in right.into_iter().take(bins.len() - 1).enumerate() {
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
