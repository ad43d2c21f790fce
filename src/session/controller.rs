//! The session's own thread: takes the latest job, prepares, previews, renders, publishes.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use super::{RenderJob, SessionOptions, SessionState, SessionStatus, Snapshot};
use crate::scene::PreparedScene;

mod picture;
mod refiner;
mod turn;

/// What the host wants.
#[derive(Debug, Default)]
struct Wish {
    job: Option<RenderJob>,
    restart: bool,
    quit: bool,
}

/// The meeting place of the host and the session's thread.
pub(super) struct Shared {
    options: SessionOptions,
    on_change: Box<dyn Fn() + Send + Sync>,
    wish: Mutex<Wish>,
    changed: Condvar,
    /// Grows whenever running work must look up; workers compare it before each batch.
    interrupts: AtomicU64,
    paused: AtomicBool,
    snapshot: Mutex<Option<Arc<Snapshot>>>,
    prepared: Mutex<Option<Arc<PreparedScene>>>,
    status: Mutex<SessionStatus>,
}

impl std::fmt::Debug for Shared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Shared")
            .field("options", &self.options)
            .field("wish", &self.wish)
            .finish_non_exhaustive()
    }
}

/// The data is plain values that a panicking thread cannot leave half changed.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Shared {
    pub(super) fn new(options: SessionOptions, on_change: Box<dyn Fn() + Send + Sync>) -> Self {
        Self {
            options,
            on_change,
            wish: Mutex::default(),
            changed: Condvar::new(),
            interrupts: AtomicU64::new(0),
            paused: AtomicBool::new(false),
            snapshot: Mutex::default(),
            prepared: Mutex::default(),
            status: Mutex::default(),
        }
    }

    pub(super) fn request(&self, job: RenderJob) {
        let mut wish = lock(&self.wish);
        if wish.job.as_ref() != Some(&job) {
            wish.job = Some(job);
            self.interrupt();
        }
    }

    pub(super) fn set_paused(&self, paused: bool) {
        let _wish = lock(&self.wish);
        if self.paused.swap(paused, Ordering::Relaxed) != paused {
            self.interrupt();
        }
    }

    pub(super) fn is_paused(&self) -> bool {
        self.paused.load(Ordering::Relaxed)
    }

    pub(super) fn restart(&self) {
        lock(&self.wish).restart = true;
        self.interrupt();
    }

    pub(super) fn quit(&self) {
        lock(&self.wish).quit = true;
        self.interrupt();
    }

    /// Makes running work look up.
    fn interrupt(&self) {
        self.interrupts.fetch_add(1, Ordering::Relaxed);
        self.changed.notify_all();
    }

    pub(super) fn snapshot(&self) -> Option<Arc<Snapshot>> {
        lock(&self.snapshot).clone()
    }

    pub(super) fn prepared(&self) -> Option<Arc<PreparedScene>> {
        lock(&self.prepared).clone()
    }

    pub(super) fn status(&self) -> SessionStatus {
        lock(&self.status).clone()
    }

    fn publish(&self, snapshot: Snapshot) {
        *lock(&self.snapshot) = Some(Arc::new(snapshot));
        (self.on_change)();
    }

    fn update_status(&self, edit: impl FnOnce(&mut SessionStatus)) {
        let mut status = lock(&self.status);
        let before = status.state;
        edit(&mut status);
        let is_new_state = status.state != before;
        drop(status);
        if is_new_state {
            (self.on_change)();
        }
    }

    fn set_state(&self, state: SessionState) {
        self.update_status(|status| status.state = state);
    }
}

/// The life of the session's thread. A fault in one picture ends that picture, not the session.
pub(super) fn run(shared: &Shared) {
    let mut turn = turn::Turn::new(shared);
    loop {
        // Whatever a panic left half done is thrown away by `recover`.
        match catch_unwind(AssertUnwindSafe(|| turn.take())) {
            Ok(true) => {}
            Ok(false) => break,
            Err(_) => turn.recover(),
        }
    }
}
