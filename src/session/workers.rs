use std::sync::Mutex;

use rayon::ThreadPool;

use crate::color::Rgb;
use crate::integrator::{BATCH_SIZE, PathCounts, PathId, PathTracer, Wavefront, reference_cluster};
use crate::settings::IntegratorKind;

/// Priority of the workers of a window (nice value): they have the whole machine while the window
/// rests, and never keep it from answering.
const BACKGROUND_NICE: i32 = 10;

/// Paths in a batch of a window's session: small enough that a new camera waits for no more than
/// some milliseconds.
const BACKGROUND_BATCH: usize = 512;

/// A pool of named threads, each with the arrays of its integrator.
#[derive(Debug)]
pub(super) struct Workers {
    pool: ThreadPool,
    arrays: Vec<Mutex<WorkerArrays>>,
    is_background: bool,
}

/// What one thread keeps from batch to batch.
#[derive(Debug, Default)]
pub(super) struct WorkerArrays {
    wavefront: Wavefront,
    pub(super) ids: Vec<PathId>,
    pub(super) radiance: Vec<Rgb>,
}

impl Workers {
    pub(super) fn new(threads: usize, is_background: bool) -> Self {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .thread_name(|i| format!("softbox-worker-{i}"))
            .start_handler(move |_| {
                if is_background {
                    lower_priority();
                }
            })
            .build()
            .expect("the system refuses the worker threads");
        let arrays = (0..pool.current_num_threads())
            .map(|_| Mutex::default())
            .collect();
        Self {
            pool,
            arrays,
            is_background,
        }
    }

    /// Paths in one batch, after which workers look up.
    pub(super) fn batch_size(&self) -> usize {
        if self.is_background {
            BACKGROUND_BATCH
        } else {
            BATCH_SIZE
        }
    }

    pub(super) fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// The same kind of pool with another number of threads.
    pub(super) fn resized(&self, threads: usize) -> Self {
        Self::new(threads, self.is_background)
    }

    /// Processor time of all workers since they began, seconds; asked while they rest.
    pub(super) fn cpu_seconds(&self) -> f64 {
        self.pool.broadcast(|_| thread_seconds()).iter().sum()
    }

    pub(super) fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        self.pool.install(work)
    }

    /// Runs `work` with the arrays of the calling worker; only from inside [`Self::install`].
    pub(super) fn with_arrays<R>(&self, work: impl FnOnce(&mut WorkerArrays) -> R) -> R {
        let index = rayon::current_thread_index().unwrap_or(0);
        // Poisoned only by a panic, after which the arrays are still plain memory.
        let mut arrays = self.arrays[index]
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        work(&mut arrays)
    }
}

impl WorkerArrays {
    /// Fills `self.radiance` with the radiance of `self.ids`, at most [`BATCH_SIZE`] paths.
    pub(super) fn trace(
        &mut self,
        tracer: &PathTracer<'_>,
        integrator: IntegratorKind,
        counts: &mut PathCounts,
    ) {
        debug_assert!(self.ids.len() <= BATCH_SIZE);
        self.radiance.clear();
        self.radiance.resize(self.ids.len(), Rgb::ZERO);
        match integrator {
            IntegratorKind::Reference => {
                let size = tracer.cluster_size();
                let clusters = self.ids.chunks(size).zip(self.radiance.chunks_mut(size));
                for (ids, radiance) in clusters {
                    reference_cluster(tracer, ids, radiance, counts);
                }
            }
            IntegratorKind::Wavefront => {
                self.wavefront
                    .trace(tracer, &self.ids, &mut self.radiance, counts);
            }
        }
    }
}

/// Processor time of this thread, seconds.
#[cfg(unix)]
fn thread_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// Without such a clock, time on the wall.
#[cfg(not(unix))]
fn thread_seconds() -> f64 {
    use std::sync::LazyLock;
    use std::time::Instant;
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_secs_f64()
}

#[cfg(target_os = "linux")]
pub(super) fn lower_priority() {
    let thread = rustix::thread::gettid();
    // Refused at worst; then the workers run at normal priority.
    let _ = rustix::process::setpriority_process(Some(thread), BACKGROUND_NICE);
}

#[cfg(not(target_os = "linux"))]
pub(super) fn lower_priority() {}
