use std::fmt;
use std::ops::ControlFlow;

use clap::ValueEnum;
use rayon::{ThreadPool, ThreadPoolBuilder};
use softbox::bvh::{BvhQuality, BvhSettings};
use softbox::geometry::{Aggregate, Hit, Shapes, TraceCounts};
use softbox::math::{Isa, Ray};

use super::Kind;

/// A built structure that traces rays. Every system writes its hits into the same kind of buffer.
pub(crate) trait Tracer: Send + Sync {
    /// Writes the closest hit of each ray.
    fn closest_hit(&self, rays: &[Ray], hits: &mut [Hit]);
    /// The same for camera rays, which come in tiles.
    fn primary_hit(&self, rays: &[Ray], hits: &mut [Hit]) {
        self.closest_hit(rays, hits);
    }
    /// Writes for each ray whether anything lies on it.
    fn any_hit(&self, rays: &[Ray], occluded: &mut [bool]);
    /// Memory of the structure in bytes, triangles included where it holds its own.
    fn bytes(&self) -> usize;
    /// Cost of a random ray by the surface-area heuristic, in the system's own units.
    fn sah_cost(&self) -> Option<f64> {
        None
    }
}

/// What remains to be done when the system has its input: the build that is timed.
pub(crate) type Build = Box<dyn FnOnce() -> Box<dyn Tracer>>;

/// Makes the input of a system, in its own form, for a build by so many threads.
type Prepare = Box<dyn Fn(&Shapes, usize) -> Build>;

/// A system to measure.
pub(crate) struct System {
    /// Name in tables.
    pub(crate) name: String,
    /// The kinds of rays that it traces.
    pub(crate) kinds: &'static [Kind],
    prepare: Prepare,
}

impl fmt::Debug for System {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("System").field("name", &self.name).finish()
    }
}

impl System {
    /// `prepare` makes the input of a build by so many threads, before the clock starts.
    pub(crate) fn new(
        name: &str,
        kinds: &'static [Kind],
        prepare: impl Fn(&Shapes, usize) -> Build + 'static,
    ) -> Self {
        Self {
            name: name.to_owned(),
            kinds,
            prepare: Box::new(prepare),
        }
    }

    /// Makes the input; the clock starts after this.
    pub(crate) fn prepare(&self, shapes: &Shapes, threads: usize) -> Build {
        (self.prepare)(shapes, threads)
    }
}

/// The tracer of the library, as a render with `isa` uses it: with the tree that it starts with, with
/// the one it goes on with, and with the one of large scenes that are edited.
pub(crate) fn ours(isa: Isa) -> Vec<System> {
    let one = |name, quality| {
        System::new(name, Kind::value_variants(), move |shapes, threads| {
            let mut shapes = shapes.clone();
            let settings = BvhSettings {
                quality,
                ..BvhSettings::default()
            };
            Box::new(on_threads(threads, move || -> Box<dyn Tracer> {
                shapes.turn_to_quads();
                let built = Aggregate::build(shapes, settings);
                let is_final = quality != BvhQuality::High || built.is_refined();
                let built = (!is_final)
                    .then(|| built.refined(&|_| ControlFlow::Continue(())))
                    .flatten()
                    .unwrap_or(built);
                Box::new(Ours(built.with_isa(isa)))
            }))
        })
    };
    vec![
        one("ours", BvhQuality::Standard),
        one("ours-high", BvhQuality::High),
        one("ours-fast", BvhQuality::Fast),
    ]
}

/// So many threads.
pub(super) fn pool_of(threads: usize) -> ThreadPool {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("the system gives threads")
}

/// `build` on a pool of so many threads, which is there before the clock starts.
pub(crate) fn on_threads(
    threads: usize,
    build: impl FnOnce() -> Box<dyn Tracer> + Send + 'static,
) -> impl FnOnce() -> Box<dyn Tracer> {
    let pool = pool_of(threads);
    move || pool.install(build)
}

struct Ours(Aggregate);

impl Tracer for Ours {
    fn closest_hit(&self, rays: &[Ray], hits: &mut [Hit]) {
        self.0.closest_hit(rays, hits, &mut TraceCounts::default());
    }

    fn primary_hit(&self, rays: &[Ray], hits: &mut [Hit]) {
        self.0
            .closest_hit_coherent(rays, hits, &mut TraceCounts::default());
    }

    fn any_hit(&self, rays: &[Ray], occluded: &mut [bool]) {
        self.0.any_hit(rays, occluded, &mut TraceCounts::default());
    }

    fn bytes(&self) -> usize {
        self.0.stats().bytes
    }

    fn sah_cost(&self) -> Option<f64> {
        Some(self.0.stats().sah_cost)
    }
}
