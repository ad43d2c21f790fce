use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

use super::collapse::collapse;
use super::pair::{BinaryNode, Pair};
use super::range::{Extents, PrimitiveRef, split_at_median};
use super::sah::BinnedSplit;
use super::slab::padded;
use super::tree::{Bvh, LeafBlocks};
use super::{BvhKind, BvhQuality, BvhSettings};
use crate::math::Aabb;

/// Below this depth ranges are halved, whatever the heuristic says.
const HALVING_DEPTH: usize = 60;

/// Ranges up to this size are built by one thread.
const SERIAL: usize = 4096;

/// Cost of visiting an inner node, in units of testing one primitive.
///
/// Of 0.5, 1 and 2, the largest gave the fastest rays on fine meshes and the smallest trees.
pub(super) const NODE_COST: f32 = 2.0;

impl Bvh {
    /// Builds the tree over `boxes`, and what its leaves hold. Boxes that are empty or not finite stay outside.
    pub fn build(boxes: &[Aabb], settings: &BvhSettings) -> (Self, LeafBlocks) {
        Self::build_with(boxes, settings, &|_| ControlFlow::Continue(()))
            .expect("nothing asks this build to stop")
    }

    /// Like [`Self::build`]; reports the finished fraction (0 to 1, from any thread, not in order)
    /// to `progress`, which may stop the build. `None` if it did.
    ///
    /// The tree does not depend on the number of threads.
    ///
    /// # Panics
    /// With 2³¹ boxes or more.
    pub fn build_with(
        boxes: &[Aabb],
        settings: &BvhSettings,
        progress: &(dyn Fn(f32) -> ControlFlow<()> + Sync),
    ) -> Option<(Self, LeafBlocks)> {
        assert!(boxes.len() < 1 << 31, "too many primitives");
        let start = Instant::now();
        let usable = |b: &Aabb| !b.is_empty() && b.min.is_finite() && b.max.is_finite();
        let mut refs: Vec<_> = (0..)
            .zip(boxes)
            .filter(|(_, b)| usable(b))
            .map(|(id, b)| PrimitiveRef {
                bounds: padded(*b),
                id,
            })
            .collect();
        let builder = Builder {
            settings,
            total: refs.len(),
            done: AtomicUsize::new(0),
            stopped: AtomicBool::new(false),
            progress,
        };
        builder.report(0)?;
        let mut pairs = vec![Pair::new(BinaryNode::NOWHERE, BinaryNode::NOWHERE)];
        if !refs.is_empty() {
            let root = builder.parallel(&mut refs, 0, 0)?.flatten(&mut pairs);
            pairs[0] = Pair::new(root, BinaryNode::NOWHERE);
        }
        let order: Vec<_> = refs.iter().map(|r| r.id).collect();
        let (nodes, blocks) = collapse(&pairs, &order);
        let excluded = boxes.len() - order.len();
        let bvh = Self::new(nodes, blocks.len(), excluded, start.elapsed());
        Some((bvh, blocks))
    }
}

struct Builder<'a> {
    settings: &'a BvhSettings,
    total: usize,
    done: AtomicUsize,
    stopped: AtomicBool,
    progress: &'a (dyn Fn(f32) -> ControlFlow<()> + Sync),
}

/// A subtree as a parallel build leaves it.
enum Part {
    /// Built by one thread; the pair indices count from the start of `pairs`.
    Chunk { root: BinaryNode, pairs: Vec<Pair> },
    /// Two subtrees.
    Inner {
        bounds: Aabb,
        children: Box<[Self; 2]>,
    },
}

impl Part {
    /// Appends the pairs of this subtree in depth-first order; returns its root.
    fn flatten(self, out: &mut Vec<Pair>) -> BinaryNode {
        let first = u32::try_from(out.len()).expect("fewer pairs than primitives");
        match self {
            Self::Chunk { mut root, pairs } => {
                if root.count == 0 {
                    root.first += first;
                }
                out.extend(pairs.into_iter().map(|p| p.shifted(first)));
                root
            }
            Self::Inner { bounds, children } => {
                out.push(Pair::new(BinaryNode::NOWHERE, BinaryNode::NOWHERE));
                let [left, right] = children.map(|part| part.flatten(out));
                out[first as usize] = Pair::new(left, right);
                BinaryNode {
                    bounds,
                    first,
                    count: 0,
                }
            }
        }
    }
}

impl Builder<'_> {
    /// Counts `finished` more primitives; `None` when the build shall stop.
    fn report(&self, finished: usize) -> Option<()> {
        let done = self.done.fetch_add(finished, Ordering::Relaxed) + finished;
        if self.stopped.load(Ordering::Relaxed) {
            return None;
        }
        if (self.progress)(done as f32 / self.total.max(1) as f32).is_break() {
            self.stopped.store(true, Ordering::Relaxed);
            return None;
        }
        Some(())
    }

    fn parallel(&self, refs: &mut [PrimitiveRef], first: usize, depth: usize) -> Option<Part> {
        if refs.len() <= SERIAL {
            let mut pairs = Vec::with_capacity(refs.len() / 2);
            let root = self.serial(refs, first, depth, &mut pairs);
            self.report(refs.len())?;
            return Some(Part::Chunk { root, pairs });
        }
        let extents = Extents::of(refs);
        let Some(mid) = self.split(refs, &extents, depth) else {
            self.report(refs.len())?;
            return Some(Part::Chunk {
                root: leaf(extents.bounds, first, refs.len()),
                pairs: Vec::new(),
            });
        };
        self.report(0)?;
        let (left, right) = refs.split_at_mut(mid);
        let (left, right) = rayon::join(
            || self.parallel(left, first, depth + 1),
            || self.parallel(right, first + mid, depth + 1),
        );
        Some(Part::Inner {
            bounds: extents.bounds,
            children: Box::new([left?, right?]),
        })
    }

    fn serial(
        &self,
        refs: &mut [PrimitiveRef],
        first: usize,
        depth: usize,
        pairs: &mut Vec<Pair>,
    ) -> BinaryNode {
        let extents = Extents::of(refs);
        let Some(mid) = self.split(refs, &extents, depth) else {
            return leaf(extents.bounds, first, refs.len());
        };
        let index = pairs.len();
        pairs.push(Pair::new(BinaryNode::NOWHERE, BinaryNode::NOWHERE));
        let (left, right) = refs.split_at_mut(mid);
        let left = self.serial(left, first, depth + 1, pairs);
        let right = self.serial(right, first + mid, depth + 1, pairs);
        pairs[index] = Pair::new(left, right);
        BinaryNode {
            bounds: extents.bounds,
            first: index as u32,
            count: 0,
        }
    }

    /// Parts `refs` in two; the length of the left part, or `None` if they make one leaf.
    fn split(&self, refs: &mut [PrimitiveRef], extents: &Extents, depth: usize) -> Option<usize> {
        let n = refs.len();
        let fits = n <= self.settings.leaf_size.max(1) as usize;
        match self.settings.kind {
            BvhKind::None => return None,
            _ if n == 1 => return None,
            BvhKind::Median if fits => return None,
            BvhKind::Sah if fits && self.settings.quality == BvhQuality::Fast => return None,
            BvhKind::Sah if depth < HALVING_DEPTH => {
                let split = BinnedSplit::find(refs, &extents.centers);
                let cost = split.map_or(f32::INFINITY, |s| s.cost);
                let area = extents.bounds.half_area();
                if fits && n as f32 * area <= NODE_COST * area + cost {
                    return None;
                }
                if let Some(split) = split {
                    return Some(split.partition(refs));
                }
            }
            BvhKind::Sah if fits => return None,
            BvhKind::Median | BvhKind::Sah => {}
        }
        Some(split_at_median(refs, &extents.centers))
    }
}

fn leaf(bounds: Aabb, first: usize, count: usize) -> BinaryNode {
    BinaryNode {
        bounds,
        first: first as u32,
        count: count as u32,
    }
}
