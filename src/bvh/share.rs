use std::ops::Range;

use super::node::{LEAF, Part, WIDTH, WideNode};
use super::tree::{BLOCK, Bvh, LeafBlocks, NO_PRIMITIVE};

impl Bvh {
    /// Lets the leaves of a wide node that are shorter than a block share blocks, each with a box of
    /// its own; returns the blocks that take the place of `ids`. Rays that meet one of these leaves
    /// test the others with it, which costs nothing; the blocks come to be nearly full.
    ///
    /// # Panics
    /// If there are fewer blocks than in the tree.
    pub fn share_blocks(&mut self, ids: &LeafBlocks) -> LeafBlocks {
        let mut shared = LeafBlocks::with_capacity(ids.len());
        for node in self.nodes_mut() {
            node.share(ids, &mut shared);
        }
        self.set_block_count(shared.len());
        shared
    }
}

impl WideNode {
    /// Moves the blocks of the leaves from `from` to the end of `to`.
    fn share(&mut self, from: &LeafBlocks, to: &mut LeafBlocks) {
        let counts = self.leaf_counts();
        let mut short = [0_u8; BLOCK];
        for (slot, &count) in counts.iter().enumerate() {
            if (1..BLOCK).contains(&count) {
                short[count] |= 1 << slot;
            } else if count > 0 {
                let first = (self.children[slot] & !LEAF) as usize;
                self.children[slot] = LEAF | to.len() as u32;
                to.extend_from_slice(&from[first..first + count.div_ceil(BLOCK)]);
            }
        }
        // The longest first: those that fit beside them are found later.
        let first = to.len();
        for count in (1..BLOCK).rev() {
            while short[count] != 0 {
                let slot = short[count].trailing_zeros() as usize % WIDTH;
                short[count] &= short[count] - 1;
                let ids = from[(self.children[slot] & !LEAF) as usize];
                let has_room = |block: &[u32; BLOCK]| block[BLOCK - count] == NO_PRIMITIVE;
                let place = to[first..].iter().position(has_room);
                let place = first + place.unwrap_or(to.len() - first);
                if place == to.len() {
                    to.push([NO_PRIMITIVE; BLOCK]);
                }
                let lane = to[place].iter().position(|&id| id == NO_PRIMITIVE);
                let lane = lane.expect("there is room");
                to[place][lane..lane + count].copy_from_slice(&ids[..count]);
                self.children[slot] = LEAF | place as u32;
            }
        }
    }

    /// Primitives of the leaf in each slot; 0 without one.
    fn leaf_counts(&self) -> [usize; WIDTH] {
        let mut counts = [0; WIDTH];
        for (slot, count) in counts.iter_mut().enumerate() {
            if self.children[slot] & LEAF != 0 {
                *count = self.leaf_primitives(slot as Part);
            }
        }
        counts
    }

    /// The places of the primitives of the leaf in `slot`: place 4 b + l is lane l of block b.
    pub(super) fn places(&self, slot: Part) -> Range<usize> {
        let slot = slot as usize;
        let counts = self.leaf_counts();
        let is_before = |&other: &usize| {
            let is_longer = counts[other] > counts[slot];
            let is_as_long = counts[other] == counts[slot];
            self.children[other] == self.children[slot] && (is_longer || is_as_long && other < slot)
        };
        let lane: usize = (0..WIDTH).filter(is_before).map(|s| counts[s]).sum();
        let first = (self.children[slot] & !LEAF) as usize * BLOCK + lane;
        first..first + counts[slot]
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::super::{BvhQuality, BvhSettings};
    use super::*;
    use crate::math::Aabb;

    /// Pairs of flat boxes far apart, as the walls of houses.
    fn walls(count: u16) -> Vec<Aabb> {
        let place = |i: u16| f32::from(i / 2) * 79.0 % 1000.0;
        let boxes = (0..count).map(|i| {
            let corner = Vec3::new(place(i), place(i / 3), f32::from(i % 6));
            Aabb::from_points([corner, corner + Vec3::new(0.5, 0.0, 0.5)])
        });
        boxes.collect()
    }

    /// The ids of each leaf, left to right.
    fn leaves(bvh: &Bvh, blocks: &LeafBlocks) -> Vec<Vec<u32>> {
        let root = bvh.root().expect("not empty");
        let ids = blocks.as_flattened();
        bvh.leaves(root)
            .map(|places| ids[places].to_vec())
            .collect()
    }

    #[test]
    fn leaves_that_share_blocks_keep_their_primitives() {
        for quality in [BvhQuality::Fast, BvhQuality::Standard, BvhQuality::High] {
            for (leaf_size, count) in [(1, 300), (4, 1), (4, 3), (4, 5000), (7, 500)] {
                let settings = BvhSettings {
                    quality,
                    leaf_size,
                    ..BvhSettings::default()
                };
                let (mut bvh, ids) = Bvh::build(&walls(count), &settings);
                let before = leaves(&bvh, &ids);
                let visits = bvh.expected_visits();
                let shared = bvh.share_blocks(&ids);
                assert_eq!(leaves(&bvh, &shared), before);
                assert_eq!(bvh.block_count(), shared.len());
                assert_eq!(bvh.expected_visits(), visits);
                let used = |blocks: &LeafBlocks| {
                    let places = blocks.as_flattened().iter();
                    places.filter(|&&id| id != NO_PRIMITIVE).count()
                };
                assert_eq!(used(&shared), usize::from(count));
                assert!(leaf_size > 1 || shared.len() * 2 < ids.len());
            }
        }
    }
}
