use super::leaves::{Leaves, Work};
use super::node::LEAF;
use super::simd::{Kernel, NodeTest};
use super::slab::SlabRay;
use super::stack::{BOTTOM, DONE, Stack};
use super::tree::Bvh;
use crate::math::Ray;

/// One ray after the other. For a few rays, and for scenes of a few nodes.
#[derive(Debug)]
pub(super) struct Single<'a, L, F, const ANY: bool, const STACK: usize> {
    pub(super) bvh: &'a Bvh,
    pub(super) leaves: &'a L,
    pub(super) rays: &'a [Ray],
    /// Takes the number of a ray and its answer; `None` if the ray can meet nothing.
    pub(super) answer: F,
}

impl<L: Leaves, F: FnMut(usize, Option<&L::Query>), const ANY: bool, const STACK: usize> Kernel
    for Single<'_, L, F, ANY, STACK>
{
    type Answer = Work;

    #[inline(always)]
    fn run<N: NodeTest>(mut self) -> Work {
        let mut work = Work::default();
        let mut stack = Stack::<STACK>::EMPTY;
        for (i, ray) in self.rays.iter().enumerate() {
            let Some(slab) = SlabRay::new(ray) else {
                (self.answer)(i, None);
                continue;
            };
            let mut query = self.leaves.query(ray, &slab);
            let octant = slab.octant as usize;
            let mut limit = slab.t_max();
            let mut top = BOTTOM;
            let mut at = 0;
            while at != DONE {
                if at & LEAF == 0 {
                    work.nodes += 1;
                    let node = &self.bvh.nodes()[at as usize];
                    let met = N::enter(node, &slab, limit);
                    top = stack.push::<N, ANY>(top, octant, met, &node.children);
                } else {
                    let (block, blocks) = (at & !LEAF, &mut work.blocks);
                    let before = limit;
                    limit =
                        self.leaves
                            .visit::<N::Eight, ANY>(block, (ray, &slab), &mut query, blocks);
                    if limit == f32::NEG_INFINITY {
                        break;
                    }
                    if !ANY && limit < before {
                        top = stack.cull::<N>(top, limit);
                    }
                }
                (at, top) = stack.pop(top);
            }
            (self.answer)(i, Some(&query));
        }
        work
    }
}
