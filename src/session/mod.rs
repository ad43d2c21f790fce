//! Floor 7: a running render. The host says every frame which picture it wants; the session's own
//! thread compares, does the least work that the difference asks for, and publishes snapshots.
//! Knows neither windows nor files.

mod adaptive;
mod background;
mod batches;
mod change;
mod controller;
mod first_hit_pass;
mod job;
mod pace;
mod pass;
mod preview;
mod publish;
mod refinement;
mod snapshot;
mod status;
mod workbench;
mod workers;

pub use job::{RenderJob, SessionOptions};
pub use snapshot::{SampleCounts, Snapshot};
pub use status::{SessionState, SessionStatus, StopReason, TreeState};
pub use workbench::{Exposure, Workbench};

use std::sync::Arc;
use std::thread::JoinHandle;

use crate::scene::PreparedScene;
use controller::Shared;

/// A handle to a running render; dropping it ends the render and joins its threads.
#[derive(Debug)]
pub struct RenderSession {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl RenderSession {
    /// Starts an idle session. `on_change` is called from the session's threads after each new
    /// snapshot or change of state; it must not block.
    pub fn new(options: SessionOptions, on_change: impl Fn() + Send + Sync + 'static) -> Self {
        let shared = Arc::new(Shared::new(options, Box::new(on_change)));
        let for_thread = Arc::clone(&shared);
        let thread = std::thread::Builder::new()
            .name("softbox-session".to_owned())
            .spawn(move || controller::run(&for_thread))
            .expect("the system refuses one more thread");
        Self {
            shared,
            thread: Some(thread),
        }
    }

    /// Asks for the picture of `job`. Cheap, meant to be called every frame: a job equal to the
    /// last one does nothing; otherwise the latest job wins and takes effect within one batch of
    /// paths.
    pub fn request(&self, job: RenderJob) {
        self.shared.request(job);
    }

    /// Holds the render; the film stays.
    pub fn pause(&self) {
        self.shared.set_paused(true);
    }

    /// Goes on after [`Self::pause`].
    pub fn resume(&self) {
        self.shared.set_paused(false);
    }

    /// True between [`Self::pause`] and [`Self::resume`].
    pub fn is_paused(&self) -> bool {
        self.shared.is_paused()
    }

    /// Drops all samples and starts again.
    pub fn restart(&self) {
        self.shared.restart();
    }

    /// The newest picture.
    pub fn snapshot(&self) -> Option<Arc<Snapshot>> {
        self.shared.snapshot()
    }

    /// What is going on.
    pub fn status(&self) -> SessionStatus {
        self.shared.status()
    }

    /// The runtime scene of the picture that is shown. It gives way to the same scene under a
    /// better hierarchy when that is ready, see [`TreeState`].
    pub fn prepared(&self) -> Option<Arc<PreparedScene>> {
        self.shared.prepared()
    }
}

impl Drop for RenderSession {
    fn drop(&mut self) {
        self.shared.quit();
        if let Some(thread) = self.thread.take() {
            // A panic of the thread was shown when it happened.
            drop(thread.join());
        }
    }
}
