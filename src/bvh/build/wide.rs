use rayon::prelude::*;

use super::family::Family;
use super::range::{Depth, Range, Rule};
use super::watch::Watch;
use crate::bvh::node::{Child, LEAF, Part, WideNode};
use crate::bvh::slab::padded;
use crate::bvh::tree::{BLOCK, LeafBlocks, NO_PRIMITIVE};

/// Ranges up to this size are built by one thread.
const SERIAL: usize = 8192;

/// Wide nodes and blocks that one thread makes, depth first; indices count from their own start.
#[derive(Debug, Default)]
pub(super) struct Chunk {
    pub(super) nodes: Vec<WideNode>,
    pub(super) blocks: LeafBlocks,
}

/// A subtree as a parallel build leaves it.
#[derive(Debug)]
pub(super) enum Subtree {
    Chunk {
        chunk: Chunk,
        root: Child,
    },
    /// A wide node above.
    Inner {
        children: Vec<Self>,
        inner: Vec<[Part; 2]>,
    },
}

/// Builds the tree over `range`; `None` when `watch` says so.
pub(super) fn build(
    range: Range<'_>,
    rule: &Rule,
    depth: Depth,
    watch: &Watch<'_>,
) -> Option<Subtree> {
    let count = range.len();
    if count <= SERIAL || rule.is_leaf(count) {
        // Rarely fewer than these; freed as soon as the chunk is copied.
        let mut chunk = Chunk {
            nodes: Vec::with_capacity(count / 12 + 1),
            blocks: Vec::with_capacity(count / 3 + 1),
        };
        let root = chunk.add(range, rule, depth, 0);
        watch.advance(count)?;
        return Some(Subtree::Chunk { chunk, root });
    }
    watch.advance(0)?;
    let mut family = Family::of(range, rule, depth);
    let (order, inner) = family.left_to_right();
    let mut members = Vec::with_capacity(order.len());
    for index in order {
        let member = &mut family.members[index];
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

impl Chunk {
    /// Appends the tree over `range`.
    fn add(&mut self, range: Range<'_>, rule: &Rule, depth: Depth, parent: u32) -> Child {
        let count = range.len();
        let mut family = Family::of(range, rule, depth);
        if family.inner.is_empty() {
            return self.add_leaf(&family.members[0].range);
        }
        let index = self.nodes.len();
        self.nodes.push(WideNode::EMPTY);
        let (order, inner) = family.left_to_right();
        let mut children = Vec::with_capacity(order.len());
        for place in order {
            let member = &mut family.members[place];
            let below = Depth {
                binary: member.depth,
                wide: depth.wide + 1,
            };
            children.push(if member.is_leaf {
                self.add_leaf(&member.range)
            } else {
                self.add(member.range.take(), rule, below, index as u32)
            });
        }
        self.nodes[index] = WideNode::new(&children, &inner, parent);
        let mut bounds = children[0].bounds;
        children[1..]
            .iter()
            .for_each(|c| bounds = bounds.union(c.bounds));
        Child {
            bounds,
            reference: index as u32,
            primitives: count as u32,
        }
    }

    fn add_leaf(&mut self, range: &Range<'_>) -> Child {
        let first = self.blocks.len() as u32;
        for refs in range.refs.chunks(BLOCK) {
            let mut block = [NO_PRIMITIVE; BLOCK];
            block.iter_mut().zip(refs).for_each(|(to, r)| *to = r.id());
            self.blocks.push(block);
        }
        Child {
            // Padding grows with the box, so this box holds the padded boxes of all primitives.
            bounds: padded(range.extents.bounds.aabb()),
            reference: LEAF | first,
            primitives: range.len() as u32,
        }
    }

    /// Appends `other` below the wide node `parent`.
    pub(super) fn append(&mut self, other: Self, root: Child, parent: u32) -> Child {
        let (first, first_block) = (self.nodes.len() as u32, self.blocks.len() as u32);
        let shifted = |reference: u32| match reference {
            0 => 0,
            leaf if leaf & LEAF != 0 => leaf + first_block,
            node => node + first,
        };
        for (i, mut node) in other.nodes.into_iter().enumerate() {
            node.children = node.children.map(shifted);
            node.parent = if i == 0 { parent } else { node.parent + first };
            self.nodes.push(node);
        }
        self.blocks.extend(other.blocks);
        let is_leaf = root.reference & LEAF != 0;
        Child {
            reference: root.reference + if is_leaf { first_block } else { first },
            ..root
        }
    }

    /// Appends a subtree below the wide node `parent`.
    pub(super) fn append_subtree(&mut self, subtree: Subtree, parent: u32) -> Child {
        let (subtrees, inner) = match subtree {
            Subtree::Chunk { chunk, root } => return self.append(chunk, root, parent),
            Subtree::Inner { children, inner } => (children, inner),
        };
        let index = self.nodes.len();
        self.nodes.push(WideNode::EMPTY);
        let children: Vec<_> = subtrees
            .into_iter()
            .map(|subtree| self.append_subtree(subtree, index as u32))
            .collect();
        self.nodes[index] = WideNode::new(&children, &inner, parent);
        let bounds = children.iter().map(|c| c.bounds);
        Child {
            bounds: bounds
                .reduce(|a, b| a.union(b))
                .expect("a family is not empty"),
            reference: index as u32,
            primitives: children.iter().map(|c| c.primitives).sum(),
        }
    }
}
