//! The thread between the session and the window: turns the newest snapshot, with the newest
//! display settings, into an image that the window only has to upload. A change of the display
//! never reaches the session.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

use eframe::egui::ColorImage;
use softbox::display::DisplaySettings;
use softbox::session::{RenderSession, Snapshot};

use super::shown::shown_image;
use crate::shown::Legend;

/// An image ready for the screen.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    /// The displayed pixels.
    pub(super) image: Arc<ColorImage>,
    /// What they were made from.
    pub(super) snapshot: Arc<Snapshot>,
    /// What the colours mean, for views of numbers.
    pub(super) legend: Option<Legend>,
}

/// Wakes the presenter. The session holds one to report new snapshots.
#[derive(Debug, Default)]
pub(super) struct Bell {
    wanted: Mutex<Wanted>,
    rung: Condvar,
}

#[derive(Debug, Default)]
struct Wanted {
    is_rung: bool,
    stops: bool,
    display: DisplaySettings,
}

impl Bell {
    /// There may be something new to show.
    pub(super) fn ring(&self) {
        self.lock().is_rung = true;
        self.rung.notify_one();
    }

    fn lock(&self) -> MutexGuard<'_, Wanted> {
        self.wanted.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Sleeps until the bell rings; `None` when the presenter shall end.
    fn wait(&self) -> Option<DisplaySettings> {
        let mut wanted = self
            .rung
            .wait_while(self.lock(), |wanted| !wanted.is_rung && !wanted.stops)
            .unwrap_or_else(PoisonError::into_inner);
        wanted.is_rung = false;
        (!wanted.stops).then_some(wanted.display)
    }
}

/// The presenter's thread and its one-slot mailbox. Dropping it joins the thread.
#[derive(Debug)]
pub(super) struct Presenter {
    bell: Arc<Bell>,
    mailbox: Arc<Mutex<Option<Frame>>>,
    thread: Option<JoinHandle<()>>,
}

impl Presenter {
    /// Starts the thread; `wake` is called after a new frame lies in the mailbox.
    ///
    /// # Errors
    /// When the system cannot start a thread.
    pub(super) fn start(
        session: Arc<RenderSession>,
        bell: Arc<Bell>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<Self> {
        let mailbox = Arc::new(Mutex::new(None));
        let thread = std::thread::Builder::new()
            .name("presenter".to_owned())
            .spawn({
                let (bell, mailbox) = (Arc::clone(&bell), Arc::clone(&mailbox));
                move || present(&session, &bell, &mailbox, &wake)
            })?;
        Ok(Self {
            bell,
            mailbox,
            thread: Some(thread),
        })
    }

    /// Shows everything from now on with `display`.
    pub(super) fn set_display(&self, display: DisplaySettings) {
        let mut wanted = self.bell.lock();
        if wanted.display != display {
            wanted.display = display;
            wanted.is_rung = true;
            drop(wanted);
            self.bell.rung.notify_one();
        }
    }

    /// The newest frame, if it was not taken yet.
    pub(super) fn take(&self) -> Option<Frame> {
        lock(&self.mailbox).take()
    }
}

impl Drop for Presenter {
    fn drop(&mut self) {
        self.bell.lock().stops = true;
        self.bell.rung.notify_one();
        if let Some(thread) = self.thread.take() {
            // A panic there was reported by the panic hook; there is nothing left to present.
            drop(thread.join());
        }
    }
}

fn lock(mailbox: &Mutex<Option<Frame>>) -> MutexGuard<'_, Option<Frame>> {
    mailbox.lock().unwrap_or_else(PoisonError::into_inner)
}

fn present(session: &RenderSession, bell: &Bell, mailbox: &Mutex<Option<Frame>>, wake: &dyn Fn()) {
    let mut last: Option<(Arc<Snapshot>, DisplaySettings)> = None;
    while let Some(display) = bell.wait() {
        if let Some(snapshot) = session.snapshot() {
            let is_known = last
                .as_ref()
                .is_some_and(|(old, shown)| Arc::ptr_eq(old, &snapshot) && *shown == display);
            if !is_known {
                let (image, legend) = shown_image(&snapshot, &display);
                *lock(mailbox) = Some(Frame {
                    image: Arc::new(image),
                    snapshot: Arc::clone(&snapshot),
                    legend,
                });
                last = Some((snapshot, display));
            }
        }
        // Woken without a new picture too: the session's state may have changed.
        wake();
    }
}
