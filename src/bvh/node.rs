use glam::Vec3;

use crate::math::Aabb;

/// Children of one node.
pub(super) const WIDTH: usize = 8;

/// Bit of a child reference that names a leaf; the rest is its first block.
pub(super) const LEAF: u32 = 1 << 31;

/// Nodes and blocks have numbers below this, so that the upper two bits of a reference tell nodes, leaves
/// and [`super::stack::DONE`] apart.
pub(super) const MOST: usize = 1 << 30;

/// A child on its way into a [`WideNode`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Child {
    /// Bounds of everything below.
    pub(super) bounds: Aabb,
    /// Index of the child's own wide node, or [`LEAF`] and the leaf's first block.
    pub(super) reference: u32,
    /// Primitives below.
    pub(super) primitives: u32,
}

/// Names a part of the binary tree that a wide node was made from: below [`WIDTH`] a child, from
/// there on an inner node.
pub(super) type Part = u8;

/// Up to eight nodes of a binary tree side by side, for the traversal, and the binary tree between
/// them, for everything else.
///
/// Children stand in slots such that a ray whose direction is negative on the axes of the bits of
/// an octant meets the child in slot s roughly in order of s XOR octant (Ylitie, Karras, Laine 2017,
/// "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", section 3.2).
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct WideNode {
    /// Per axis minimum and maximum, one lane per slot; the minimum of an empty slot is infinite
    /// and lies beyond its maximum.
    pub(super) planes: [[[f32; WIDTH]; 2]; 3],
    /// References as in [`Child`]; 0 in empty slots.
    pub(super) children: [u32; WIDTH],
    /// The wide node above; its own index at the root.
    pub(super) parent: u32,
    /// Primitives below.
    primitives: u32,
    /// Left and right of each inner node of the binary tree; the first is the node itself.
    inner: [[Part; 2]; WIDTH - 1],
    /// Number of inner nodes in use; 0 in a tree that is one leaf.
    inner_count: u8,
    /// Primitives in the leaves; 0 in slots that hold no leaf, and in a tree that is one leaf.
    leaf_primitives: [u8; WIDTH],
}

impl WideNode {
    /// A node without children.
    pub(super) const EMPTY: Self = Self {
        planes: [[[f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]]; 3],
        children: [0; WIDTH],
        parent: 0,
        primitives: 0,
        inner: [[0; 2]; WIDTH - 1],
        inner_count: 0,
        leaf_primitives: [0; WIDTH],
    };

    /// Makes a node of `children` (1 to 8) and of the binary tree between them: `inner[0]` is its
    /// root; parts below 8 are indices into `children`, part 8 + i is `inner[i]`, with a larger
    /// index than its parent's. Blocks must be numbered left to right.
    pub(super) fn new(children: &[Child], inner: &[[Part; 2]], parent: u32) -> Self {
        debug_assert!(inner.len() + 1 == children.len());
        let slots = slots(children);
        let mut node = Self {
            parent,
            primitives: children.iter().map(|c| c.primitives).sum(),
            inner_count: inner.len() as u8,
            ..Self::EMPTY
        };
        for (child, slot) in children.iter().zip(slots) {
            node.set_bounds(slot, child.bounds);
            node.children[slot] = child.reference;
            if child.reference & LEAF != 0 && !inner.is_empty() {
                node.leaf_primitives[slot] =
                    u8::try_from(child.primitives).expect("leaves are small");
            }
        }
        for (to, from) in node.inner.iter_mut().zip(inner) {
            *to = from.map(|part| slots.get(part as usize).map_or(part, |&slot| slot as Part));
        }
        node
    }

    /// The part that is the node itself.
    pub(super) fn top(&self) -> Part {
        if self.inner_count > 0 {
            WIDTH as Part
        } else {
            self.occupied()
        }
    }

    /// The only slot in use of a tree that is one leaf.
    fn occupied(&self) -> Part {
        let is_used = |slot: &usize| self.children[*slot] != 0;
        (0..WIDTH).find(is_used).unwrap_or(0) as Part
    }

    /// The inner nodes of the binary tree, from the top.
    pub(super) fn inner_count(&self) -> usize {
        self.inner_count.into()
    }

    /// Left and right of an inner part, `None` of a child.
    pub(super) fn halves(&self, part: Part) -> Option<[Part; 2]> {
        let index = (part as usize).checked_sub(WIDTH)?;
        Some(self.inner[index])
    }

    /// Bounds of a part.
    pub(super) fn bounds(&self, part: Part) -> Aabb {
        match self.halves(part) {
            Some([left, right]) => self.bounds(left).union(self.bounds(right)),
            None => {
                let corner = |side: usize| {
                    Vec3::from_array([0, 1, 2].map(|a| self.planes[a][side][part as usize]))
                };
                Aabb {
                    min: corner(0),
                    max: corner(1),
                }
            }
        }
    }

    /// Replaces the bounds of the child in `slot`.
    pub(super) fn set_bounds(&mut self, slot: usize, bounds: Aabb) {
        for (axis, planes) in self.planes.iter_mut().enumerate() {
            planes[0][slot] = bounds.min[axis];
            planes[1][slot] = bounds.max[axis];
        }
    }

    /// Primitives below.
    pub(super) fn primitives(&self) -> usize {
        self.primitives as usize
    }

    /// Primitives of the leaf in `slot`.
    pub(super) fn leaf_primitives(&self, slot: Part) -> usize {
        match self.leaf_primitives[slot as usize] {
            0 => self.primitives(),
            count => count.into(),
        }
    }
}

/// For each child its slot: greedily, the child that lies farthest out in the direction of a corner
/// of the node gets the slot of that corner.
fn slots(children: &[Child]) -> [usize; WIDTH] {
    let bounds = children.iter().fold(Aabb::EMPTY, |b, c| b.union(c.bounds));
    let middle = bounds.center();
    let mut out = [[f32::NEG_INFINITY; WIDTH]; WIDTH];
    for (row, child) in out.iter_mut().zip(children) {
        let v = child.bounds.center() - middle;
        for (slot, out) in row.iter_mut().enumerate() {
            let toward = |axis: usize| {
                if slot >> axis & 1 == 1 {
                    v[axis]
                } else {
                    -v[axis]
                }
            };
            // Numbers too large to subtract must still leave an order.
            let sum = toward(0) + toward(1) + toward(2);
            *out = if sum.is_nan() {
                f32::MIN
            } else {
                sum.max(f32::MIN)
            };
        }
    }
    let mut slots = [WIDTH; WIDTH];
    let mut best = [(f32::NEG_INFINITY, WIDTH); WIDTH];
    for (best, row) in best.iter_mut().zip(&out).take(children.len()) {
        *best = largest(row);
    }
    for _ in 0..children.len() {
        let (child, &(_, slot)) = (best.iter().enumerate())
            .reduce(|a, b| if b.1.0 > a.1.0 { b } else { a })
            .expect("eight rows");
        slots[child] = slot;
        best[child].0 = f32::NEG_INFINITY;
        for (i, row) in out.iter_mut().enumerate().take(children.len()) {
            row[slot] = f32::NEG_INFINITY;
            if best[i].1 == slot && slots[i] == WIDTH {
                best[i] = largest(row);
            }
        }
    }
    slots
}

/// The largest number and its place, the first of several.
fn largest(row: &[f32; WIDTH]) -> (f32, usize) {
    let mut best = (f32::NEG_INFINITY, 0);
    for (place, &value) in row.iter().enumerate() {
        if value > best.0 {
            best = (value, place);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    fn child(x: f32, y: f32, z: f32, reference: u32) -> Child {
        let v = Vec3::new(x, y, z);
        Child {
            bounds: Aabb::from_points([v, v + Vec3::splat(0.5)]),
            reference,
            primitives: 3,
        }
    }

    #[test]
    fn eight_corners_stand_in_the_slots_of_their_octants() {
        assert_eq!(size_of::<WideNode>(), 256);
        let children: Vec<_> = (0..8)
            .map(|i| child((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32, i))
            .collect();
        let inner = [[0, 9], [1, 10], [2, 11], [3, 12], [4, 13], [5, 14], [6, 7]];
        let node = WideNode::new(&children, &inner, 5);
        assert_eq!(node.children, [0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!((node.primitives(), node.parent, node.top()), (24, 5, 8));
        assert_eq!(node.bounds(8).max, Vec3::splat(1.5));
        assert_eq!(node.halves(8), Some([0, 9]));
        assert_eq!(node.halves(3), None);
    }

    #[test]
    fn parts_follow_their_children_into_the_slots() {
        let children = [child(1.0, 1.0, 1.0, LEAF | 7), child(0.0, 0.0, 0.0, 4)];
        let node = WideNode::new(&children, &[[0, 1]], 0);
        let [left, right] = node.halves(node.top()).expect("two children");
        assert_eq!(node.children[left as usize], LEAF | 7);
        assert_eq!(node.leaf_primitives(left), 3);
        assert_eq!(node.bounds(right), children[1].bounds);
        assert_eq!(node.bounds(node.top()).min, Vec3::ZERO);
    }

    #[test]
    fn a_tree_of_one_leaf_may_hold_any_number() {
        let mut only = child(1.0, 2.0, 3.0, LEAF);
        only.primitives = 1_000_000;
        let node = WideNode::new(&[only], &[], 0);
        assert_eq!(node.halves(node.top()), None);
        assert_eq!(node.leaf_primitives(node.top()), 1_000_000);
        assert_eq!(node.bounds(node.top()), only.bounds);
    }
}
