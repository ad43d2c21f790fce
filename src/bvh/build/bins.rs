use glam::Vec4;
use rayon::prelude::*;

use super::primitive::{Bounds, BoxLanes, Extents, NO_BOX, PrimitiveRef};
use crate::bvh::simd::{Kernel, NodeTest, dispatch};
use crate::math::{Isa, Lanes};

/// Ranges longer than two chunks are binned and parted in parallel, in chunks of this size; what
/// comes out does not depend on the number of threads.
pub(super) const CHUNK: usize = 16_384;

/// Maps centres to cells of equal size, on all axes at once, and, as a fourth axis, areas of boxes
/// to cells of equal binary exponent, the largest first.
///
/// The fourth axis parts few large primitives, such as walls, from the many small ones among them,
/// whose every box they would blow up.
#[derive(Clone, Copy, Debug)]
struct Grid {
    origin: Vec4,
    scale: Vec4,
    last: f32,
    /// Exponent of the first cell of the fourth axis.
    largest: i32,
}

/// Axes of space.
const SPACE: usize = 3;
/// Axes of space and size.
const SPACE_AND_SIZE: usize = 4;

fn exponent(area: f32) -> i32 {
    (area.to_bits() >> 23) as i32
}

/// Added to a number between one half and 2²², leaves it rounded in the lowest bits.
const TO_BITS: f32 = 8_388_607.5;

/// A cell's number as [`Grid::cells`] holds it.
fn cell(number: usize) -> f32 {
    TO_BITS + 0.5 + number as f32
}

impl Grid {
    fn new(centers: &Bounds, cells: usize, largest: f32) -> Self {
        let mut origin = centers.min;
        let mut scale = Vec4::splat(cells as f32) / (centers.max - centers.min);
        for axis in 0..4 {
            // Too small or too large an extent to divide: all in the first cell.
            if axis == 3 || !scale[axis].is_finite() || scale[axis] == 0.0 {
                (origin[axis], scale[axis]) = (0.0, 0.0);
            }
        }
        Self {
            origin,
            scale,
            last: cells as f32 - 0.5,
            largest: exponent(largest),
        }
    }

    /// The half area that no box in the cells of the fourth axis from `first` on exceeds.
    fn largest_from(&self, first: usize, counts: &[u32]) -> f32 {
        let cell = (first..counts.len()).find(|&i| counts[i] > 0);
        let above = self.largest - cell.unwrap_or(counts.len()) as i32 + 1;
        f32::from_bits((above.clamp(0, 255) as u32) << 23)
    }

    /// The cells of a primitive with that centre as floats whose lowest bits are the number.
    #[inline(always)]
    fn cells<const AXES: usize>(&self, primitive: &PrimitiveRef, center: Vec4) -> Vec4 {
        let mut at = (center - self.origin) * self.scale;
        if AXES == SPACE_AND_SIZE {
            let below = self.largest - exponent(primitive.bounds().half_area());
            at.w = below as f32 + 0.5;
        }
        at.max(Vec4::splat(0.5)).min(Vec4::splat(self.last)) + Vec4::splat(TO_BITS)
    }
}

/// Bounds and number of the primitives whose centres lie in each cell of each axis.
#[derive(Clone, Copy, Debug)]
struct Bins<const N: usize, const AXES: usize> {
    bounds: [[BoxLanes; N]; AXES],
    counts: [[u32; N]; AXES],
}

impl<const N: usize, const AXES: usize> Bins<N, AXES> {
    /// Not a constant, which would be copied from memory.
    #[inline(always)]
    fn empty() -> Self {
        Self {
            bounds: [[NO_BOX; N]; AXES],
            counts: [[0; N]; AXES],
        }
    }

    #[inline(always)]
    fn fill<V: Lanes>(refs: &[PrimitiveRef], grid: &Grid) -> Self {
        const { assert!(N.is_power_of_two()) };
        let mut bins = Self::empty();
        for r in refs {
            let own = V::load(&r.lanes);
            let cells = grid.cells::<AXES>(r, r.center()).to_array();
            for (axis, cell) in cells.into_iter().enumerate().take(AXES) {
                let cell = cell.to_bits() as usize % N;
                let bounds = &mut bins.bounds[axis][cell];
                own.max(V::load(bounds)).store(bounds);
                let count = &mut bins.counts[axis][cell];
                *count = count.wrapping_add(1);
            }
        }
        bins
    }

    fn merge(&mut self, other: &Self) {
        for (a, b) in self.bounds.iter_mut().zip(&other.bounds) {
            let lanes = a.as_flattened_mut().iter_mut().zip(b.as_flattened());
            lanes.for_each(|(a, b)| *a = a.max(*b));
        }
        for (a, b) in self.counts.iter_mut().zip(&other.counts) {
            a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
        }
    }

    /// The last cell on the left of the cheapest plane of an axis, and the sum over both sides of
    /// half area times `blocks`; `None` if no plane separates the centres or the areas overflow.
    #[inline(always)]
    fn cheapest(&self, axis: usize, shift: u32) -> Option<(usize, f32)> {
        let (bounds, counts) = (&self.bounds[axis], &self.counts[axis]);
        let mut right = [f32::INFINITY; N];
        let (mut all, mut count) = (Bounds::EMPTY, 0);
        for i in (1..N).rev() {
            all = all.union(&Bounds::of_lanes(&bounds[i]));
            count += counts[i];
            if count > 0 {
                right[i - 1] = all.half_area() * blocks(count, shift);
            }
        }
        let (mut best, mut best_cost) = (N, f32::MAX);
        let (mut all, mut count) = (Bounds::EMPTY, 0);
        for i in 0..N - 1 {
            all = all.union(&Bounds::of_lanes(&bounds[i]));
            count += counts[i];
            let cost = all.half_area() * blocks(count, shift) + right[i];
            if count > 0 && cost < best_cost {
                (best, best_cost) = (i, cost);
            }
        }
        (best < N).then_some((best, best_cost))
    }
}

/// Number of blocks of 2^`shift` primitives that `count` primitives fill, at least in part.
#[inline(always)]
pub(super) fn blocks(count: u32, shift: u32) -> f32 {
    ((count + (1 << shift) - 1) >> shift) as f32
}

/// A plane between two cells.
#[derive(Clone, Debug)]
pub(super) struct Split {
    grid: Grid,
    axis: usize,
    /// Last cell on the left.
    limit: f32,
    /// What parts, as it found; never changes a bit.
    isa: Isa,
    /// Bounds of left and right.
    pub(super) bounds: [Bounds; 2],
    /// Number of primitives on the left, of each chunk of the range.
    left: Vec<usize>,
    /// The same in sum.
    pub(super) left_count: usize,
    /// Half areas that no box of left and right exceeds, if sizes were looked at.
    pub(super) largest: Option<[f32; 2]>,
    /// Sum over both sides of half area times number of blocks.
    pub(super) cost: f32,
}

impl Split {
    /// The cheapest plane by the surface-area heuristic in blocks of 2^`shift` primitives, `None`
    /// if no plane separates the centres or the areas overflow. `largest`: the half area of the
    /// largest box if sizes shall be looked at too.
    ///
    /// Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies".
    pub(super) fn find(
        refs: &[PrimitiveRef],
        centers: &Bounds,
        largest: Option<f32>,
        (shift, isa): (u32, Isa),
    ) -> Option<Self> {
        let with = (shift, isa);
        match largest {
            Some(area) => Self::among::<16, SPACE_AND_SIZE>(refs, centers, area, with),
            // Half the time of eight cells, and trees of the same expected cost to four digits.
            None if refs.len() <= 6 => Self::among::<4, SPACE>(refs, centers, 0.0, with),
            None if refs.len() <= 32 => Self::among::<8, SPACE>(refs, centers, 0.0, with),
            None => Self::among::<16, SPACE>(refs, centers, 0.0, with),
        }
    }

    fn among<const N: usize, const AXES: usize>(
        refs: &[PrimitiveRef],
        centers: &Bounds,
        largest: f32,
        (shift, isa): (u32, Isa),
    ) -> Option<Self> {
        let grid = Grid::new(centers, N, largest);
        let with = (shift, isa);
        if refs.len() <= 2 * CHUNK {
            return dispatch(isa, Search::<N, AXES> { refs, grid, with });
        }
        let mut chunks = Vec::new();
        refs.par_chunks(CHUNK)
            .map(|refs| dispatch(isa, Fill::<N, AXES> { refs, grid }))
            .collect_into_vec(&mut chunks);
        let mut sum = Bins::empty();
        chunks.iter().for_each(|bins| sum.merge(bins));
        Self::of_bins(&sum, &chunks, grid, with)
    }

    /// The cheapest plane between the cells of `bins`, which are the sum of `chunks` if there are any.
    #[inline(always)]
    fn of_bins<const N: usize, const AXES: usize>(
        bins: &Bins<N, AXES>,
        chunks: &[Bins<N, AXES>],
        grid: Grid,
        (shift, isa): (u32, Isa),
    ) -> Option<Self> {
        let mut best: Option<(usize, usize, f32)> = None;
        for axis in (0..AXES).filter(|&axis| axis == SPACE || grid.scale[axis] > 0.0) {
            if let Some((cell, cost)) = bins.cheapest(axis, shift)
                && best.is_none_or(|(_, _, least)| cost < least)
            {
                best = Some((axis, cell, cost));
            }
        }
        let (axis, last, cost) = best?;
        let left_of =
            |bins: &Bins<N, AXES>| bins.counts[axis][..=last].iter().sum::<u32>() as usize;
        let join = |cells: &[BoxLanes]| {
            let all = cells.iter().map(Bounds::of_lanes);
            all.fold(Bounds::EMPTY, |a, b| a.union(&b))
        };
        let (left, right) = bins.bounds[axis].split_at(last + 1);
        let largest = (AXES == SPACE_AND_SIZE).then(|| {
            let largest = |from| grid.largest_from(from, &bins.counts[SPACE]);
            [
                largest(0),
                largest(if axis == SPACE { last + 1 } else { 0 }),
            ]
        });
        Some(Self {
            grid,
            axis,
            largest,
            limit: cell(last),
            isa,
            bounds: [join(left), join(right)],
            left: chunks.iter().map(left_of).collect(),
            left_count: left_of(bins),
            cost,
        })
    }

    /// Copies the primitives of each side, in order, into a slice of its own; returns the bounds of
    /// their centres.
    pub(super) fn part(
        &self,
        refs: &[PrimitiveRef],
        mut left: &mut [PrimitiveRef],
        mut right: &mut [PrimitiveRef],
    ) -> [Bounds; 2] {
        if self.left.is_empty() {
            return self.part_one(refs, left, right);
        }
        let mut pieces = Vec::with_capacity(self.left.len());
        for (chunk, &count) in refs.chunks(CHUNK).zip(&self.left) {
            let (l, r);
            (l, left) = left.split_at_mut(count);
            (r, right) = right.split_at_mut(chunk.len() - count);
            pieces.push((chunk, l, r));
        }
        pieces
            .into_par_iter()
            .map(|(chunk, left, right)| self.part_one(chunk, left, right))
            .reduce(
                || [Bounds::EMPTY; 2],
                |a, b| [a[0].union(&b[0]), a[1].union(&b[1])],
            )
    }

    fn part_one(
        &self,
        refs: &[PrimitiveRef],
        left: &mut [PrimitiveRef],
        right: &mut [PrimitiveRef],
    ) -> [Bounds; 2] {
        let split = self;
        if self.axis < SPACE {
            dispatch(
                self.isa,
                Parting::<SPACE> {
                    split,
                    refs,
                    left,
                    right,
                },
            )
        } else {
            dispatch(
                self.isa,
                Parting::<SPACE_AND_SIZE> {
                    split,
                    refs,
                    left,
                    right,
                },
            )
        }
    }

    #[inline(always)]
    fn part_chunk<const AXES: usize>(
        &self,
        refs: &[PrimitiveRef],
        left: &mut [PrimitiveRef],
        right: &mut [PrimitiveRef],
    ) -> [Bounds; 2] {
        // A side that a primitive is not on sees its centre at infinity, where it changes nothing.
        const GATES: [Vec4; 2] = [Vec4::INFINITY, Vec4::NEG_INFINITY];
        let limit = Vec4::splat(self.limit);
        let [mut l, mut r] = [Bounds::EMPTY; 2];
        let (mut next_left, mut next_right) = (0, 0);
        for primitive in refs {
            let center = primitive.center();
            let is_left = self
                .grid
                .cells::<AXES>(primitive, center)
                .cmple(limit)
                .bitmask()
                >> self.axis
                & 1;
            // Written to both sides, kept on one: no branch that guesses wrong half of the time.
            if let Some(place) = left.get_mut(next_left) {
                *place = *primitive;
            }
            if let Some(place) = right.get_mut(next_right) {
                *place = *primitive;
            }
            next_left += is_left as usize;
            next_right += 1 - is_left as usize;
            let gate = GATES[is_left as usize];
            l.grow(center.max(gate), center.min(-gate));
            r.grow(center.max(-gate), center.min(gate));
        }
        [l, r]
    }
}

/// [`Bins::fill`], compiled for an instruction set.
struct Fill<'a, const N: usize, const AXES: usize> {
    refs: &'a [PrimitiveRef],
    grid: Grid,
}

impl<const N: usize, const AXES: usize> Kernel for Fill<'_, N, AXES> {
    type Answer = Bins<N, AXES>;

    #[inline(always)]
    fn run<T: NodeTest>(self) -> Bins<N, AXES> {
        Bins::fill::<T::Rays>(self.refs, &self.grid)
    }
}

/// [`Split::among`] few primitives, compiled for an instruction set.
struct Search<'a, const N: usize, const AXES: usize> {
    refs: &'a [PrimitiveRef],
    grid: Grid,
    with: (u32, Isa),
}

impl<const N: usize, const AXES: usize> Kernel for Search<'_, N, AXES> {
    type Answer = Option<Split>;

    #[inline(always)]
    fn run<T: NodeTest>(self) -> Option<Split> {
        let bins = Bins::<N, AXES>::fill::<T::Rays>(self.refs, &self.grid);
        Split::of_bins(&bins, &[], self.grid, self.with)
    }
}

/// [`Split::part_chunk`], compiled for an instruction set.
struct Parting<'a, const AXES: usize> {
    split: &'a Split,
    refs: &'a [PrimitiveRef],
    left: &'a mut [PrimitiveRef],
    right: &'a mut [PrimitiveRef],
}

impl<const AXES: usize> Kernel for Parting<'_, AXES> {
    type Answer = [Bounds; 2];

    #[inline(always)]
    fn run<T: NodeTest>(self) -> [Bounds; 2] {
        self.split
            .part_chunk::<AXES>(self.refs, self.left, self.right)
    }
}

impl Extents {
    /// [`Self::of`], in parallel if it pays.
    pub(super) fn of_many(refs: &[PrimitiveRef]) -> Self {
        if refs.len() <= 2 * CHUNK {
            return Self::of(refs);
        }
        let chunks = refs.par_chunks(CHUNK).map(Self::of);
        chunks.reduce(|| Self::EMPTY, Self::union)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::math::Aabb;

    fn split(boxes: &[Aabb], with_sizes: bool) -> (Vec<u32>, Vec<u32>, Split) {
        let refs: Vec<_> = (0..)
            .zip(boxes)
            .map(|(i, b)| PrimitiveRef::new(i, b))
            .collect();
        let all = Extents::of(&refs);
        let largest = with_sizes.then(|| all.bounds.half_area());
        let find = |isa: Isa| Split::find(&refs, &all.centers, largest, (2, isa));
        let split = find(Isa::best()).expect("can be parted");
        for isa in Isa::available() {
            let other = find(isa).expect("can be parted");
            assert_eq!((other.cost, other.limit), (split.cost, split.limit));
            assert_eq!((other.axis, &other.left), (split.axis, &split.left));
        }
        let mut left = vec![PrimitiveRef::NOTHING; split.left_count];
        let mut right = vec![PrimitiveRef::NOTHING; refs.len() - split.left_count];
        let centers = split.part(&refs, &mut left, &mut right);
        for (side, refs) in [&left, &right].into_iter().enumerate() {
            let extents = Extents::of(refs);
            assert_eq!(extents.bounds.aabb(), split.bounds[side].aabb());
            assert_eq!(extents.centers.aabb(), centers[side].aabb());
        }
        let ids = |refs: &[PrimitiveRef]| refs.iter().map(PrimitiveRef::id).collect();
        (ids(&left), ids(&right), split)
    }

    fn unit(x: f32, y: f32) -> Aabb {
        let corner = Vec3::new(x, y, 0.0);
        Aabb::from_points([corner, corner + Vec3::ONE])
    }

    #[test]
    fn a_gap_parts_two_groups_of_any_length_in_their_order() {
        for count in [8, 40, 3 * CHUNK + 5] {
            let boxes: Vec<_> = (0..count)
                .map(|i| unit((i % 3 / 2) as f32 * 100.0, (i % 7) as f32))
                .collect();
            let (left, right, _) = split(&boxes, false);
            assert!(
                left.into_iter()
                    .eq((0..count as u32).filter(|i| i % 3 != 2))
            );
            assert!(
                right
                    .into_iter()
                    .eq((0..count as u32).filter(|i| i % 3 == 2))
            );
        }
    }

    #[test]
    fn a_wall_is_parted_from_small_boxes_by_its_size() {
        let mut boxes: Vec<_> = (0..500)
            .map(|i| unit((i % 20) as f32, (i / 20) as f32))
            .collect();
        boxes[123] = Aabb::from_points([Vec3::splat(-100.0), Vec3::new(120.0, 126.0, 101.0)]);
        let (left, right, sizes) = split(&boxes, true);
        assert_eq!((left, right.len()), (vec![123], 499));
        let [large, small] = sizes.largest.expect("sizes were looked at");
        assert!(large >= boxes[123].half_area() && (3.0..=8.0).contains(&small));
        let (_, _, places) = split(&boxes, false);
        assert!(sizes.cost < 0.1 * places.cost);
    }
}
