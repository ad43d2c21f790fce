//! All traffic with the disk: reading and watching scenes, writing pictures, the file dialog.
//! Nothing here blocks the window.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

use eframe::egui::Context;
use softbox::io::ImportReport;

use super::loader::{LoadEvent, LoadStatus, Loader};
use super::snapshot_file::{SnapshotRequest, write_snapshot};
use super::watcher::FileWatch;

/// What came back from a thread.
#[derive(Debug)]
pub(super) enum FileEvent {
    /// From the loader.
    Load(LoadEvent),
    /// The file dialog chose this file.
    Chosen(PathBuf),
    /// The file dialog chose this picture; empty when it was closed or is not there.
    ReferenceChosen(PathBuf),
    /// A picture was written to this path, without extension, or not for this reason.
    Written(Result<PathBuf, String>),
    /// The open file has changed.
    Changed,
}

/// Open file, its report and watch, and the threads that are busy with files.
#[derive(Debug)]
pub(super) struct Files {
    ctx: Context,
    loader: Loader,
    watch: Option<FileWatch>,
    sender: Sender<FileEvent>,
    inbox: Receiver<FileEvent>,
    has_dialog: bool,
    writer: Option<JoinHandle<()>>,
    /// The report of the open file.
    pub(super) report: Option<ImportReport>,
}

impl Files {
    /// Nothing open; `environment` takes the place of every scene's own.
    pub(super) fn new(ctx: &Context, environment: Option<PathBuf>) -> Self {
        let (sender, inbox) = channel();
        Self {
            ctx: ctx.clone(),
            loader: Loader::new(environment),
            watch: None,
            sender,
            inbox,
            has_dialog: false,
            writer: None,
            report: None,
        }
    }

    fn wake(&self) -> impl Fn() + Send + 'static {
        let ctx = self.ctx.clone();
        move || ctx.request_repaint()
    }

    /// Starts reading.
    ///
    /// # Errors
    /// When no thread can be started.
    pub(super) fn open(&mut self, path: &Path, is_reload: bool) -> Result<(), String> {
        let wake = self.wake();
        self.loader.start(path, is_reload, wake)
    }

    /// Stops reading.
    pub(super) fn cancel_loading(&mut self) -> bool {
        let was_loading = self.loader.status().is_some();
        self.loader.cancel();
        was_loading
    }

    /// The file being read.
    pub(super) fn loading(&self) -> Option<LoadStatus> {
        self.loader.status()
    }

    /// Follows changes of `path` from now on, or of nothing.
    pub(super) fn watch(&mut self, path: Option<&Path>) {
        self.watch = path.and_then(|path| FileWatch::new(path, self.wake()));
    }

    /// True when a file is being followed.
    pub(super) fn is_watching(&self) -> bool {
        self.watch.is_some()
    }

    /// Everything that happened since the last call.
    pub(super) fn poll(&mut self) -> Vec<FileEvent> {
        let mut events: Vec<FileEvent> = self.inbox.try_iter().collect();
        for event in &events {
            match event {
                FileEvent::Chosen(_) | FileEvent::ReferenceChosen(_) => self.has_dialog = false,
                FileEvent::Load(_) | FileEvent::Written(_) | FileEvent::Changed => {}
            }
        }
        events.extend(self.loader.poll().map(FileEvent::Load));
        match self.watch.as_ref().map(FileWatch::poll) {
            Some(Ok(true)) => events.push(FileEvent::Changed),
            Some(Err(wait)) => self.ctx.request_repaint_after(wait),
            Some(Ok(false)) | None => {}
        }
        events
    }

    /// Shows the system's file dialog, which may not exist.
    pub(super) fn ask_for_file(&mut self, folder: Option<&Path>) {
        let mut dialog = rfd::FileDialog::new()
            .set_title("Open a scene")
            .add_filter("COLLADA", &["dae"])
            .add_filter("All files", &["*"]);
        if let Some(folder) = folder {
            dialog = dialog.set_directory(folder);
        }
        self.show_dialog(dialog, FileEvent::Chosen);
    }

    /// The same for a finished picture.
    pub(super) fn ask_for_reference(&mut self) {
        let dialog = rfd::FileDialog::new()
            .set_title("Compare with a finished picture")
            .add_filter("Linear pictures", &["exr", "hdr", "pfm"])
            .add_filter("All files", &["*"]);
        self.show_dialog(dialog, FileEvent::ReferenceChosen);
    }

    fn show_dialog(&mut self, dialog: rfd::FileDialog, event: fn(PathBuf) -> FileEvent) {
        if self.has_dialog {
            return;
        }
        let (sender, wake) = (self.sender.clone(), self.wake());
        let thread = std::thread::Builder::new().name("file dialog".to_owned());
        self.has_dialog = thread
            .spawn(move || {
                // An empty path stands for a dialog that was closed or is not there.
                let chosen = dialog.pick_file().unwrap_or_default();
                drop(sender.send(event(chosen)));
                wake();
            })
            .is_ok();
    }

    /// Writes a picture; the answer comes as an event.
    pub(super) fn write(&mut self, request: SnapshotRequest) {
        // One after the other, so that numbers are given in order.
        let before = self.writer.take();
        let (sender, wake) = (self.sender.clone(), self.wake());
        let thread = std::thread::Builder::new().name("picture writer".to_owned());
        let spawned = thread.spawn(move || {
            finish(before);
            drop(sender.send(FileEvent::Written(write_snapshot(&request))));
            wake();
        });
        match spawned {
            Ok(writer) => self.writer = Some(writer),
            Err(error) => {
                let sentence = format!("cannot start a thread to write the picture: {error}");
                drop(self.sender.send(FileEvent::Written(Err(sentence))));
            }
        }
    }
}

impl Drop for Files {
    /// Waits for the last picture.
    fn drop(&mut self) {
        finish(self.writer.take());
    }
}

fn finish(thread: Option<JoinHandle<()>>) {
    if let Some(thread) = thread {
        // A panic there was reported by the panic hook.
        drop(thread.join());
    }
}
