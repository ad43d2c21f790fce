//! Reading scenes on a thread of their own. The old scene stays until the new one is complete.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use softbox::io::{ImportError, LoadProgress, Loaded, load_scene};

/// What the loader reports to the window.
#[derive(Debug)]
pub(super) enum LoadEvent {
    /// A scene is complete.
    Loaded {
        /// The scene and its report.
        loaded: Box<Loaded>,
        /// True for the file that was open already.
        is_reload: bool,
    },
    /// Nothing changed; the sentence says why.
    Failed(String),
}

#[derive(Debug)]
enum Message {
    Progress(LoadProgress),
    Done(Result<Box<Loaded>, ImportError>),
}

/// A file being read.
#[derive(Debug)]
struct Running {
    path: PathBuf,
    is_reload: bool,
    progress: Option<LoadProgress>,
    messages: Receiver<Message>,
    is_cancelled: Arc<AtomicBool>,
}

/// Reads one file at a time; a new request takes the place of the old one.
#[derive(Debug, Default)]
pub(super) struct Loader {
    running: Option<Running>,
}

/// What the progress line shows.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LoadStatus {
    /// Name of the file.
    pub(super) file: String,
    /// What is being done.
    pub(super) stage: &'static str,
    /// How much of it is done, 0..1.
    pub(super) fraction: f32,
}

impl Loader {
    /// Starts reading `path`; `wake` is called when there is something to poll.
    pub(super) fn start(
        &mut self,
        path: &Path,
        is_reload: bool,
        wake: impl Fn() + Send + 'static,
    ) -> Result<(), String> {
        self.cancel();
        let (sender, messages) = channel();
        let is_cancelled = Arc::new(AtomicBool::new(false));
        let (file, stop) = (path.to_owned(), Arc::clone(&is_cancelled));
        std::thread::Builder::new()
            .name("loader".to_owned())
            .spawn(move || {
                // The receiver is gone only when nobody wants the answer any more.
                let mut report = |progress| {
                    if stop.load(Ordering::Relaxed) {
                        return ControlFlow::Break(());
                    }
                    drop(sender.send(Message::Progress(progress)));
                    wake();
                    ControlFlow::Continue(())
                };
                let result = load_scene(&file, &mut report).map(Box::new);
                drop(sender.send(Message::Done(result)));
                wake();
            })
            .map_err(|error| format!("cannot start a thread to read the file: {error}"))?;
        self.running = Some(Running {
            path: path.to_owned(),
            is_reload,
            progress: None,
            messages,
            is_cancelled,
        });
        Ok(())
    }

    /// Stops reading; the old scene stays.
    pub(super) fn cancel(&mut self) {
        if let Some(running) = self.running.take() {
            running.is_cancelled.store(true, Ordering::Relaxed);
        }
    }

    /// The state of the file being read.
    pub(super) fn status(&self) -> Option<LoadStatus> {
        self.running.as_ref().map(|running| LoadStatus {
            file: file_name(&running.path),
            stage: running.progress.map_or("starting", |p| p.stage.label()),
            fraction: running.progress.map_or(0.0, |p| p.fraction),
        })
    }

    /// What has happened since the last call.
    pub(super) fn poll(&mut self) -> Option<LoadEvent> {
        let running = self.running.as_mut()?;
        let result = loop {
            match running.messages.try_recv() {
                Ok(Message::Progress(progress)) => running.progress = Some(progress),
                Ok(Message::Done(result)) => break result.map_err(|error| error.to_string()),
                Err(TryRecvError::Empty) => return None,
                Err(TryRecvError::Disconnected) => {
                    break Err(format!(
                        "{}: reading broke off; this is a fault of softbox, please report it.",
                        running.path.display()
                    ));
                }
            }
        };
        let is_reload = running.is_reload;
        self.running = None;
        Some(match result {
            Ok(loaded) => LoadEvent::Loaded { loaded, is_reload },
            Err(sentence) => LoadEvent::Failed(sentence),
        })
    }
}

impl Drop for Loader {
    fn drop(&mut self) {
        self.cancel();
    }
}

/// The last part of a path, for people.
pub(super) fn file_name(path: &Path) -> String {
    path.file_name()
        .unwrap_or(path.as_os_str())
        .to_string_lossy()
        .into_owned()
}
