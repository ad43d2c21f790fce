//! The thread that reads reference pictures and scores snapshots against them, so that the window
//! never waits. It sleeps while there is nothing to do, and skips what it is too slow for.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use softbox::session::Snapshot;

use super::reference_picture::ReferencePicture;

/// What the thread has found.
#[derive(Debug)]
pub(super) enum Finding {
    /// A picture was read, or not for this reason.
    Read(Result<Arc<ReferencePicture>, String>),
    /// relMSE of this snapshot, or why there is none.
    Scored(Arc<Snapshot>, Result<f64, String>),
}

/// The latest wish of each kind.
#[derive(Debug, Default)]
struct Wishes {
    read: Option<PathBuf>,
    score: Option<(Arc<Snapshot>, Arc<ReferencePicture>)>,
    stops: bool,
}

#[derive(Debug, Default)]
struct Desk {
    wishes: Mutex<Wishes>,
    changed: Condvar,
}

impl Desk {
    fn lock(&self) -> MutexGuard<'_, Wishes> {
        self.wishes.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Sleeps until somebody wants something.
    fn next(&self) -> Wishes {
        let is_idle = |w: &mut Wishes| w.read.is_none() && w.score.is_none() && !w.stops;
        let mut wishes = self
            .changed
            .wait_while(self.lock(), is_idle)
            .unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut wishes)
    }
}

/// The thread and the way to it. Dropping it lets the thread end after what it is doing; a window
/// does not wait for a large file.
#[derive(Debug)]
pub(super) struct Scorer {
    desk: Arc<Desk>,
    findings: Receiver<Finding>,
}

impl Scorer {
    /// Starts the thread; `wake` is called when there is a finding.
    ///
    /// # Errors
    /// When the system cannot start a thread.
    pub(super) fn start(wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let desk = Arc::new(Desk::default());
        let (sender, findings) = channel();
        let for_thread = Arc::clone(&desk);
        std::thread::Builder::new()
            .name("scorer".to_owned())
            .spawn(move || work(&for_thread, &sender, &wake))?;
        Ok(Self { desk, findings })
    }

    /// Reads this picture.
    pub(super) fn read(&self, path: PathBuf) {
        self.desk.lock().read = Some(path);
        self.desk.changed.notify_one();
    }

    /// Scores this snapshot, in place of an older one that has not had its turn.
    pub(super) fn score(&self, snapshot: Arc<Snapshot>, reference: Arc<ReferencePicture>) {
        self.desk.lock().score = Some((snapshot, reference));
        self.desk.changed.notify_one();
    }

    /// The oldest finding that was not taken.
    pub(super) fn take(&self) -> Option<Finding> {
        self.findings.try_recv().ok()
    }
}

impl Drop for Scorer {
    fn drop(&mut self) {
        self.desk.lock().stops = true;
        self.desk.changed.notify_one();
    }
}

fn work(desk: &Desk, sender: &Sender<Finding>, wake: &dyn Fn()) {
    loop {
        let wishes = desk.next();
        if wishes.stops {
            return;
        }
        let tell = |finding| {
            // The receiver is gone only when nobody wants the answer any more.
            drop(sender.send(finding));
            wake();
        };
        if let Some(path) = wishes.read {
            tell(Finding::Read(ReferencePicture::read(&path).map(Arc::new)));
        }
        if let Some((snapshot, reference)) = wishes.score {
            let score = reference.rel_mse(&snapshot);
            tell(Finding::Scored(snapshot, score));
        }
    }
}
