use glam::Vec4;

use super::node::{Child, Pair};

/// Children of one wide node.
pub(super) const WIDTH: usize = 4;

/// Up to four nodes of the binary tree side by side, for the traversal: one box test for all.
///
/// The boxes are those of the binary tree, so both trees meet the same leaves.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Wide {
    /// Minimum and maximum per axis, one lane per child.
    pub(super) planes: [[Vec4; 2]; 3],
    /// First slot (leaf) or index of the wide node that holds the children.
    pub(super) first: [u32; WIDTH],
    /// Primitives in the leaf; 0 for an inner node.
    pub(super) count: [u32; WIDTH],
}

impl Wide {
    fn new(children: &[Child; WIDTH]) -> Self {
        let lanes =
            |value: &dyn Fn(&Child) -> f32| Vec4::from_array(children.each_ref().map(value));
        Self {
            planes: [0, 1, 2].map(|axis| {
                [
                    lanes(&|c| c.bounds.min[axis]),
                    lanes(&|c| c.bounds.max[axis]),
                ]
            }),
            first: children.map(|c| c.first),
            count: children.map(|c| c.count),
        }
    }
}

/// Makes wide nodes, depth first, from the pairs of a tree whose first pair holds the root.
pub(super) fn collapse(pairs: &[Pair]) -> Vec<Wide> {
    let mut out = Vec::with_capacity(pairs.len() / 2 + 1);
    add(pairs, &[pairs[0].child(0)], &mut out);
    out.shrink_to_fit();
    out
}

/// Appends the wide node that starts with `children`, and everything below; returns its index.
fn add(pairs: &[Pair], children: &[Child], out: &mut Vec<Wide>) -> u32 {
    let mut node = [Child::NOWHERE; WIDTH];
    node[..children.len()].copy_from_slice(children);
    let mut used = children.len();
    // Open the largest inner child while there is room: rays meet it most often.
    while used < WIDTH {
        let inner = (0..used).filter(|&i| is_inner(&node[i]));
        let area = |i: &usize| node[*i].bounds.half_area();
        let Some(largest) = inner.max_by(|a, b| area(a).total_cmp(&area(b))) else {
            break;
        };
        let pair = &pairs[node[largest].first as usize];
        node[largest] = pair.child(0);
        node[used] = pair.child(1);
        used += 1;
    }
    let index = out.len();
    out.push(Wide::new(&node));
    for (lane, child) in node.iter().enumerate().filter(|(_, c)| is_inner(c)) {
        let pair = &pairs[child.first as usize];
        out[index].first[lane] = add(pairs, &[pair.child(0), pair.child(1)], out);
    }
    u32::try_from(index).expect("fewer wide nodes than primitives")
}

fn is_inner(child: &Child) -> bool {
    child.count == 0 && child.bounds.min.is_finite()
}

#[cfg(test)]
mod tests {
    use super::super::{Bvh, BvhKind, BvhSettings};
    use super::*;
    use crate::math::Aabb;
    use glam::Vec3;

    /// Depth of the deepest wide node, and slots of all leaves in order of the lanes.
    fn walk(nodes: &[Wide], index: usize, slots: &mut Vec<(u32, u32)>) -> usize {
        let node = &nodes[index];
        let mut below = 0;
        for lane in 0..WIDTH {
            let here = Vec3::from_array([0, 1, 2].map(|a| node.planes[a][0][lane]));
            match node.count[lane] {
                0 if here.is_finite() => {
                    below = below.max(1 + walk(nodes, node.first[lane] as usize, slots));
                }
                0 => {}
                count => slots.push((node.first[lane], count)),
            }
        }
        below
    }

    #[test]
    fn every_leaf_of_the_binary_tree_is_in_the_wide_tree_once() {
        assert_eq!(size_of::<Wide>(), 128);
        let boxes: Vec<_> = (0..1_000)
            .map(|i| {
                let v = Vec3::new((i % 7) as f32, (i % 31) as f32, i as f32 * 0.01);
                Aabb::from_points([v, v + Vec3::splat(0.5)])
            })
            .collect();
        for kind in [BvhKind::None, BvhKind::Median, BvhKind::Sah] {
            let bvh = Bvh::build(
                &boxes,
                &BvhSettings {
                    kind,
                    leaf_size: 3,
                    ..BvhSettings::default()
                },
            );
            let mut slots = Vec::new();
            let depth = walk(&collapse(bvh.pairs()), 0, &mut slots);
            assert!(depth <= bvh.stats().max_depth);
            slots.sort_unstable();
            assert_eq!(slots.len(), bvh.stats().leaves);
            let mut next = 0;
            for (first, count) in slots {
                assert_eq!(first, next);
                next += count;
            }
            assert_eq!(next, 1_000);
        }
    }
}
