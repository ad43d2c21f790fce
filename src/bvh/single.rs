use super::leaves::{Leaves, Work};
use super::node::LEAF;
use super::simd::{Kernel, NodeTest};
use super::slab::SlabRay;
use super::stack::{DONE, Stack, stack_size};
use super::tree::Bvh;
use crate::math::Ray;

/// One ray after the other. For a few rays, and for scenes of a few nodes.
#[derive(Debug)]
pub(super) struct Single<'a, L, F, const ANY: bool> {
    pub(super) bvh: &'a Bvh,
    pub(super) leaves: &'a L,
    pub(super) rays: &'a [Ray],
    /// Takes the number of a ray and its answer; `None` if the ray can meet nothing.
    pub(super) answer: F,
}

impl<L: Leaves, F: FnMut(usize, Option<&L::Query>), const ANY: bool> Kernel
    for Single<'_, L, F, ANY>
{
    type Answer = Work;

    #[inline(always)]
    fn run<N: NodeTest>(mut self) -> Work {
        let mut work = Work::default();
        let size = stack_size(self.bvh);
        let (mut references, mut near) = (vec![0; size], vec![0.0; size]);
        let mut stack = Stack::new(&mut references, &mut near);
        for (i, ray) in self.rays.iter().enumerate() {
            let Some(slab) = SlabRay::new(ray) else {
                (self.answer)(i, None);
                continue;
            };
            let mut query = self.leaves.query(ray, &slab);
            let octant = slab.octant();
            let mut limit = slab.t_max();
            let mut open = stack.clear();
            let mut at = 0;
            while at != DONE {
                if at & LEAF == 0 {
                    work.nodes += 1;
                    let node = &self.bvh.nodes()[at as usize];
                    let met = N::enter(node, &slab, limit);
                    open = stack.push::<N, ANY>(open, octant, met, &node.children);
                } else {
                    let (block, blocks) = (at & !LEAF, &mut work.blocks);
                    limit = self.leaves.visit::<ANY>(block, &slab, &mut query, blocks);
                    if limit == f32::NEG_INFINITY {
                        break;
                    }
                }
                (at, open) = stack.pop::<ANY>(open, limit);
            }
            (self.answer)(i, Some(&query));
        }
        work
    }
}
