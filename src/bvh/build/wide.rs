use rayon::prelude::*;

use super::chunk::{Chunk, Subtree};
use super::family::Family;
use super::range::{Depth, Range, Rule};
use super::watch::Watch;
use crate::bvh::node::Child;

/// Ranges up to this size are built by one thread.
const SERIAL: usize = 8192;

/// Builds the tree over `range`; `None` when `watch` says so.
pub(super) fn build(
    range: Range<'_>,
    rule: &Rule,
    depth: Depth,
    watch: &Watch<'_>,
) -> Option<Subtree> {
    let count = range.len();
    if count <= SERIAL || rule.is_leaf(count) {
        let mut chunk = Chunk::with_capacity(count);
        let root = add(&mut chunk, range, rule, depth, 0);
        watch.advance(count)?;
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
fn add(chunk: &mut Chunk, range: Range<'_>, rule: &Rule, depth: Depth, parent: u32) -> Child {
    let mut family = Family::of(range, rule, depth);
    if family.inner.is_empty() {
        return add_leaf(chunk, &family.members[0].range);
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
            add_leaf(chunk, &member.range)
        } else {
            add(chunk, member.range.take(), rule, below, index)
        });
    }
    chunk.finish_node(index, &children, &inner, parent)
}

fn add_leaf(chunk: &mut Chunk, range: &Range<'_>) -> Child {
    let ids = range.refs.iter().map(|r| r.id());
    chunk.add_leaf(ids, &range.extents.bounds)
}
