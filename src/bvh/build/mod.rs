//! Makes a tree of boxes, top down: ranges of primitives are split by the surface-area heuristic
//! straight into nodes of eight children; there is no binary tree in between. High quality makes one
//! and improves it; fast builds sort primitives along a curve and split only what is large.

mod binary;
mod bins;
mod chunk;
mod curve;
mod family;
mod fast;
mod high;
mod optimal;
mod pairs;
mod primitive;
mod range;
mod reinsert;
mod rows;
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
use super::tree::{BLOCK, Bvh, LeafBlocks};
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
        let tree = chunk.map(|Chunk { nodes, blocks }| {
            let excluded = count - nodes.first().map_or(0, WideNode::primitives);
            let bvh = Self::new(nodes, blocks.len(), excluded, start.elapsed());
            (bvh, blocks)
        });
        match tree.filter(|(bvh, _)| bvh.wide_depth() <= MOST_WIDE_DEPTH) {
            Some(tree) => Some(tree),
            None => {
                let quality = BvhQuality::Standard;
                let settings = BvhSettings {
                    quality,
                    ..*settings
                };
                Self::build_with(count, bounds, &settings, progress)
            }
        }
    }
}

/// Trees of high quality that are deeper are not taken over: rays keep a stack in proportion to the
/// depth. The standard build stays below this by itself.
const MOST_WIDE_DEPTH: usize = 64;

/// The tree over those of `refs` that are something; `Some(None)` if it would be far too deep.
fn build(
    mut refs: Vec<PrimitiveRef>,
    settings: &BvhSettings,
    progress: &Progress<'_>,
) -> Option<Option<Chunk>> {
    if refs.par_iter().any(PrimitiveRef::is_nothing) {
        refs.retain(|r| !r.is_nothing());
    }
    let is_high = settings.quality == BvhQuality::High && settings.kind == BvhKind::Sah;
    let is_fast = settings.quality == BvhQuality::Fast && settings.kind == BvhKind::Sah;
    let work = match (is_high, is_fast) {
        (true, _) => high::work,
        (_, true) => fast::work,
        _ => |n| n,
    };
    let watch = Watch::new(work(refs.len()), progress);
    watch.advance(0)?;
    let mut whole = Chunk::default();
    if refs.is_empty() {
        return Some(Some(whole));
    }
    if is_fast {
        return fast::build(refs, settings.leaf_size, &watch).map(Some);
    }
    let can_pair = !is_high && settings.kind == BvhKind::Sah;
    let can_pair = can_pair && settings.leaf_size as usize >= BLOCK;
    let most = if can_pair && pairs::pair(&mut refs) {
        pairs::PAIR
    } else {
        1
    };
    let nothing = (0..refs.len()).into_par_iter();
    let mut spare: Vec<_> = nothing.map(|_| PrimitiveRef::NOTHING).collect();
    let range = Range::new(&mut refs, &mut spare);
    let tree = if is_high {
        high::build(range, settings.leaf_size.clamp(1, 255), &watch)?
    } else {
        let rule = Rule::new(settings, most);
        Some(wide::build(range, &rule, Depth::default(), &watch)?)
    };
    let Some(tree) = tree else {
        return Some(None);
    };
    let root = whole.append(tree, 0);
    if whole.nodes.is_empty() {
        whole.nodes.push(WideNode::new(&[root], &[], 0));
    }
    Some(Some(whole))
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;
    use std::time::Duration;

    use glam::Vec3;

    use super::*;
    use crate::bvh::BvhStats;

    /// Boxes around places that come closer and closer to a point, each as large as its distance.
    fn ever_smaller(count: u16) -> Vec<Aabb> {
        let size = |i: u16| 10.0_f32.powf(f32::from(i) * 34.0 / f32::from(count) - 17.0);
        let boxes = (0..count).map(|i| Aabb::from_points([Vec3::ZERO, Vec3::splat(2.0 * size(i))]));
        boxes.collect()
    }

    fn settings(quality: BvhQuality) -> BvhSettings {
        BvhSettings {
            quality,
            leaf_size: 1,
            ..BvhSettings::default()
        }
    }

    #[test]
    fn high_quality_gives_way_to_standard_where_it_would_be_too_deep() {
        let boxes = ever_smaller(5000);
        let refs = (0..).zip(&boxes).map(|(i, b)| PrimitiveRef::new(i, b));
        let go_on = |_| ControlFlow::Continue(());
        let high = build(refs.collect(), &settings(BvhQuality::High), &go_on);
        let Chunk { nodes, blocks } = high.expect("not stopped").expect("no 500 nodes deep");
        let deep = Bvh::new(nodes, blocks.len(), 0, Duration::ZERO);
        assert!(deep.wide_depth() > MOST_WIDE_DEPTH);
        let [high, standard] = [BvhQuality::High, BvhQuality::Standard]
            .map(|quality| Bvh::build(&boxes, &settings(quality)));
        assert!(high.0.wide_depth() <= MOST_WIDE_DEPTH);
        assert_eq!(high.1, standard.1);
        let shape = |(bvh, _): &(Bvh, LeafBlocks)| BvhStats {
            build_seconds: 0.0,
            ..bvh.stats()
        };
        assert_eq!(shape(&high), shape(&standard));
    }
}
