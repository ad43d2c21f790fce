use rayon::prelude::*;

use super::chunk::{Chunk, Subtree};
use super::family::Family;
use super::primitive::PrimitiveRef;
use super::range::{Depth, Range, Rule};
use super::watch::Watch;
use crate::bvh::node::{Child, Part, WIDTH};

/// Ranges up to this size are built by one thread.
const SERIAL: usize = 8192;

/// Builds the tree over `range`; `None` when `watch` says so.
pub(super) fn build(
    range: Range<'_>,
    rule: &Rule<'_>,
    depth: Depth,
    watch: &Watch<'_>,
) -> Option<Subtree> {
    let count = range.len();
    if count <= SERIAL || rule.is_leaf(count) {
        let primitives = range.refs.iter().map(|r| rule.primitives(r)).sum();
        let mut chunk = Chunk::with_capacity(primitives);
        let root = add(&mut chunk, range, rule, depth, 0);
        watch.advance(primitives)?;
        return Some(Subtree::Chunk { chunk, root });
    }
    watch.advance(0)?;
    let mut family = Family::of(range, rule, depth);
    let (order, inner) = family.left_to_right();
    let mut members = Vec::with_capacity(order.len());
    for place in order {
        let member = &mut family.members[place];
        members.push((member.range.take(), member.depth));
    }
    let children: Option<_> = members
        .into_par_iter()
        .map(|(range, binary)| {
            let wide = depth.wide + 1;
            build(range, rule, Depth { binary, wide }, watch)
        })
        .collect();
    Some(Subtree::Inner {
        children: children?,
        inner,
    })
}

/// Appends the tree over `range` to `chunk`.
fn add(chunk: &mut Chunk, range: Range<'_>, rule: &Rule<'_>, depth: Depth, parent: u32) -> Child {
    let mut family = Family::of(range, rule, depth);
    if family.inner.is_empty() {
        return add_leaf(chunk, &family.members[0].range, rule, parent);
    }
    let index = chunk.begin_node();
    let (order, inner) = family.left_to_right();
    let mut children = Vec::with_capacity(order.len());
    for place in order {
        let member = &mut family.members[place];
        let below = Depth {
            binary: member.depth,
            wide: depth.wide + 1,
        };
        children.push(if member.is_leaf {
            add_leaf(chunk, &member.range, rule, index)
        } else {
            add(chunk, member.range.take(), rule, below, index)
        });
    }
    chunk.finish_node(index, &children, &inner, parent)
}

fn add_leaf(chunk: &mut Chunk, range: &Range<'_>, rule: &Rule<'_>, parent: u32) -> Child {
    if let [group] = &*range.refs
        && let Some(runs) = rule.members(group)
    {
        return add_group(chunk, runs, parent);
    }
    let ids = range.refs.iter().flat_map(PrimitiveRef::ids);
    chunk.add_leaf(ids, &range.extents.bounds)
}

/// Appends a node with one leaf for each of up to eight runs; of a single one, the leaf alone.
fn add_group(chunk: &mut Chunk, runs: &[PrimitiveRef], parent: u32) -> Child {
    if let [run] = runs {
        return chunk.add_leaf(run.ids(), &run.bounds());
    }
    let index = chunk.begin_node();
    let mut inner = Vec::with_capacity(WIDTH - 1);
    halved(0, runs.len(), &mut inner);
    let leaves = runs
        .iter()
        .map(|run| chunk.add_leaf(run.ids(), &run.bounds()));
    let leaves: Vec<_> = leaves.collect();
    chunk.finish_node(index, &leaves, &inner, parent)
}

/// Adds the binary tree between `count` children from `first` on, as many on either side.
fn halved(first: usize, count: usize, inner: &mut Vec<[Part; 2]>) -> Part {
    if count == 1 {
        return first as Part;
    }
    let index = inner.len();
    inner.push([0; 2]);
    let left = count / 2;
    let left_part = halved(first, left, inner);
    let right_part = halved(first + left, count - left, inner);
    inner[index] = [left_part, right_part];
    (WIDTH + index) as Part
}
