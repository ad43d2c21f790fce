//! Notices when the open file changes on the disk.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use notify::{RecommendedWatcher, RecursiveMode, Watcher};

/// One save makes several events; this long without another one means that it is complete.
const DEBOUNCE: Duration = Duration::from_millis(200);

/// A watch on one file.
#[derive(Debug)]
pub(super) struct FileWatch {
    changed_at: Arc<Mutex<Option<Instant>>>,
    // Dropping it ends the watch.
    _watcher: RecommendedWatcher,
}

impl FileWatch {
    /// Watches `path`; `wake` is called from another thread when it changes. `None` where the
    /// system cannot watch files: then the file is read again only when asked for.
    pub(super) fn new(path: &Path, wake: impl Fn() + Send + 'static) -> Option<Self> {
        let path = path.canonicalize().ok()?;
        let folder = path.parent()?.to_owned();
        let changed_at = Arc::new(Mutex::new(None));
        let noted = Arc::clone(&changed_at);
        let file = path;
        // Editors replace files, so that only the folder can be watched.
        let mut watcher =
            notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
                if event.is_ok_and(|event| concerns(&event, &file)) {
                    *noted.lock().unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
                    wake();
                }
            })
            .ok()?;
        watcher.watch(&folder, RecursiveMode::NonRecursive).ok()?;
        Some(Self {
            changed_at,
            _watcher: watcher,
        })
    }

    /// True once after the file has changed and come to rest; else the time to ask again.
    pub(super) fn poll(&self) -> Result<bool, Duration> {
        let mut changed_at = self
            .changed_at
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let Some(since) = changed_at.map(|at| at.elapsed()) else {
            return Ok(false);
        };
        if since < DEBOUNCE {
            return Err(DEBOUNCE - since);
        }
        *changed_at = None;
        Ok(true)
    }
}

fn concerns(event: &notify::Event, file: &PathBuf) -> bool {
    !event.kind.is_access() && !event.kind.is_remove() && event.paths.contains(file)
}
