use std::ops::Range;
use std::time::{Duration, Instant};

use super::node::{Child, Pair};
use super::wide::{Wide, collapse};
use crate::math::Aabb;

/// Names a node of one [`Bvh`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId(u32);

impl NodeId {
    fn new(pair: u32, side: u32) -> Self {
        Self(2 * pair + side)
    }

    fn pair(self) -> u32 {
        self.0 / 2
    }

    fn side(self) -> usize {
        (self.0 % 2) as usize
    }
}

/// A binary bounding volume hierarchy over boxes.
#[derive(Clone, Debug)]
pub struct Bvh {
    /// The root beside nothing, then the pairs of siblings, depth first, left before right.
    pairs: Vec<Pair>,
    wide: Vec<Wide>,
    order: Vec<u32>,
    excluded: usize,
    build_time: Duration,
}

impl Bvh {
    pub(super) fn from_parts(
        pairs: Vec<Pair>,
        order: Vec<u32>,
        excluded: usize,
        start: Instant,
    ) -> Self {
        Self {
            wide: collapse(&pairs),
            pairs,
            order,
            excluded,
            build_time: start.elapsed(),
        }
    }

    /// What the traversal walks.
    pub(super) fn wide(&self) -> &[Wide] {
        &self.wide
    }

    #[cfg(test)]
    pub(super) fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    fn node(&self, node: NodeId) -> Child {
        self.pairs[node.pair() as usize].child(node.side())
    }

    /// Ids of the primitives (indices of the boxes given to the build) in the order of the leaves.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Boxes that were empty or not finite and are not in the tree.
    pub fn excluded(&self) -> usize {
        self.excluded
    }

    /// Time that the build took.
    pub fn build_time(&self) -> Duration {
        self.build_time
    }

    /// Number of nodes, leaves included.
    pub fn node_count(&self) -> usize {
        if self.order.is_empty() {
            0
        } else {
            2 * self.pairs.len() - 1
        }
    }

    /// Memory of the nodes and of the order, in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.pairs.as_slice())
            + size_of_val(self.wide.as_slice())
            + size_of_val(self.order.as_slice())
    }

    /// The root; `None` if there is nothing in the tree.
    pub fn root(&self) -> Option<NodeId> {
        (!self.order.is_empty()).then(|| NodeId::new(0, 0))
    }

    /// The (padded) box of a node.
    pub fn bounds(&self, node: NodeId) -> Aabb {
        self.node(node).bounds
    }

    /// Left and right child; `None` for a leaf.
    pub fn children(&self, node: NodeId) -> Option<[NodeId; 2]> {
        let Child { first, count, .. } = self.node(node);
        (count == 0).then(|| [NodeId::new(first, 0), NodeId::new(first, 1)])
    }

    /// Slots in [`Self::order`] of all primitives below a node; they are contiguous.
    pub fn slots(&self, node: NodeId) -> Range<usize> {
        let leaf = |side: usize| {
            let mut at = node;
            while let Some(children) = self.children(at) {
                at = children[side];
            }
            self.node(at)
        };
        let (left, right) = (leaf(0), leaf(1));
        left.first as usize..(right.first + right.count) as usize
    }

    /// Ids of all primitives below a node.
    pub fn primitives(&self, node: NodeId) -> &[u32] {
        &self.order[self.slots(node)]
    }

    /// The nodes from the root to `node`, both included.
    pub fn path(&self, node: NodeId) -> Vec<NodeId> {
        let mut path: Vec<_> = self.root().into_iter().collect();
        while let Some(&last) = path.last()
            && last != node
            && let Some([left, right]) = self.children(last)
        {
            path.push(if left.pair() == node.pair() {
                node
            } else {
                // Depth first: the pairs below the right child follow all those below the left.
                match self.children(right) {
                    Some([first, _]) if node.pair() >= first.pair() => right,
                    _ => left,
                }
            });
        }
        path
    }

    /// The node above; `None` for the root.
    pub fn parent(&self, node: NodeId) -> Option<NodeId> {
        self.path(node).into_iter().rev().nth(1)
    }

    /// Number of nodes above.
    pub fn depth(&self, node: NodeId) -> usize {
        self.path(node).len() - 1
    }
}
