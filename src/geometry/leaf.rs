use glam::Vec3;

use super::block::Block;
use super::triangle::{self, Shear};
use super::{Hit, Shapes, Sphere};
use crate::bvh::{BLOCK, Bvh, LeafBlocks, Leaves, SlabRay, padded, prefetch};
use crate::math::{Aabb, Ray};

/// The primitives in the order of the leaves, with their vertices at hand.
#[derive(Clone, Debug)]
pub(super) struct LeafOrder {
    blocks: Vec<Block>,
    /// Ids from here on are spheres.
    first_sphere: u32,
    spheres: Vec<Sphere>,
}

impl LeafOrder {
    pub(super) fn new(shapes: &Shapes, bvh: &Bvh, ids: &LeafBlocks) -> Self {
        Self {
            blocks: bvh.map_blocks(ids, |ids, more| Block::new(shapes, ids, more)),
            first_sphere: u32::try_from(shapes.triangles.len())
                .expect("the build checked the number"),
            spheres: shapes.spheres.clone(),
        }
    }

    /// Fits `bvh`, and the blocks, to `shapes` that have moved; returns what [`Bvh::refit`] does.
    pub(super) fn refit(&mut self, bvh: &mut Bvh, shapes: &Shapes) -> f64 {
        bvh.refit(&mut self.blocks, &|block: &mut Block| {
            block.renew(shapes, &|id| bounds(shapes, id))
        })
    }

    pub(super) fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.blocks.as_slice())
    }
}

/// The box of a primitive; empty if nothing can hit it.
pub(super) fn bounds(shapes: &Shapes, id: u32) -> Aabb {
    match shapes.sphere(id) {
        Some(sphere) => sphere.bounds(),
        None => triangle::bounds(&shapes.vertices(id as usize)),
    }
}

/// A ray among the primitives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Query {
    shear: Shear,
    direction: Vec3,
    /// The best hit so far.
    pub(super) hit: Hit,
}

impl Query {
    /// Takes a hit if it is valid and better than the best so far.
    ///
    /// Every test depends on the primitive and the ray alone, so the result depends neither on the
    /// tree nor on the order of visits: the hit counts only if the ray meets the primitive's own
    /// box, and lies no nearer than that box.
    #[inline]
    fn offer(&mut self, slab: &SlabRay, hit: Hit, bounds: &Aabb) {
        // Moving to the front of the box only ever enlarges t, and must not carry it past t_min.
        // A t that is NaN, from numbers too large for f32, fails here too.
        let possible = hit.t > slab.t_min() && hit.t < slab.t_max() && hit.t <= self.hit.t;
        if !possible {
            return;
        }
        let Some(front) = slab.enter(&padded(*bounds)) else {
            return;
        };
        let t = hit.t.max(front);
        let better = t < self.hit.t || t == self.hit.t && hit.primitive < self.hit.primitive;
        if t < slab.t_max() && better {
            self.hit = Hit { t, ..hit };
        }
    }

    #[cold]
    fn spheres(&mut self, leaves: &LeafOrder, slab: &SlabRay, block: &Block) {
        let ray = Ray::new(self.shear.origin, self.direction);
        for primitive in block.ids().filter(|&id| id >= leaves.first_sphere) {
            let sphere = leaves.spheres[(primitive - leaves.first_sphere) as usize];
            for t in sphere.meet(&ray).into_iter().flatten() {
                let hit = Hit {
                    t,
                    primitive,
                    b1: 0.0,
                    b2: 0.0,
                };
                self.offer(slab, hit, &sphere.bounds());
            }
        }
    }

    #[inline(always)]
    fn triangles(&mut self, slab: &SlabRay, block: &Block) {
        let edges = self.shear.edges(block);
        let mut inside = edges.inside();
        let on_edge = edges.on_edge();
        if on_edge != 0 {
            inside &= !on_edge;
            self.triangles_on_edges(slab, block, on_edge);
        }
        if inside == 0 {
            return;
        }
        let (t, b1, b2) = self.shear.hits(&edges);
        let (t, b1, b2) = (t.to_array(), b1.to_array(), b2.to_array());
        while inside != 0 {
            let lane = inside.trailing_zeros() as usize % BLOCK;
            inside &= inside - 1;
            if t[lane] > slab.t_min() && t[lane] < slab.t_max() && t[lane] <= self.hit.t {
                let hit = Hit {
                    t: t[lane],
                    primitive: block.id(lane),
                    b1: b1[lane],
                    b2: b2[lane],
                };
                let bounds = Aabb::from_points(block.vertices(lane));
                self.offer(slab, hit, &bounds);
            }
        }
    }

    /// The triangles in `lanes`, one at a time with exact edge functions.
    #[cold]
    fn triangles_on_edges(&mut self, slab: &SlabRay, block: &Block, lanes: u32) {
        for lane in (0..BLOCK).filter(|lane| lanes >> lane & 1 == 1) {
            let vertices = block.vertices(lane);
            if let Some(hit) = self.shear.meet(&vertices) {
                let hit = Hit {
                    t: hit.t,
                    primitive: block.id(lane),
                    b1: hit.b1,
                    b2: hit.b2,
                };
                self.offer(slab, hit, &Aabb::from_points(vertices));
            }
        }
    }
}

impl Leaves for LeafOrder {
    type Query = Query;

    #[inline(always)]
    fn query(&self, ray: &Ray, _: &SlabRay) -> Query {
        Query {
            shear: Shear::new(ray),
            direction: ray.direction,
            hit: Hit::MISS,
        }
    }

    #[inline(always)]
    fn visit<const ANY: bool>(
        &self,
        first: u32,
        slab: &SlabRay,
        query: &mut Query,
        blocks: &mut u64,
    ) -> f32 {
        for block in &self.blocks[first as usize..] {
            *blocks += 1;
            query.triangles(slab, block);
            if !block.is_plain() && block.has_spheres() {
                query.spheres(self, slab, block);
            }
            if ANY && !query.hit.is_miss() {
                return f32::NEG_INFINITY;
            }
            if block.is_plain() || !block.has_more() {
                break;
            }
        }
        query.hit.t.min(slab.t_max())
    }

    #[inline(always)]
    fn prefetch(&self, block: u32) {
        if let Some(block) = self.blocks.get(block as usize) {
            prefetch(block);
        }
    }
}
