//! Reading scenes on a thread of their own. The old scene stays until the new one is complete.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use softbox::io::{LoadProgress, Loaded, builtin_scene, load_scene};

use crate::open::environment_map;

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
    Done(Result<Box<Loaded>, String>),
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
#[derive(Debug)]
pub(super) struct Loader {
    running: Option<Running>,
    environment: Option<PathBuf>,
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
    /// A loader; `environment`, a picture of the surroundings, takes the place of every scene's
    /// own.
    pub(super) fn new(environment: Option<PathBuf>) -> Self {
        Self {
            running: None,
            environment,
        }
    }

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
        let environment = self.environment.clone();
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
                let result = read(&file, environment.as_ref(), &mut report).map(Box::new);
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
                Ok(Message::Done(result)) => break result,
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

/// Reads a file, or gives the built-in scene of that name where there is no such file.
fn read(
    path: &Path,
    environment: Option<&PathBuf>,
    report: &mut dyn FnMut(LoadProgress) -> ControlFlow<()>,
) -> Result<Loaded, String> {
    let name = path.to_str().filter(|_| !path.exists());
    let mut loaded = match name.and_then(builtin_scene) {
        Some(loaded) => loaded,
        None => load_scene(path, report).map_err(|error| error.to_string())?,
    };
    if let Some(environment) = environment {
        let map = environment_map(environment).map_err(|error| error.to_string())?;
        loaded.scene.environment.map = Some(map);
    }
    loaded.scene.light_if_dark();
    Ok(loaded)
}

/// The last part of a path, for people.
pub(super) fn file_name(path: &Path) -> String {
    path.file_name()
        .unwrap_or(path.as_os_str())
        .to_string_lossy()
        .into_owned()
}
