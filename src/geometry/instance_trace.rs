use super::instances::InstanceBlock;
use super::{Hit, Instances, TraceCounts};
use crate::bvh::{BLOCK, Leaves, SlabRay, Work};
use crate::math::{Isa, Lanes, Ray};

/// Batches up to this size are traced an instance of a ray at a time.
const FEW_RAYS: usize = 4;

/// The hierarchy over the instances as rays see it.
#[derive(Clone, Copy, Debug)]
struct Walk<'a> {
    instances: &'a Instances,
    isa: Isa,
}

/// A ray among the instances.
#[derive(Clone, Copy, Debug)]
struct Query {
    /// The best hit so far.
    hit: Hit,
    /// Work in the trees of the meshes.
    work: Work,
}

impl Instances {
    /// Puts the hits with instances in the place of those of `hits` that lie behind them.
    pub(super) fn closest_hit(
        &self,
        isa: Isa,
        rays: &[Ray],
        hits: &mut [Hit],
        counts: &mut TraceCounts,
    ) {
        // What instances have in common with `hits` has a larger id, so it must lie nearer.
        let limited = |(ray, hit): (&Ray, &Hit)| Ray {
            t_max: ray.t_max.min(hit.t),
            ..*ray
        };
        let limited: Vec<Ray> = rays.iter().zip(hits.iter()).map(limited).collect();
        self.trace::<false>(isa, &limited, counts, |i, hit| hits[i] = hit);
    }

    /// Tells for the rays that are not occluded yet whether an instance lies on them.
    pub(super) fn any_hit(
        &self,
        isa: Isa,
        rays: &[Ray],
        occluded: &mut [bool],
        counts: &mut TraceCounts,
    ) {
        let open: Vec<usize> = (0..rays.len()).filter(|&i| !occluded[i]).collect();
        let rays: Vec<Ray> = open.iter().map(|&i| rays[i]).collect();
        self.trace::<true>(isa, &rays, counts, |i, _| occluded[open[i]] = true);
    }

    /// Gives the number of each ray that meets an instance, and its hit, to `met`.
    fn trace<const ANY: bool>(
        &self,
        isa: Isa,
        rays: &[Ray],
        counts: &mut TraceCounts,
        met: impl FnMut(usize, Hit),
    ) {
        let work = if rays.len() <= FEW_RAYS {
            self.walk::<ANY>(isa, rays, met)
        } else {
            self.trace_batch::<ANY>(isa, rays, met)
        };
        counts.box_tests += work.nodes * 8;
        counts.primitive_tests += work.blocks * BLOCK as u64;
    }

    /// The same, an instance of a ray at a time; returns the work, in which boxes of instances count
    /// as primitives.
    pub(super) fn walk<const ANY: bool>(
        &self,
        isa: Isa,
        rays: &[Ray],
        mut met: impl FnMut(usize, Hit),
    ) -> Work {
        let walk = Walk {
            instances: self,
            isa,
        };
        let mut inside = Work::default();
        let top = self.bvh().traverse::<ANY, _>(isa, &walk, rays, |i, query| {
            let Some(query) = query else { return };
            inside.nodes += query.work.nodes;
            inside.blocks += query.work.blocks;
            if !query.hit.is_miss() {
                met(i, query.hit);
            }
        });
        Work {
            nodes: top.nodes + inside.nodes,
            blocks: top.blocks + inside.blocks,
        }
    }

    /// `ray` in the space of the mesh of instance `number`, as far as a hit there may be better than
    /// `best`. A hit at the same parameter may have the smaller id.
    #[inline]
    pub(super) fn ray_inside(&self, number: usize, ray: &Ray, best: &Hit) -> Ray {
        let t_max = ray.t_max.min(best.t.next_up());
        let place = self.list()[number].placement();
        place.ray_to_object(ray, t_max)
    }

    /// Takes the hit with the mesh of instance `number`, whose box the ray enters at `front`, if it
    /// is better than the best so far.
    #[inline]
    pub(super) fn take(&self, (number, front): (usize, f32), hit: &Hit, best: &mut Hit) {
        if hit.is_miss() {
            return;
        }
        let instance = &self.list()[number];
        let (b1, b2) = if instance.placement().is_mirrored() {
            (hit.b2, hit.b1)
        } else {
            (hit.b1, hit.b2)
        };
        let hit = Hit {
            t: hit.t.max(front),
            primitive: instance.first_primitive() + hit.primitive,
            b1,
            b2,
        };
        if hit.t < best.t || (hit.t == best.t && hit.primitive < best.primitive) {
            *best = hit;
        }
    }

    /// The ray parameter at which a ray enters the box of instance `number`; `None` if it meets
    /// nothing there.
    #[inline]
    pub(super) fn front(&self, number: usize, slab: &SlabRay) -> Option<f32> {
        slab.enter(&self.boxes()[number])
            .filter(|front| *front < slab.t_max())
    }
}

impl Walk<'_> {
    /// Meets one instance.
    ///
    /// The result depends on the ray and the instance alone, as with a primitive: a hit counts only
    /// if the ray meets the box of the instance, and lies no nearer than that box.
    fn meet<const ANY: bool>(&self, number: usize, ray: (&Ray, &SlabRay), query: &mut Query) {
        let instances = self.instances;
        let front = instances.front(number, ray.1);
        let Some(front) = front.filter(|front| *front <= query.hit.t) else {
            return;
        };
        let inside = [instances.ray_inside(number, ray.0, &query.hit)];
        let mesh = instances.list()[number].mesh();
        let best = &mut query.hit;
        let work = mesh.trace_shapes::<ANY>(self.isa, &inside, |_, hit| {
            instances.take((number, front), &hit, best);
        });
        query.work.nodes += work.nodes;
        query.work.blocks += work.blocks;
    }
}

impl Leaves for Walk<'_> {
    type Query = Query;
    type Block = InstanceBlock;

    fn query(&self, _: &Ray, _: &SlabRay) -> Query {
        Query {
            hit: Hit::MISS,
            work: Work::default(),
        }
    }

    fn visit<V: Lanes, const ANY: bool>(
        &self,
        first: u32,
        ray: (&Ray, &SlabRay),
        query: &mut Query,
        blocks: &mut u64,
    ) -> f32 {
        for block in &self.instances.blocks()[first as usize..] {
            *blocks += 1;
            for number in block.ids() {
                self.meet::<ANY>(number, ray, query);
                if ANY && !query.hit.is_miss() {
                    return f32::NEG_INFINITY;
                }
            }
            if !block.has_more {
                break;
            }
        }
        query.hit.t.min(ray.1.t_max())
    }

    fn blocks(&self) -> &[InstanceBlock] {
        self.instances.blocks()
    }
}
