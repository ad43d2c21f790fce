use rayon::prelude::*;

use super::chunk::Chunk;
use super::curve::Curve;
use super::primitive::{Extents, PrimitiveRef};
use super::range::{Depth, Range, Rule};
use super::rows::runs;
use super::watch::Watch;
use super::wide;
use crate::bvh::node::{WIDTH, WideNode};
use crate::bvh::tree::{BLOCK, NO_PRIMITIVE};

/// Work that [`build`] advances its watch by.
pub(super) fn work(count: usize) -> usize {
    2 * count
}

/// Makes a tree quickly, with leaves of up to `leaf_size` primitives, but no more than a block:
/// primitives in a row along a curve through space are parted into leaves, leaves into the lowest
/// nodes, and the tree above these is split as any other. `None` when `watch` says so.
///
/// After Pantaleoni and Luebke 2010, "HLBVH: Hierarchical LBVH Construction for Real-Time Ray
/// Tracing of Dynamic Geometry", but with the lowest levels by cost instead of by bits of the curve.
pub(super) fn build(
    mut refs: Vec<PrimitiveRef>,
    leaf_size: u32,
    watch: &Watch<'_>,
) -> Option<Chunk> {
    let count = refs.len();
    let mut order = order(&refs);
    watch.advance(0)?;
    let leaves = runs(count, (leaf_size as usize).min(BLOCK), &|stretch| {
        let places = order[stretch].iter();
        places.map(|&place| refs[place as usize].bounds()).collect()
    });
    watch.advance(count / 2)?;
    let mut groups = runs(leaves.len(), WIDTH, &|stretch| {
        leaves[stretch].iter().map(PrimitiveRef::bounds).collect()
    });
    order
        .par_iter_mut()
        .for_each(|place| *place = refs[*place as usize].id().into());
    watch.advance(count - count / 2)?;
    let spare = &mut refs[..groups.len()];
    let range = Range::new(&mut groups, spare);
    let tree = wide::build(range, &Rule::groups(&leaves), Depth::default(), watch)?;
    let mut whole = Chunk::default();
    let root = whole.append(tree, 0);
    if whole.nodes.is_empty() {
        whole.nodes.push(WideNode::new(&[root], &[], 0));
    }
    let id = |place: u32| match place {
        NO_PRIMITIVE => place,
        _ => order[place as usize] as u32,
    };
    let blocks = whole.blocks.par_iter_mut().with_min_len(4096);
    blocks.for_each(|block| *block = block.map(id));
    Some(whole)
}

/// The places of `refs` along a curve through their centres.
fn order(refs: &[PrimitiveRef]) -> Vec<u64> {
    let curve = Curve::through(&Extents::of_many(refs).centers);
    // As much of the number on the curve as there is room beside the place.
    let place_bits = usize::BITS - refs.len().leading_zeros();
    let places = (1 << place_bits) - 1;
    let number = |place: u64| curve.number(refs[place as usize].center());
    let mut order: Vec<u64> = (0..refs.len() as u64)
        .into_par_iter()
        .map(|place| number(place) << 1 & !places | place)
        .collect();
    order.par_sort_unstable();
    // Many may lie together in a small part of the scene.
    order
        .par_chunk_by_mut(|a, b| a >> place_bits == b >> place_bits)
        .filter(|together| together.len() > 4 * BLOCK)
        .for_each(|together| {
            together.par_sort_by_cached_key(|&entry| {
                let place = entry & places;
                (number(place), place)
            });
        });
    order.par_iter_mut().for_each(|entry| *entry &= places);
    order
}
