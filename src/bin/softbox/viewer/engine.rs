//! The machinery behind the picture: the render session and the presenter, wired to the window.

use std::sync::Arc;

use softbox::display::DisplaySettings;
use softbox::scene::PreparedScene;
use softbox::session::{RenderJob, RenderSession, SessionOptions, SessionStatus};

use super::presenter::{Bell, Frame, Presenter};

/// A running session whose pictures arrive ready for the screen. Dropping it joins all threads.
#[derive(Debug)]
pub(super) struct Engine {
    // Dropped first: it holds the session too.
    presenter: Presenter,
    session: Arc<RenderSession>,
}

impl Engine {
    /// Starts the threads; `wake` is called when there is something new to show.
    ///
    /// # Errors
    /// When the system cannot start a thread.
    pub(super) fn start(wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let bell = Arc::new(Bell::default());
        let options = SessionOptions { interactive: true };
        let for_session = Arc::clone(&bell);
        let session = Arc::new(RenderSession::new(options, move || for_session.ring()));
        let presenter = Presenter::start(Arc::clone(&session), bell, wake)?;
        Ok(Self { presenter, session })
    }

    /// Asks for a picture, every frame; an equal job does nothing.
    pub(super) fn request(&self, job: RenderJob, display: DisplaySettings) {
        self.session.request(job);
        self.presenter.set_display(display);
    }

    /// The newest frame, if it was not taken yet.
    pub(super) fn take_frame(&self) -> Option<Frame> {
        self.presenter.take()
    }

    /// What is going on.
    pub(super) fn status(&self) -> SessionStatus {
        self.session.status()
    }

    /// The prepared scene of the shown picture.
    pub(super) fn prepared(&self) -> Option<Arc<PreparedScene>> {
        self.session.prepared()
    }

    /// Drops all samples and starts again.
    pub(super) fn restart(&self) {
        self.session.resume();
        self.session.restart();
    }

    /// Holds the render, or goes on. Returns true when it is held now.
    pub(super) fn toggle_pause(&self) -> bool {
        if self.session.is_paused() {
            self.session.resume();
            false
        } else {
            self.session.pause();
            true
        }
    }

    /// True while the render is held.
    pub(super) fn is_paused(&self) -> bool {
        self.session.is_paused()
    }
}
