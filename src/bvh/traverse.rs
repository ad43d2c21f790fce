use super::leaves::{Leaves, Work};
use super::simd::dispatch;
use super::single::Single;
use super::stack::{DEEP, SHALLOW, is_enough};
use super::stream::Stream;
use super::tree::Bvh;
use crate::math::{Isa, Ray};

/// Batches up to this size are traced one ray after the other.
const FEW_RAYS: usize = 4;

/// In trees up to this size too: so few steps do not repay the work of keeping many rays in flight.
/// One ray after the other is up to 1.5 times as fast with one node, 0.83 to 1.17 times with eleven.
const FEW_NODES: usize = 3;

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
        if rays.len() <= FEW_RAYS || self.nodes().len() <= FEW_NODES {
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
}
