use super::leaves::{Leaves, PacketLeaves, Work};
use super::packet::Packets;
use super::simd::dispatch;
use super::single::Single;
use super::stream::Stream;
use super::tree::Bvh;
use crate::math::{Isa, Ray};

/// Batches up to this size are traced one ray after the other.
const FEW_RAYS: usize = 4;

impl Bvh {
    /// Leads `rays` through the tree, near boxes first, and shows `leaves` every leaf that they
    /// meet. `answer` takes the number of each ray and its query, `None` if the ray can meet
    /// nothing; in any order. `ANY`: until the first hit.
    pub fn traverse<const ANY: bool, L: Leaves>(
        &self,
        isa: Isa,
        leaves: &L,
        rays: &[Ray],
        mut answer: impl FnMut(usize, Option<&L::Query>),
    ) -> Work {
        if self.nodes().is_empty() {
            (0..rays.len()).for_each(|i| answer(i, None));
            return Work::default();
        }
        if rays.len() <= FEW_RAYS {
            return dispatch(
                isa,
                Single::<_, _, ANY> {
                    bvh: self,
                    leaves,
                    rays,
                    answer,
                },
            );
        }
        dispatch(
            isa,
            Stream::<_, _, ANY> {
                bvh: self,
                leaves,
                rays,
                answer,
            },
        )
    }

    /// The same as [`Self::traverse`] for closest hits and rays of which every sixteen in a row take
    /// nearly the same way.
    pub fn traverse_coherent<L: PacketLeaves>(
        &self,
        isa: Isa,
        leaves: &L,
        rays: &[Ray],
        mut answer: impl FnMut(usize, Option<&L::Query>),
    ) -> Work {
        if self.nodes().is_empty() {
            return self.traverse::<false, L>(isa, leaves, rays, answer);
        }
        let mut rest = Vec::new();
        let packets = Packets {
            bvh: self,
            leaves,
            rays,
            answer: &mut answer,
            rest: &mut rest,
        };
        let work = dispatch(isa, packets);
        let single: Vec<_> = rest.iter().map(|&i| rays[i as usize]).collect();
        let more = self.traverse::<false, L>(isa, leaves, &single, |i, query| {
            answer(rest[i] as usize, query);
        });
        Work {
            nodes: work.nodes + more.nodes,
            blocks: work.blocks + more.blocks,
        }
    }
}
