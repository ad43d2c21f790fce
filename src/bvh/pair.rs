use glam::{Vec3, Vec4};

use crate::math::Aabb;

/// One node as the builder hands it to its parent.
#[derive(Clone, Copy, Debug)]
pub(super) struct BinaryNode {
    /// Bounds of everything below.
    pub(super) bounds: Aabb,
    /// First place in the order of the leaves (leaf), or index of the pair of children.
    pub(super) first: u32,
    /// Primitives in the leaf; 0 for an inner node.
    pub(super) count: u32,
}
impl BinaryNode {
    /// A box at infinity, which no ray meets.
    pub(super) const NOWHERE: Self = Self {
        bounds: Aabb {
            min: Vec3::INFINITY,
            max: Vec3::INFINITY,
        },
        first: 0,
        count: 0,
    };
}

/// Two sibling nodes of 32 bytes each, in one cache line.
///
/// Lanes of the planes: minimum of left and right, maximum of left and right.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Pair {
    planes: [Vec4; 3],
    first: [u32; 2],
    count: [u32; 2],
}

impl Pair {
    pub(super) fn new(left: BinaryNode, right: BinaryNode) -> Self {
        let (l, r) = (left.bounds, right.bounds);
        Self {
            planes: [0, 1, 2].map(|a| Vec4::new(l.min[a], r.min[a], l.max[a], r.max[a])),
            first: [left.first, right.first],
            count: [left.count, right.count],
        }
    }

    pub(super) fn child(&self, side: usize) -> BinaryNode {
        let [x, y, z] = self.planes;
        BinaryNode {
            bounds: Aabb {
                min: Vec3::new(x[side], y[side], z[side]),
                max: Vec3::new(x[side + 2], y[side + 2], z[side + 2]),
            },
            first: self.first[side],
            count: self.count[side],
        }
    }

    /// Adds `shift` to the pair indices of the inner nodes.
    pub(super) fn shifted(mut self, shift: u32) -> Self {
        for side in 0..2 {
            if self.count[side] == 0 {
                self.first[side] += shift;
            }
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pair_fills_one_cache_line_and_gives_its_children_back() {
        assert_eq!(size_of::<Pair>(), 64);
        let child = |v: f32, count| BinaryNode {
            bounds: Aabb::from_points([Vec3::splat(v), Vec3::new(v + 1.0, v + 2.0, v + 3.0)]),
            first: 7,
            count,
        };
        let pair = Pair::new(child(1.0, 0), child(5.0, 3)).shifted(10);
        assert_eq!(pair.child(0).bounds, child(1.0, 0).bounds);
        assert_eq!(pair.child(1).bounds, child(5.0, 0).bounds);
        assert_eq!(pair.first, [17, 7]);
    }
}
