use super::primitive::Bounds;
use crate::bvh::node::{Child, LEAF, Part, WideNode};
use crate::bvh::slab::padded;
use crate::bvh::tree::{BLOCK, LeafBlocks, NO_PRIMITIVE};

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

impl Chunk {
    /// Room for the tree over `count` primitives.
    pub(super) fn with_capacity(count: usize) -> Self {
        // Rarely fewer than these; freed as soon as the chunk is copied.
        Self {
            nodes: Vec::with_capacity(count / 12 + 1),
            blocks: Vec::with_capacity(count / 3 + 1),
        }
    }

    /// Appends a leaf.
    pub(super) fn add_leaf(&mut self, ids: impl Iterator<Item = u32>, bounds: &Bounds) -> Child {
        let first = self.blocks.len() as u32;
        let mut count = 0;
        for id in ids {
            if count % BLOCK == 0 {
                self.blocks.push([NO_PRIMITIVE; BLOCK]);
            }
            if let Some(block) = self.blocks.last_mut() {
                block[count % BLOCK] = id;
            }
            count += 1;
        }
        Child {
            // Padding grows with the box, so this box holds the padded boxes of all primitives.
            bounds: padded(bounds.aabb()),
            reference: LEAF | first,
            primitives: count as u32,
        }
    }

    /// Keeps the place of a wide node, for [`Self::finish_node`]; returns its index.
    pub(super) fn begin_node(&mut self) -> u32 {
        self.nodes.push(WideNode::EMPTY);
        self.nodes.len() as u32 - 1
    }

    /// Fills the place `index`; `inner` as in [`WideNode::new`].
    pub(super) fn finish_node(
        &mut self,
        index: u32,
        children: &[Child],
        inner: &[[Part; 2]],
        parent: u32,
    ) -> Child {
        self.nodes[index as usize] = WideNode::new(children, inner, parent);
        let bounds = children.iter().map(|child| child.bounds);
        Child {
            bounds: bounds
                .reduce(|a, b| a.union(b))
                .expect("a node has children"),
            reference: index,
            primitives: children.iter().map(|child| child.primitives).sum(),
        }
    }

    /// Appends a subtree below the wide node `parent`.
    pub(super) fn append(&mut self, subtree: Subtree, parent: u32) -> Child {
        let (subtrees, inner) = match subtree {
            Subtree::Chunk { chunk, root } => return self.append_chunk(chunk, root, parent),
            Subtree::Inner { children, inner } => (children, inner),
        };
        let index = self.begin_node();
        let mut children = Vec::with_capacity(subtrees.len());
        for subtree in subtrees {
            children.push(self.append(subtree, index));
        }
        self.finish_node(index, &children, &inner, parent)
    }

    fn append_chunk(&mut self, mut chunk: Self, root: Child, parent: u32) -> Child {
        let (first, first_block) = (self.nodes.len() as u32, self.blocks.len() as u32);
        let shifted = |reference: u32| match reference {
            leaf if leaf & LEAF != 0 => leaf + first_block,
            node => node + first,
        };
        for (i, node) in chunk.nodes.iter_mut().enumerate() {
            for child in node.children.iter_mut().filter(|child| **child != 0) {
                // No child is the first node of its chunk: 0 marks an empty slot.
                *child = shifted(*child);
            }
            node.parent = if i == 0 { parent } else { node.parent + first };
        }
        self.nodes.append(&mut chunk.nodes);
        self.blocks.append(&mut chunk.blocks);
        Child {
            reference: shifted(root.reference),
            ..root
        }
    }
}
