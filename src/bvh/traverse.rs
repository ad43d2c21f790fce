use super::leaves::{Leaves, PacketAnswers, PacketLeaves, Work};
use super::packet::Packets;
use super::simd::dispatch;
use super::single::Single;
use super::stack::{DEEP, SHALLOW, is_enough};
use super::stream::Stream;
use super::tree::Bvh;
use crate::math::{Isa, Ray};

/// Batches up to this size are traced one ray after the other. (Not trees of few nodes: with one, two
/// or nine nodes and stacks of fixed size, many rays in flight are 1.1 to 1.3 times as fast for all
/// but shadow rays in a tree of one node.)
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
        if is_enough(SHALLOW, self.wide_depth()) {
            self.traverse_with::<ANY, SHALLOW, _>(isa, leaves, rays, answer)
        } else {
            self.traverse_with::<ANY, DEEP, _>(isa, leaves, rays, answer)
        }
    }

    fn traverse_with<const ANY: bool, const STACK: usize, L: Leaves>(
        &self,
        isa: Isa,
        leaves: &L,
        rays: &[Ray],
        answer: impl FnMut(usize, Option<&L::Query>),
    ) -> Work {
        assert!(
            is_enough(STACK, self.wide_depth()),
            "the build bounds the depth"
        );
        if rays.len() <= FEW_RAYS {
            let kernel = Single::<_, _, ANY, STACK> {
                bvh: self,
                leaves,
                rays,
                answer,
            };
            return dispatch(isa, kernel);
        }
        let kernel = Stream::<_, _, ANY, STACK> {
            bvh: self,
            leaves,
            rays,
            answer,
        };
        dispatch(isa, kernel)
    }

    /// The same as [`Self::traverse`] for closest hits and rays of which every
    /// [`PACKET`](super::PACKET) in a row take nearly the same way.
    pub fn traverse_coherent<L: PacketLeaves>(
        &self,
        isa: Isa,
        leaves: &L,
        rays: &[Ray],
        answers: &mut impl PacketAnswers<L>,
    ) -> Work {
        if self.nodes().is_empty() {
            return self.traverse::<false, L>(isa, leaves, rays, |i, query| answers.one(i, query));
        }
        let mut rest = Vec::new();
        let work = if is_enough(SHALLOW, self.wide_depth()) {
            self.packets::<SHALLOW, L>(isa, leaves, rays, (answers, &mut rest))
        } else {
            self.packets::<DEEP, L>(isa, leaves, rays, (answers, &mut rest))
        };
        let single: Vec<_> = rest.iter().map(|&i| rays[i as usize]).collect();
        let more = self.traverse::<false, L>(isa, leaves, &single, |i, query| {
            answers.one(rest[i] as usize, query);
        });
        Work {
            nodes: work.nodes + more.nodes,
            blocks: work.blocks + more.blocks,
        }
    }

    fn packets<const STACK: usize, L: PacketLeaves>(
        &self,
        isa: Isa,
        leaves: &L,
        rays: &[Ray],
        (answers, rest): (&mut impl PacketAnswers<L>, &mut Vec<u32>),
    ) -> Work {
        let packets = Packets::<_, _, STACK> {
            bvh: self,
            leaves,
            rays,
            answers,
            rest,
        };
        dispatch(isa, packets)
    }
}
