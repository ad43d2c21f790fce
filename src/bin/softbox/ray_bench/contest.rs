use std::ops::Range;
use std::sync::{Barrier, Mutex};

use rayon::ThreadPool;
use softbox::bvh::BvhSettings;
use softbox::geometry::{Aggregate, Hit, Shapes};
use softbox::math::Isa;

use super::clock::{Taken, of_process, of_thread};
use super::rays::{Kind, RaySet, ray_sets};
use super::result::{BuildResult, Mismatches, RaysResult, SceneResult};
use super::system::pool_of;
use super::{Exact, Protocol, Subject, System, Tracer, median};

/// Rays that a thread takes at once, as a render does.
const BATCH: usize = 4096;

/// Rays that a system traces before it is the next one's turn: so few that what disturbs the machine
/// disturbs all of them, and so many that they hardly miss what the others drove out of the caches.
const PART: usize = 8 * BATCH;

/// A run over a ray set that takes more wall seconds than this is not repeated.
const LONG_RUN: f64 = 2.5;

/// The same for builds, of which the first is often slower than the next.
const LONG_BUILD: f64 = 8.0;

/// Builds and traces one subject with every system.
///
/// In each round every system traces the same rays, a part in turn, so that what disturbs the machine
/// disturbs all of them. Ratios are medians of ratios within a round.
pub(crate) fn contest(subject: &Subject, systems: &[System], protocol: &Protocol) -> SceneResult {
    let aggregate = Aggregate::build(subject.shapes.clone(), BvhSettings::default());
    let sets = ray_sets(subject, &Exact(&aggregate), protocol.size, &protocol.kinds);
    drop(aggregate);
    let mut result = SceneResult {
        scene: subject.name.clone(),
        triangles: subject.shapes.triangles.len(),
        isa: protocol.isa.unwrap_or_else(Isa::best),
        rays: sets.iter().map(|set| (set.kind, set.rays.len())).collect(),
        builds: Vec::new(),
        traced: Vec::new(),
    };
    let takes_part = |s: &&System| sets.iter().any(|set| s.kinds.contains(&set.kind));
    let systems: Vec<&System> = systems.iter().filter(takes_part).collect();
    let (tracers, builds) = build(&subject.shapes, &systems, protocol);
    result.builds = builds;
    for set in &sets {
        let competing = systems.iter().zip(&tracers);
        let competing: Vec<_> = competing
            .filter(|(system, _)| system.kinds.contains(&set.kind))
            .map(|(system, tracer)| (system.name.as_str(), &**tracer))
            .collect();
        result.traced.extend(trace(set, &competing, protocol));
    }
    result
}

/// Builds with every system in turn; gives the tracers that were built last.
fn build(
    shapes: &Shapes,
    systems: &[&System],
    protocol: &Protocol,
) -> (Vec<Box<dyn Tracer>>, Vec<BuildResult>) {
    let mut tracers: Vec<Option<Box<dyn Tracer>>> = systems.iter().map(|_| None).collect();
    let mut results = Vec::new();
    let anchor = anchor(systems.iter().map(|system| system.name.as_str()));
    for &threads in &protocol.threads {
        let mut all: Vec<Vec<Taken>> = vec![Vec::new(); systems.len()];
        for round in 0..protocol.builds {
            for (i, system) in systems.iter().enumerate() {
                if round > 0 && all[i][0].wall > LONG_BUILD {
                    continue;
                }
                tracers[i] = None;
                let prepared = system.prepare(shapes, threads);
                let (built, taken) = of_process(prepared);
                tracers[i] = Some(built);
                all[i].push(taken);
            }
        }
        for ((system, taken), tracer) in systems.iter().zip(&all).zip(tracers.iter().flatten()) {
            results.push(BuildResult {
                system: system.name.clone(),
                threads,
                processor_seconds: median(taken.iter().map(|taken| taken.processor)),
                wall_seconds: median(taken.iter().map(|taken| taken.wall)),
                ratio: anchor.map(|i| {
                    let pairs = taken.iter().zip(&all[i]);
                    median(pairs.map(|(taken, anchor)| anchor.processor / taken.processor))
                }),
                bytes: tracer.bytes(),
                sah_cost: tracer.sah_cost(),
            });
        }
    }
    let tracers = tracers.into_iter().flatten().collect();
    (tracers, results)
}

/// The place of the system that others are compared with.
fn anchor<'a>(mut names: impl Iterator<Item = &'a str>) -> Option<usize> {
    names.position(|name| name == super::ANCHOR)
}

fn trace(set: &RaySet, systems: &[(&str, &dyn Tracer)], protocol: &Protocol) -> Vec<RaysResult> {
    let mut hits = Hits::new(set);
    let alone = pool_of(1);
    // A first run, not timed but for whether it is long, fills the caches and is checked.
    let first: Vec<(Mismatches, bool)> = systems
        .iter()
        .map(|(_, tracer)| {
            let taken = hits.trace(set, 0..set.rays.len(), *tracer, &alone);
            (hits.mismatches(set), taken.wall > LONG_RUN)
        })
        .collect();
    let mut results = Vec::new();
    for &threads in &protocol.threads {
        let pool = pool_of(threads);
        let mut rates = vec![Vec::new(); systems.len()];
        let mut walls = vec![Vec::new(); systems.len()];
        for round in 0..protocol.rounds {
            let mut taken = vec![Taken::default(); systems.len()];
            for from in (0..set.rays.len()).step_by(PART) {
                let part = from..(from + PART).min(set.rays.len());
                for (i, (_, tracer)) in systems.iter().enumerate() {
                    if round == 0 || !first[i].1 {
                        taken[i] += hits.trace(set, part.clone(), *tracer, &pool);
                    }
                }
            }
            for (i, taken) in taken.iter().enumerate().filter(|(_, t)| t.wall > 0.0) {
                let rays = set.rays.len() as f64;
                rates[i].push(rays * threads as f64 / taken.processor);
                walls[i].push(rays / taken.wall);
            }
        }
        let anchor = anchor(systems.iter().map(|(name, _)| *name));
        results.extend(
            (0..systems.len()).map(|i| RaysResult {
                system: systems[i].0.to_owned(),
                kind: set.kind,
                threads,
                rays_per_second: median(rates[i].iter().copied()),
                rays_per_wall_second: median(walls[i].iter().copied()),
                ratio: anchor
                    .map(|anchor| median(rates[i].iter().zip(&rates[anchor]).map(|(a, b)| a / b))),
                mismatches: first[i].0,
            }),
        );
    }
    results
}

/// The buffers that all systems write.
struct Hits {
    closest: Vec<Hit>,
    occluded: Vec<bool>,
}

impl Hits {
    fn new(set: &RaySet) -> Self {
        let rays = set.rays.len();
        let is_shadow = set.kind.is_shadow();
        Self {
            closest: vec![Hit::MISS; if is_shadow { 0 } else { rays }],
            occluded: vec![false; if is_shadow { rays } else { 0 }],
        }
    }

    /// Traces the rays in `part`; the processor time is that of all threads.
    fn trace(
        &mut self,
        set: &RaySet,
        part: Range<usize>,
        tracer: &dyn Tracer,
        pool: &ThreadPool,
    ) -> Taken {
        let batches = set.rays[part.clone()].chunks(BATCH);
        if set.kind.is_shadow() {
            let work = batches.zip(self.occluded[part].chunks_mut(BATCH));
            run(work, pool, |(rays, out)| tracer.any_hit(rays, out))
        } else {
            let work = batches.zip(self.closest[part].chunks_mut(BATCH));
            run(work, pool, |(rays, out)| {
                if set.kind == Kind::Primary {
                    tracer.primary_hit(rays, out);
                } else {
                    tracer.closest_hit(rays, out);
                }
            })
        }
    }

    fn mismatches(&self, set: &RaySet) -> Mismatches {
        if set.kind.is_shadow() {
            Mismatches::of_any(&set.expected, &self.occluded)
        } else {
            Mismatches::of_closest(&set.expected, &self.closest)
        }
    }
}

/// Lets the threads of `pool` take batches until none are left; the processor time is that of all of
/// them. The threads stay from one part to the next, as those of a render do: a new one would have to
/// fetch its stack page by page.
fn run<B: Send>(
    batches: impl Iterator<Item = B> + Send,
    pool: &ThreadPool,
    trace: impl Fn(B) + Sync,
) -> Taken {
    let queue = Mutex::new(batches);
    let next = || queue.lock().expect("no thread panics with the lock").next();
    let start = Barrier::new(pool.current_num_threads());
    let work = || {
        start.wait();
        of_thread(|| std::iter::from_fn(next).for_each(&trace)).1
    };
    let (all, taken) = of_process(|| {
        let all = pool.broadcast(|_| work());
        all.iter().map(|taken| taken.processor).sum()
    });
    Taken {
        processor: all,
        ..taken
    }
}
