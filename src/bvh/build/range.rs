use rayon::prelude::*;

use super::bins::{CHUNK, Split, blocks};
use super::primitive::{Extents, PrimitiveRef};
use crate::bvh::tree::BLOCK;
use crate::bvh::{BvhKind, BvhSettings};
use crate::math::Isa;

/// Below this depth in the binary tree, or that in the wide one, ranges are halved, whatever the
/// heuristic says. 2³¹ primitives can be halved 31 times, so no leaf lies deeper than 91 and no wide
/// node deeper than 55.
const HALVING_DEPTH: usize = 60;
const HALVING_WIDE_DEPTH: usize = 24;

/// Cost of an inner node of the binary tree, of which up to seven make a wide node, in units of
/// testing a block.
const INNER_COST: f32 = 0.5;

/// Down to this depth, ranges of that many primitives are split by size too, if there may be one
/// whose box has at least this fraction of the area of theirs.
const SIZES_DEPTH: usize = 12;
const MANY: usize = 256;
const LARGE: f32 = 1.0 / 32.0;

/// Nodes above, in the binary and in the wide tree.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Depth {
    pub(super) binary: usize,
    pub(super) wide: usize,
}

/// When to make leaves and how to split.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rule<'a> {
    kind: BvhKind,
    /// Most references in a leaf, and in a block.
    leaf_size: usize,
    block: usize,
    /// Leaves are counted in blocks of 2^`shift` references.
    shift: u32,
    /// What finds the splits; never changes one.
    isa: Isa,
    /// If not empty, each primitive is some of these runs, and becomes a node.
    runs: &'a [PrimitiveRef],
}

/// What becomes of a range.
#[derive(Debug)]
pub(super) enum Plan {
    Leaf,
    Halves,
    Sides(Split),
}

impl<'a> Rule<'a> {
    /// Down to single primitives, but with an eye to the blocks that they will share: measured 1 to
    /// 5 % fewer expected visits and 12 % less memory than counting single ones.
    pub(super) fn single() -> Self {
        Self {
            shift: BLOCK.ilog2(),
            ..Self::groups(&[])
        }
    }

    /// Down to single groups of `runs`.
    pub(super) fn groups(runs: &'a [PrimitiveRef]) -> Self {
        Self {
            kind: BvhKind::Sah,
            leaf_size: 1,
            block: BLOCK,
            shift: 0,
            isa: Isa::best(),
            runs,
        }
    }

    /// For references that stand for up to `most` primitives, a divisor of [`BLOCK`].
    pub(super) fn new(settings: &BvhSettings, most: usize) -> Self {
        let leaf_size = (settings.leaf_size.clamp(1, 255) as usize / most).max(1);
        let block = BLOCK / most;
        Self {
            kind: settings.kind,
            leaf_size,
            block,
            shift: leaf_size.min(block).ilog2(),
            isa: Isa::best(),
            runs: &[],
        }
    }

    /// Number of blocks that `count` references fill, at least in part.
    pub(super) fn blocks(&self, count: usize) -> usize {
        count.div_ceil(self.block)
    }

    /// True if the range is a leaf without looking at its primitives.
    pub(super) fn is_leaf(&self, count: usize) -> bool {
        match self.kind {
            BvhKind::None => true,
            BvhKind::Median => count <= self.leaf_size,
            BvhKind::Sah => count <= self.leaf_size.min(self.block),
        }
    }

    /// The runs of a group; `None` of a primitive.
    pub(super) fn members(&self, group: &PrimitiveRef) -> Option<&'a [PrimitiveRef]> {
        let ids = group.ids();
        let is_group = !self.runs.is_empty();
        is_group.then(|| &self.runs[ids.start as usize..ids.end as usize])
    }

    /// Number of primitives that one of a range stands for.
    pub(super) fn primitives(&self, one: &PrimitiveRef) -> usize {
        let runs = self.members(one);
        runs.map_or(one.count(), |runs| {
            runs.iter().map(PrimitiveRef::count).sum()
        })
    }

    pub(super) fn plan(&self, range: &Range<'_>, depth: Depth) -> Plan {
        let count = range.len();
        if self.is_leaf(count) {
            return Plan::Leaf;
        }
        let fits = count <= self.leaf_size;
        if depth.binary >= HALVING_DEPTH || depth.wide >= HALVING_WIDE_DEPTH {
            return if fits { Plan::Leaf } else { Plan::Halves };
        }
        if self.kind == BvhKind::Median {
            return Plan::Halves;
        }
        let large = range.largest >= LARGE * range.extents.bounds.half_area();
        let by_size = large && count >= MANY && depth.binary <= SIZES_DEPTH;
        let largest = by_size.then_some(range.largest);
        let centers = &range.extents.centers;
        let split = Split::find(range.refs, centers, largest, (self.shift, self.isa));
        if fits {
            let area = range.extents.bounds.half_area();
            let cost = split.as_ref().map_or(f32::INFINITY, |split| split.cost);
            if (blocks(count as u32, self.shift) - INNER_COST) * area <= cost {
                return Plan::Leaf;
            }
        }
        split.map_or(Plan::Halves, Plan::Sides)
    }
}

/// Primitives that make a subtree, and as much room.
#[derive(Debug)]
pub(super) struct Range<'a> {
    pub(super) refs: &'a mut [PrimitiveRef],
    spare: &'a mut [PrimitiveRef],
    pub(super) extents: Extents,
    /// No box has a larger half area.
    largest: f32,
}

impl<'a> Range<'a> {
    /// All of `refs`; `spare` is as long.
    pub(super) fn new(refs: &'a mut [PrimitiveRef], spare: &'a mut [PrimitiveRef]) -> Self {
        let extents = Extents::of_many(refs);
        let areas = refs
            .par_iter()
            .with_min_len(CHUNK)
            .map(|r| r.bounds().half_area());
        Self {
            largest: areas.reduce(|| 0.0, f32::max),
            refs,
            spare,
            extents,
        }
    }

    /// Number of primitives.
    pub(super) fn len(&self) -> usize {
        self.refs.len()
    }

    /// Leaves an empty range behind.
    pub(super) fn take(&mut self) -> Self {
        Self {
            refs: std::mem::take(&mut self.refs),
            spare: std::mem::take(&mut self.spare),
            extents: self.extents,
            largest: self.largest,
        }
    }

    /// Keeps the left side of `split` and returns the right one.
    pub(super) fn part(&mut self, split: &Split) -> Self {
        let whole = self.take();
        let (left, right) = whole.spare.split_at_mut(split.left_count);
        let centers = split.part(whole.refs, left, right);
        let (spare_left, spare_right) = whole.refs.split_at_mut(split.left_count);
        let extents = |side: usize| Extents {
            bounds: split.bounds[side],
            centers: centers[side],
        };
        let largest = split.largest.unwrap_or([whole.largest; 2]);
        *self = Self {
            refs: left,
            spare: spare_left,
            extents: extents(0),
            largest: largest[0],
        };
        Self {
            refs: right,
            spare: spare_right,
            extents: extents(1),
            largest: largest[1],
        }
    }

    /// Keeps the half with the smaller centres on the longest axis, and returns the other.
    ///
    /// The id decides between equal centres, so that any range of two or more can be halved.
    pub(super) fn halve(&mut self) -> Self {
        let whole = self.take();
        let axis = whole.extents.longest_axis();
        let middle = whole.refs.len() / 2;
        whole.refs.select_nth_unstable_by(middle, |a, b| {
            let order = a.center()[axis].total_cmp(&b.center()[axis]);
            order.then(a.id().cmp(&b.id()))
        });
        let (left, right) = whole.refs.split_at_mut(middle);
        let (spare_left, spare_right) = whole.spare.split_at_mut(middle);
        let half = |refs: &'a mut [PrimitiveRef], spare: &'a mut [PrimitiveRef]| Self {
            extents: Extents::of_many(refs),
            refs,
            spare,
            largest: whole.largest,
        };
        *self = half(left, spare_left);
        half(right, spare_right)
    }
}
