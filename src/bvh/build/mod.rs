//! Makes a tree of boxes, top down: ranges of primitives are split by the surface-area heuristic
//! straight into nodes of eight children; there is no binary tree in between.

mod binary;
mod bins;
mod chunk;
mod family;
mod high;
mod optimal;
mod primitive;
mod range;
mod reinsert;
mod watch;
mod wide;

use std::ops::ControlFlow;
use std::time::Instant;

use rayon::prelude::*;

use self::chunk::Chunk;
use self::primitive::PrimitiveRef;
use self::range::{Depth, Range, Rule};
use self::watch::Watch;
use super::node::WideNode;
use super::tree::{Bvh, LeafBlocks};
use super::{BvhKind, BvhQuality, BvhSettings};
use crate::math::Aabb;

pub use self::watch::Progress;

impl Bvh {
    /// Builds the tree over `boxes`, and what its leaves hold. Boxes that are empty or not finite
    /// stay outside.
    pub fn build(boxes: &[Aabb], settings: &BvhSettings) -> (Self, LeafBlocks) {
        let bounds = |id: u32| boxes[id as usize];
        let go_on = |_| ControlFlow::Continue(());
        Self::build_with(boxes.len(), &bounds, settings, &go_on)
            .expect("nothing asks this build to stop")
    }

    /// Builds the tree over the `count` boxes that `bounds` gives, on all threads of the current
    /// pool. `None` if `progress` stopped it.
    ///
    /// The tree does not depend on the number of threads.
    ///
    /// # Panics
    /// With 2³¹ boxes or more.
    pub fn build_with(
        count: usize,
        bounds: &(impl Fn(u32) -> Aabb + Sync),
        settings: &BvhSettings,
        progress: &Progress<'_>,
    ) -> Option<(Self, LeafBlocks)> {
        assert!(count < 1 << 31, "too many primitives");
        let start = Instant::now();
        let refs: Vec<_> = (0..count as u32)
            .into_par_iter()
            .map(|id| PrimitiveRef::new(id, &bounds(id)))
            .collect();
        let chunk = build(refs, settings, progress)?;
        let included = chunk.nodes.first().map_or(0, WideNode::primitives);
        let (blocks, excluded) = (chunk.blocks, count - included);
        let bvh = Self::new(chunk.nodes, blocks.len(), excluded, start.elapsed());
        Some((bvh, blocks))
    }
}

/// The tree over those of `refs` that are something.
fn build(
    mut refs: Vec<PrimitiveRef>,
    settings: &BvhSettings,
    progress: &Progress<'_>,
) -> Option<Chunk> {
    if refs.par_iter().any(PrimitiveRef::is_nothing) {
        refs.retain(|r| !r.is_nothing());
    }
    let is_high = settings.quality == BvhQuality::High && settings.kind == BvhKind::Sah;
    let work = if is_high {
        high::work(refs.len())
    } else {
        refs.len()
    };
    let watch = Watch::new(work, progress);
    watch.advance(0)?;
    let mut whole = Chunk::default();
    if refs.is_empty() {
        return Some(whole);
    }
    let nothing = (0..refs.len()).into_par_iter();
    let mut spare: Vec<_> = nothing.map(|_| PrimitiveRef::NOTHING).collect();
    let mut tree = None;
    if is_high {
        let leaf_size = settings.leaf_size.clamp(1, 255);
        tree = high::build(Range::new(&mut refs, &mut spare), leaf_size, &watch)?;
    }
    let tree = match tree {
        Some(tree) => tree,
        None => {
            let range = Range::new(&mut refs, &mut spare);
            wide::build(range, &Rule::new(settings), Depth::default(), &watch)?
        }
    };
    let root = whole.append(tree, 0);
    if whole.nodes.is_empty() {
        whole.nodes.push(WideNode::new(&[root], &[], 0));
    }
    Some(whole)
}
