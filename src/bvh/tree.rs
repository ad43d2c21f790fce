use std::ops::Range;
use std::time::Duration;

use super::node::{LEAF, MOST, Part, WIDTH, WideNode};
use crate::math::Aabb;

/// Primitives of one block: a leaf is one or more blocks in a row.
pub const BLOCK: usize = 4;

/// The place of a block that holds no primitive.
pub const NO_PRIMITIVE: u32 = u32::MAX;

/// Names a node of one [`Bvh`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId {
    wide: u32,
    part: Part,
}

/// A bounding volume hierarchy over boxes.
///
/// Seen from outside it is a binary tree; the traversal walks up to eight of its nodes at a time.
#[derive(Clone, Debug)]
pub struct Bvh {
    /// The root comes first, every other node after its parent.
    nodes: Vec<WideNode>,
    blocks: usize,
    excluded: usize,
    build_time: Duration,
    /// Nodes above and including the deepest wide node.
    wide_depth: usize,
}

/// The ids of the primitives (indices of the boxes given to the build), block by block in the order
/// of the leaves, left to right. Unused places at the end of a leaf hold [`NO_PRIMITIVE`].
pub type LeafBlocks = Vec<[u32; BLOCK]>;

impl Bvh {
    /// `nodes` as in the field; a tree without primitives has no node.
    pub(super) fn new(
        nodes: Vec<WideNode>,
        blocks: usize,
        excluded: usize,
        build_time: Duration,
    ) -> Self {
        assert!(nodes.len() < MOST && blocks < MOST, "too many primitives");
        let mut depths = vec![1_u32; nodes.len()];
        for (i, node) in nodes.iter().enumerate().skip(1) {
            depths[i] = depths[node.parent as usize] + 1;
        }
        Self {
            wide_depth: depths.into_iter().max().unwrap_or(0) as usize,
            nodes,
            blocks,
            excluded,
            build_time,
        }
    }

    /// What the traversal walks.
    pub(super) fn nodes(&self) -> &[WideNode] {
        &self.nodes
    }

    pub(super) fn nodes_mut(&mut self) -> &mut [WideNode] {
        &mut self.nodes
    }

    /// Wide nodes from the root to the deepest one, both included.
    pub(super) fn wide_depth(&self) -> usize {
        self.wide_depth
    }

    /// Boxes that were empty or not finite and are not in the tree.
    pub fn excluded(&self) -> usize {
        self.excluded
    }

    /// Time that the build took.
    pub fn build_time(&self) -> Duration {
        self.build_time
    }

    /// Number of nodes of the binary tree, leaves included.
    pub fn node_count(&self) -> usize {
        let inner: usize = self.nodes.iter().map(WideNode::inner_count).sum();
        if self.nodes.is_empty() {
            0
        } else {
            2 * inner + 1
        }
    }

    /// Number of primitives.
    pub fn primitive_count(&self) -> usize {
        self.nodes.first().map_or(0, WideNode::primitives)
    }

    /// Number of blocks in all leaves.
    pub fn block_count(&self) -> usize {
        self.blocks
    }

    pub(super) fn set_block_count(&mut self, blocks: usize) {
        self.blocks = blocks;
    }

    /// Memory of the nodes, in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice())
    }

    /// The root; `None` if there is nothing in the tree.
    pub fn root(&self) -> Option<NodeId> {
        let part = self.nodes.first()?.top();
        Some(NodeId { wide: 0, part })
    }

    fn wide(&self, node: NodeId) -> &WideNode {
        &self.nodes[node.wide as usize]
    }

    /// `part` of wide node `wide`, or the wide node that it stands for.
    fn id(&self, wide: u32, part: Part) -> NodeId {
        let node = &self.nodes[wide as usize];
        match node.children.get(part as usize) {
            Some(&child) if child & LEAF == 0 => NodeId {
                wide: child,
                part: self.nodes[child as usize].top(),
            },
            _ => NodeId { wide, part },
        }
    }

    /// The (padded) box of a node.
    pub fn bounds(&self, node: NodeId) -> Aabb {
        self.wide(node).bounds(node.part)
    }

    /// Left and right child; `None` for a leaf.
    pub fn children(&self, node: NodeId) -> Option<[NodeId; 2]> {
        let halves = self.wide(node).halves(node.part)?;
        Some(halves.map(|part| self.id(node.wide, part)))
    }

    /// The leaf at the left (0) or right (1) end below a node.
    fn outermost(&self, node: NodeId, side: usize) -> NodeId {
        let mut at = node;
        while let Some(children) = self.children(at) {
            at = children[side];
        }
        at
    }

    /// Blocks of all leaves below a node; contiguous as long as leaves share none
    /// ([`Self::share_blocks`]).
    pub fn blocks(&self, node: NodeId) -> Range<usize> {
        let leaf = |side| {
            let leaf = self.outermost(node, side);
            let wide = self.wide(leaf);
            let first = (wide.children[leaf.part as usize] & !LEAF) as usize;
            (first, wide.leaf_primitives(leaf.part))
        };
        let ((first, _), (last, count)) = (leaf(0), leaf(1));
        first..last + count.div_ceil(BLOCK)
    }

    /// The leaves below a node, left to right: of each the places of its primitives. Place 4 b + l is
    /// lane l of block b.
    pub fn leaves(&self, node: NodeId) -> impl Iterator<Item = Range<usize>> + '_ {
        let mut open = vec![node];
        std::iter::from_fn(move || {
            while let Some(node) = open.pop() {
                match self.children(node) {
                    Some([left, right]) => open.extend([right, left]),
                    None => return Some(self.wide(node).places(node.part)),
                }
            }
            None
        })
    }

    /// Number of primitives below a node.
    pub fn primitives_below(&self, node: NodeId) -> usize {
        let wide = self.wide(node);
        if node.part == wide.top() {
            return wide.primitives();
        }
        match (
            wide.halves(node.part),
            wide.children.get(node.part as usize),
        ) {
            (Some(halves), _) => halves
                .into_iter()
                .map(|part| self.primitives_below(self.id(node.wide, part)))
                .sum(),
            (None, _) => wide.leaf_primitives(node.part),
        }
    }

    /// The node above; `None` for the root.
    pub fn parent(&self, node: NodeId) -> Option<NodeId> {
        let mut at = node;
        if at.part == self.wide(at).top() {
            if at.wide == 0 {
                return None;
            }
            let wide = self.wide(at).parent;
            let above = &self.nodes[wide as usize];
            let slot = (0..WIDTH).find(|&s| above.children[s] == at.wide)?;
            at = NodeId {
                wide,
                part: slot as Part,
            };
        }
        let wide = self.wide(at);
        let tops = WIDTH..WIDTH + wide.inner_count();
        tops.map(|part| part as Part)
            .find(|&part| wide.halves(part).is_some_and(|h| h.contains(&at.part)))
            .map(|part| NodeId {
                wide: at.wide,
                part,
            })
    }

    /// The nodes from the root to `node`, both included.
    pub fn path(&self, node: NodeId) -> Vec<NodeId> {
        let mut path: Vec<_> = std::iter::successors(Some(node), |&n| self.parent(n)).collect();
        path.reverse();
        path
    }

    /// Number of nodes above.
    pub fn depth(&self, node: NodeId) -> usize {
        self.path(node).len() - 1
    }
}
