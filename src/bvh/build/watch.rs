use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Told the finished fraction (0 to 1, from any thread, not in order); may stop the build.
pub type Progress<'a> = dyn Fn(f32) -> ControlFlow<()> + Sync + 'a;

/// Counts the work that is done, and remembers that someone asked to stop.
pub(in crate::bvh) struct Watch<'a> {
    total: usize,
    done: AtomicUsize,
    stopped: AtomicBool,
    progress: &'a Progress<'a>,
}

impl<'a> Watch<'a> {
    /// A watch over `total` pieces of work.
    pub(in crate::bvh) fn new(total: usize, progress: &'a Progress<'a>) -> Self {
        Self {
            total,
            done: AtomicUsize::new(0),
            stopped: AtomicBool::new(false),
            progress,
        }
    }

    /// Counts `finished` more pieces; `None` when the build shall stop.
    pub(in crate::bvh) fn advance(&self, finished: usize) -> Option<()> {
        let done = self.done.fetch_add(finished, Ordering::Relaxed) + finished;
        if self.stopped.load(Ordering::Relaxed) {
            return None;
        }
        if (self.progress)(done as f32 / self.total.max(1) as f32).is_break() {
            self.stopped.store(true, Ordering::Relaxed);
            return None;
        }
        Some(())
    }
}
