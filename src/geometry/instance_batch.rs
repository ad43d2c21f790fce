use super::instances::InstanceBlock;
use super::{Hit, Instances};
use crate::bvh::{Leaves, SlabRay, Work};
use crate::math::{Isa, Lanes, Ray};

/// Instances that are found at once for a ray. Most rays meet fewer, or something in one of them.
const MOST: usize = 16;

/// The nearest instances whose boxes a ray meets.
#[derive(Clone, Copy, Debug)]
struct Nearest {
    /// Ray parameter at the box, and number of the instance, nearest first.
    found: [(f32, u32); MOST],
    count: usize,
}

impl Nearest {
    const NONE: Self = Self {
        found: [(f32::INFINITY, 0); MOST],
        count: 0,
    };

    fn get(&self, rank: usize) -> Option<(f32, u32)> {
        (rank < self.count).then(|| self.found[rank])
    }

    fn insert(&mut self, front: f32, number: u32) {
        let mut at = self.count;
        while at > 0 && self.found[at - 1].0 > front {
            at -= 1;
        }
        if at == MOST {
            return;
        }
        self.count = (self.count + 1).min(MOST);
        self.found[at..self.count].rotate_right(1);
        self.found[at] = (front, number);
    }
}

/// The hierarchy over the instances as a ray sees it that only looks at their boxes.
#[derive(Clone, Copy, Debug)]
struct Find<'a>(&'a Instances);

impl Leaves for Find<'_> {
    type Query = Nearest;
    type Block = InstanceBlock;

    fn query(&self, _: &Ray, _: &SlabRay) -> Nearest {
        Nearest::NONE
    }

    fn visit<V: Lanes, const ANY: bool>(
        &self,
        first: u32,
        (_, slab): (&Ray, &SlabRay),
        query: &mut Nearest,
        blocks: &mut u64,
    ) -> f32 {
        for block in &self.0.blocks()[first as usize..] {
            *blocks += 1;
            for number in block.ids() {
                if let Some(front) = self.0.front(number, slab) {
                    query.insert(front, number as u32);
                }
            }
            if !block.has_more {
                break;
            }
        }
        query.get(MOST - 1).map_or(slab.t_max(), |(front, _)| front)
    }

    fn blocks(&self) -> &[InstanceBlock] {
        self.0.blocks()
    }
}

/// What the rays of a batch have found.
struct Batch<'a> {
    instances: &'a Instances,
    isa: Isa,
    rays: &'a [Ray],
    nearest: Vec<Nearest>,
    best: Vec<Hit>,
    work: Work,
}

impl Instances {
    /// Gives the number of each ray that meets an instance, and its hit, to `met`; returns the work.
    ///
    /// All rays together: first the nearest boxes of each, then round after round the next of them,
    /// so that many rays go through the tree of a mesh at a time. A round changes nothing but the
    /// best hit, which depends neither on the order nor on instances that are met twice.
    pub(super) fn trace_batch<const ANY: bool>(
        &self,
        isa: Isa,
        rays: &[Ray],
        mut met: impl FnMut(usize, Hit),
    ) -> Work {
        let mut nearest = vec![Nearest::NONE; rays.len()];
        let work = self
            .bvh()
            .traverse::<false, _>(isa, &Find(self), rays, |i, found| {
                if let Some(found) = found {
                    nearest[i] = *found;
                }
            });
        let mut batch = Batch {
            instances: self,
            isa,
            rays,
            nearest,
            best: vec![Hit::MISS; rays.len()],
            work,
        };
        let mut open: Vec<usize> = (0..rays.len()).collect();
        for rank in 0..MOST {
            open.retain(|&i| batch.goes_on::<ANY>(i, rank));
            batch.round::<ANY>(&open, rank);
        }
        // There may be more instances than were found.
        open.retain(|&i| batch.goes_on::<ANY>(i, MOST - 1));
        batch.rest::<ANY>(&open);
        let hits = batch.best.iter().enumerate();
        hits.filter(|(_, hit)| !hit.is_miss())
            .for_each(|(i, hit)| met(i, *hit));
        batch.work
    }
}

impl Batch<'_> {
    /// True when the instance of this rank may be better for ray `i` than the best so far.
    fn goes_on<const ANY: bool>(&self, i: usize, rank: usize) -> bool {
        let best = &self.best[i];
        let near = self.nearest[i].get(rank);
        (!ANY || best.is_miss()) && near.is_some_and(|(front, _)| front <= best.t)
    }

    /// Meets the instances of one rank.
    fn round<const ANY: bool>(&mut self, open: &[usize], rank: usize) {
        let instances = self.instances;
        let number = |nearest: &[Nearest], i: usize| nearest[i].found[rank].1 as usize;
        let mut steps: Vec<(u32, usize)> = open
            .iter()
            .map(|&i| (instances.mesh_of(number(&self.nearest, i)), i))
            .collect();
        if instances.meshes().len() > 1 {
            steps.sort_unstable();
        }
        for steps in steps.chunk_by(|a, b| a.0 == b.0) {
            let inside = steps.iter().map(|&(_, i)| {
                let number = number(&self.nearest, i);
                instances.ray_inside(number, &self.rays[i], &self.best[i])
            });
            let inside: Vec<Ray> = inside.collect();
            let mesh = &instances.meshes()[steps[0].0 as usize];
            let (nearest, best) = (&self.nearest, &mut self.best);
            let work = mesh.trace_shapes::<ANY>(self.isa, &inside, |k, hit| {
                let i = steps[k].1;
                let (front, number) = nearest[i].found[rank];
                instances.take((number as usize, front), &hit, &mut best[i]);
            });
            self.work.nodes += work.nodes;
            self.work.blocks += work.blocks;
        }
    }

    /// Meets all instances, those that were found once more.
    fn rest<const ANY: bool>(&mut self, open: &[usize]) {
        let limited = |&i: &usize| Ray {
            t_max: self.rays[i].t_max.min(self.best[i].t.next_up()),
            ..self.rays[i]
        };
        let rays: Vec<Ray> = open.iter().map(limited).collect();
        let best = &mut self.best;
        let work = self.instances.walk::<ANY>(self.isa, &rays, |k, hit| {
            let best = &mut best[open[k]];
            if (hit.t, hit.primitive) < (best.t, best.primitive) {
                *best = hit;
            }
        });
        self.work.nodes += work.nodes;
        self.work.blocks += work.blocks;
    }
}
