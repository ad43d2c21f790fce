use super::node::{Child, LEAF, Part, WIDTH, WideNode};
use super::pair::{BinaryNode, Pair};
use super::tree::{BLOCK, LeafBlocks, NO_PRIMITIVE};

/// Makes wide nodes, depth first, from the pairs of a binary tree whose first pair holds the root,
/// and blocks from the `order` of its leaves.
pub(super) fn collapse(pairs: &[Pair], order: &[u32]) -> (Vec<WideNode>, LeafBlocks) {
    let mut collapse = Collapse {
        pairs,
        order,
        nodes: Vec::with_capacity(pairs.len() / 4 + 1),
        blocks: Vec::with_capacity(order.len() / 2 + 1),
    };
    if !order.is_empty() {
        collapse.add(&pairs[0].child(0), 0);
    }
    collapse.nodes.shrink_to_fit();
    collapse.blocks.shrink_to_fit();
    (collapse.nodes, collapse.blocks)
}

struct Collapse<'a> {
    pairs: &'a [Pair],
    order: &'a [u32],
    nodes: Vec<WideNode>,
    blocks: LeafBlocks,
}

/// The binary tree inside one wide node, left to right.
#[derive(Default)]
struct Group {
    children: Vec<BinaryNode>,
    inner: Vec<[Part; 2]>,
}

impl Group {
    /// Adds the binary tree at `node`, of which `opened` are the inner nodes.
    fn add(&mut self, pairs: &[Pair], node: &BinaryNode, opened: &[u32]) -> Part {
        if node.count > 0 || !opened.contains(&node.first) {
            self.children.push(*node);
            return self.children.len() as Part - 1;
        }
        let index = self.inner.len();
        self.inner.push([0; 2]);
        let pair = &pairs[node.first as usize];
        self.inner[index] = [0, 1].map(|side| self.add(pairs, &pair.child(side), opened));
        (WIDTH + index) as Part
    }
}

impl Collapse<'_> {
    /// Appends the wide node that starts with `top`, and everything below; returns its index.
    fn add(&mut self, top: &BinaryNode, parent: u32) -> u32 {
        let mut group = Group::default();
        group.add(self.pairs, top, &self.opened(top));
        let index = self.nodes.len();
        self.nodes.push(WideNode::EMPTY);
        let at = u32::try_from(index).expect("fewer wide nodes than primitives");
        let children: Vec<_> = group
            .children
            .iter()
            .map(|child| {
                let (reference, primitives) = if child.count > 0 {
                    (LEAF | self.add_leaf(child), child.count)
                } else {
                    let below = self.add(child, at);
                    (below, self.nodes[below as usize].primitives() as u32)
                };
                Child {
                    bounds: child.bounds,
                    reference,
                    primitives,
                }
            })
            .collect();
        self.nodes[index] = WideNode::new(&children, &group.inner, parent);
        at
    }

    /// The pairs that become inner nodes of the wide node that starts with `top`: the largest
    /// inner child is opened while there is room, because rays meet it most often.
    fn opened(&self, top: &BinaryNode) -> Vec<u32> {
        let mut opened = Vec::with_capacity(WIDTH - 1);
        let mut open = vec![*top];
        while opened.len() + 1 < WIDTH {
            let inner = (0..open.len()).filter(|&i| open[i].count == 0);
            let area = |i: &usize| open[*i].bounds.half_area();
            let Some(largest) = inner.max_by(|a, b| area(a).total_cmp(&area(b))) else {
                break;
            };
            let pair = open.swap_remove(largest).first;
            opened.push(pair);
            open.extend([0, 1].map(|side| self.pairs[pair as usize].child(side)));
        }
        opened
    }

    fn add_leaf(&mut self, leaf: &BinaryNode) -> u32 {
        let first = self.blocks.len();
        let (begin, count) = (leaf.first as usize, leaf.count as usize);
        for ids in self.order[begin..begin + count].chunks(BLOCK) {
            let mut block = [NO_PRIMITIVE; BLOCK];
            block[..ids.len()].copy_from_slice(ids);
            self.blocks.push(block);
        }
        first as u32
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::super::{Bvh, BvhKind, BvhSettings};
    use super::*;
    use crate::math::Aabb;

    #[test]
    fn every_primitive_is_in_one_leaf_and_every_box_holds_its_children() {
        let boxes: Vec<_> = (0..1_000)
            .map(|i| {
                let v = Vec3::new((i % 7) as f32, (i % 31) as f32, i as f32 * 0.01);
                Aabb::from_points([v, v + Vec3::splat(0.5)])
            })
            .collect();
        for kind in [BvhKind::None, BvhKind::Median, BvhKind::Sah] {
            let settings = BvhSettings {
                kind,
                leaf_size: 3,
                ..BvhSettings::default()
            };
            let (bvh, blocks) = Bvh::build(&boxes, &settings);
            let mut ids: Vec<_> = blocks.iter().flatten().copied().collect();
            ids.retain(|&id| id != NO_PRIMITIVE);
            ids.sort_unstable();
            assert!(ids.iter().copied().eq(0..1_000));
            let mut open: Vec<_> = bvh.root().into_iter().collect();
            let (mut nodes, mut next_block) = (0, 0);
            while let Some(node) = open.pop() {
                nodes += 1;
                assert_eq!(bvh.path(node).last(), Some(&node));
                if let Some([left, right]) = bvh.children(node) {
                    let union = bvh.bounds(left).union(bvh.bounds(right));
                    assert_eq!(bvh.bounds(node), union);
                    assert_eq!(bvh.parent(left), Some(node));
                    assert_eq!(bvh.parent(right), Some(node));
                    let below = bvh.primitives_below(left) + bvh.primitives_below(right);
                    assert_eq!(bvh.primitives_below(node), below);
                    open.extend([right, left]);
                } else {
                    assert_eq!(bvh.blocks(node).start, next_block);
                    next_block = bvh.blocks(node).end;
                }
            }
            assert_eq!((nodes, next_block), (bvh.node_count(), blocks.len()));
        }
    }
}
