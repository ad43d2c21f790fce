use rayon::prelude::*;

use super::binary::{self, BinaryNode};
use super::chunk::{Chunk, Subtree};
use super::optimal::{Choice, Chooser, DepthFirst, SERIAL};
use super::range::{Range, Rule};
use super::reinsert::Reinsertion;
use super::watch::Watch;
use crate::bvh::node::{Child, Part, WIDTH};

/// Binary trees deeper than this are given up: what follows descends by recursion.
const MOST_DEPTH: usize = 500;

/// How many of all nodes each round looks at, in thousandths: the largest first, alone, because most
/// is gained there, and what they block is free again in the next round.
const ROUNDS: [usize; 8] = [1, 10, 30, 100, 200, 30, 100, 200];

/// A round of many nodes that saves less than this fraction of the area is the last.
const LEAST_GAIN: f64 = 0.003;

/// Work that [`build`] advances its watch by.
pub(super) fn work(count: usize) -> usize {
    count * (2 + ROUNDS.len())
}

/// Makes the best tree over `range` with leaves of up to `leaf_size` primitives: split down to
/// single primitives, improved by reinsertion, and gathered into wide nodes at the least expected
/// cost. `None` when `watch` says so; `Some(None)` if the tree would become too deep.
pub(super) fn build(
    range: Range<'_>,
    leaf_size: u32,
    watch: &Watch<'_>,
) -> Option<Option<Subtree>> {
    let count = range.len();
    let mut nodes = vec![BinaryNode::EMPTY; 2 * count - 1];
    binary::build(range, &mut nodes, 0, (&Rule::single(), 0), watch)?;
    watch.advance(if count <= binary::SERIAL { count } else { 0 })?;
    let mut tree = Reinsertion::new(nodes);
    improve(&mut tree, count, watch)?;
    let tree = DepthFirst::new(&tree.into_nodes(), watch)?;
    if tree.depth > MOST_DEPTH {
        return Some(None);
    }
    let mut choices = vec![Choice::default(); tree.nodes.len()];
    let chooser = Chooser { leaf_size, watch };
    chooser.choose(&tree.nodes, &tree.counts, &mut choices);
    watch.advance(0)?;
    let emit = Emit {
        tree: &tree,
        choices: &choices,
        watch,
    };
    emit.subtree(0).map(Some)
}

fn improve(tree: &mut Reinsertion, count: usize, watch: &Watch<'_>) -> Option<()> {
    let mut area = tree.area();
    for (round, thousandths) in ROUNDS.into_iter().enumerate() {
        let saved = tree.improve(2 * count * thousandths / 1000 + 1, watch)?;
        watch.advance(count)?;
        if thousandths >= 100 && saved < LEAST_GAIN * area {
            return watch.advance(count * (ROUNDS.len() - 1 - round));
        }
        area -= saved;
    }
    Some(())
}

/// Makes wide nodes of a binary tree and the choices.
struct Emit<'a> {
    tree: &'a DepthFirst,
    choices: &'a [Choice],
    watch: &'a Watch<'a>,
}

/// The children of one wide node as indices of the binary tree, and what is between them.
#[derive(Default)]
struct Group {
    children: Vec<usize>,
    inner: Vec<[Part; 2]>,
}

impl Emit<'_> {
    /// The wide nodes from `node` on.
    fn subtree(&self, node: usize) -> Option<Subtree> {
        let count = self.tree.counts[node] as usize;
        if count <= SERIAL {
            let mut chunk = Chunk::with_capacity(count);
            let root = self.add(node, &mut chunk, 0);
            self.watch.advance(count)?;
            return Some(Subtree::Chunk { chunk, root });
        }
        let group = self.group(node);
        let children = group.children.into_par_iter();
        Some(Subtree::Inner {
            children: children
                .map(|child| self.subtree(child))
                .collect::<Option<_>>()?,
            inner: group.inner,
        })
    }

    /// Appends the tree from `node` on to `chunk`.
    fn add(&self, node: usize, chunk: &mut Chunk, parent: u32) -> Child {
        if self.choices[node].is_leaf {
            let all = node..node + 2 * self.tree.counts[node] as usize - 1;
            let leaves = self.tree.nodes[all].iter();
            let leaves = leaves.filter(|node| node.children().is_none());
            let bounds = self.tree.nodes[node].bounds();
            return chunk.add_leaf(leaves.map(BinaryNode::primitive), &bounds);
        }
        let index = chunk.begin_node();
        let group = self.group(node);
        let children: Vec<_> = (group.children.iter())
            .map(|&child| self.add(child, chunk, index))
            .collect();
        chunk.finish_node(index, &children, &group.inner, parent)
    }

    fn group(&self, node: usize) -> Group {
        let mut group = Group::default();
        self.open(node, self.choices[node].left_of_all(), WIDTH, &mut group);
        group
    }

    /// Adds what is below `node`, of which the left side gets `to_left` of `places`.
    fn open(&self, node: usize, to_left: usize, places: usize, group: &mut Group) -> Part {
        let index = group.inner.len();
        group.inner.push([0; 2]);
        let left = node + 1;
        let right = node + 2 * self.tree.counts[left] as usize;
        for (side, (child, places)) in [(left, to_left), (right, places - to_left)]
            .into_iter()
            .enumerate()
        {
            group.inner[index][side] = match self.choices[child].left(places) {
                Some((to_left, places)) => self.open(child, to_left, places, group),
                None => {
                    group.children.push(child);
                    group.children.len() as Part - 1
                }
            };
        }
        (WIDTH + index) as Part
    }
}
