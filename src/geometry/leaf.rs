use super::block::{Block, TRIANGLES};
use super::quads::LeafPrimitives;
use super::triangle::{self, Shear};
use super::{Hit, Shapes, Sphere};
use crate::bvh::{BLOCK, Bvh, LeafBlocks, Leaves, NO_PRIMITIVE, SlabRay, padded};
use crate::math::{Aabb, Lanes, Ray, set_bits, take_lowest};

/// The primitives in the order of the leaves, with their vertices at hand.
#[derive(Clone, Debug)]
pub(super) struct LeafOrder {
    blocks: Vec<Block>,
    /// Ids from here on are spheres.
    first_sphere: u32,
    spheres: Vec<Sphere>,
}

impl LeafOrder {
    /// The leaves of `bvh` over `primitives`, of which `ids` are the numbers; they come to share
    /// blocks.
    pub(super) fn new(primitives: &LeafPrimitives<'_>, bvh: &mut Bvh, ids: &LeafBlocks) -> Self {
        let shapes = primitives.shapes();
        let ids = bvh.share_blocks(ids);
        let primitive = |id| (id != NO_PRIMITIVE).then(|| primitives.get(id));
        Self {
            blocks: bvh.map_blocks(&ids, |ids, more| {
                Block::new(shapes, ids.map(primitive), more)
            }),
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

    /// Number of quads in all leaves.
    pub(super) fn quads(&self) -> usize {
        let in_block = |block: &Block| (0..BLOCK).filter(|&place| block.is_quad(place)).count();
        self.blocks.iter().map(in_block).sum()
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
    /// The best hit so far.
    pub(super) hit: Hit,
}

impl Query {
    /// A ray with the best hit so far.
    #[inline(always)]
    pub(super) fn new(shear: Shear, hit: Hit) -> Self {
        Self { shear, hit }
    }

    /// Takes a hit if it is valid and better than the best so far.
    ///
    /// Every test depends on the primitive and the ray alone, so the result depends neither on the
    /// tree nor on the order of visits: the hit counts only if the ray meets the primitive's own
    /// box, and lies no nearer than that box.
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
        if t < slab.t_max() {
            self.take(Hit { t, ..hit });
        }
    }

    /// Keeps a valid hit if it is better than the best so far.
    #[inline(always)]
    fn take(&mut self, hit: Hit) {
        let best = &self.hit;
        if (hit.t < best.t) | ((hit.t == best.t) & (hit.primitive < best.primitive)) {
            self.hit = hit;
        }
    }

    #[cold]
    pub(super) fn spheres(&mut self, leaves: &LeafOrder, ray: (&Ray, &SlabRay), block: &Block) {
        for primitive in block.ids().filter(|&id| id >= leaves.first_sphere) {
            let sphere = leaves.spheres[(primitive - leaves.first_sphere) as usize];
            for t in sphere.meet(ray.0).into_iter().flatten() {
                let hit = Hit {
                    t,
                    primitive,
                    b1: 0.0,
                    b2: 0.0,
                };
                self.offer(ray.1, hit, &sphere.bounds());
            }
        }
    }

    /// The same as [`Self::offer`] for each triangle of a block that the ray meets.
    #[inline(always)]
    fn triangles<V: Lanes>(&mut self, (ray, slab): (&Ray, &SlabRay), block: &Block) {
        let (edges, first) = self.shear.edges::<V>(slab.origin(), block);
        let mut inside = V::bits(edges.inside());
        if inside == 0 {
            return;
        }
        // One of zero may be a rounding; where the others differ in sign it does not matter.
        let on_edge = V::bits(edges.on_edge()) & inside;
        if on_edge != 0 {
            inside &= !on_edge;
            self.triangles_on_edges((ray, slab), block, on_edge);
        }
        let [t, b1, b2] = self.shear.hits(&edges, first, block);
        let possible = t.gt(V::splat(slab.t_min()))
            & t.lt(V::splat(slab.t_max()))
            & t.le(V::splat(self.hit.t));
        let mut met = u64::from(inside & V::bits(possible));
        if met == 0 {
            return;
        }
        let (front, meets) = slab.enter_each_padded(block.bounds::<V>());
        let t = t.max(front);
        met &= u64::from(meets & V::bits(t.lt(V::splat(slab.t_max()))));
        let mut numbers = [[0.0; TRIANGLES]; 3];
        let [t_each, b1_each, b2_each] = &mut numbers;
        t.store(t_each);
        b1.store(b1_each);
        b2.store(b2_each);
        while met != 0 {
            let lane = take_lowest(&mut met) % TRIANGLES;
            self.take(Hit {
                t: t_each[lane],
                primitive: block.id(lane),
                b1: b1_each[lane],
                b2: b2_each[lane],
            });
        }
    }

    /// The triangles in `lanes`, one at a time with exact edge functions.
    #[cold]
    pub(super) fn triangles_on_edges(
        &mut self,
        (ray, slab): (&Ray, &SlabRay),
        block: &Block,
        lanes: u32,
    ) {
        for lane in set_bits(lanes) {
            let vertices = block.vertices(lane);
            if let Some(hit) = self.shear.meet(ray.origin, &vertices) {
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
    fn query(&self, ray: &Ray, slab: &SlabRay) -> Query {
        Query {
            shear: Shear::new(ray, slab.inverse_direction()),
            hit: Hit::MISS,
        }
    }

    #[inline(always)]
    fn visit<V: Lanes, const ANY: bool>(
        &self,
        first: u32,
        ray: (&Ray, &SlabRay),
        query: &mut Query,
        blocks: &mut u64,
    ) -> f32 {
        for block in &self.blocks[first as usize..] {
            *blocks += 1;
            query.triangles::<V>(ray, block);
            if !block.is_plain() && block.has_spheres() {
                query.spheres(self, ray, block);
            }
            if ANY && !query.hit.is_miss() {
                return f32::NEG_INFINITY;
            }
            if block.is_plain() || !block.has_more() {
                break;
            }
        }
        let end = ray.1.t_max();
        if query.hit.t < end { query.hit.t } else { end }
    }

    type Block = Block;

    #[inline(always)]
    fn blocks(&self) -> &[Block] {
        &self.blocks
    }
}
