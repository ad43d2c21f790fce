//! Pictures to files: a PNG as displayed and an EXR with the linear data under one name.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use softbox::display::DisplaySettings;
use softbox::io::picture::{Metadata, append_extension, numbered_path, write_exr, write_png};
use softbox::session::Snapshot;
use softbox::settings::View;

use crate::shown::shown_bytes;

/// A picture to write.
#[derive(Clone, Debug)]
pub(super) struct SnapshotRequest {
    /// The pixels.
    pub(super) snapshot: Arc<Snapshot>,
    /// How they are displayed.
    pub(super) display: DisplaySettings,
    /// The scene's name.
    pub(super) scene_name: String,
    /// The scene's file.
    pub(super) scene_path: Option<PathBuf>,
    /// What the files say about themselves.
    pub(super) metadata: Metadata,
}

/// Writes both files and returns their common path without extension. Never overwrites.
///
/// # Errors
/// One sentence, when a file cannot be written.
pub(super) fn write_snapshot(request: &SnapshotRequest) -> Result<PathBuf, String> {
    let snapshot = &request.snapshot;
    let folder = folder(request.scene_path.as_deref());
    let path = numbered_path(&folder, &stem(request), &["png", "exr"]);
    let (width, height) = (snapshot.width, snapshot.height);
    write_png(
        &append_extension(&path, "png"),
        width,
        height,
        &shown_bytes(snapshot, &request.display),
        &request.metadata,
    )
    .and_then(|()| {
        write_exr(
            &append_extension(&path, "exr"),
            width,
            height,
            &snapshot.pixels,
            &request.metadata,
        )
    })
    .map_err(|error| error.to_string())?;
    Ok(path)
}

fn stem(request: &SnapshotRequest) -> String {
    let name: String = request
        .scene_name
        .chars()
        .map(|c| {
            let is_safe = c.is_alphanumeric() || matches!(c, '-' | '_' | '.');
            if is_safe { c } else { '_' }
        })
        .collect();
    let view = request.snapshot.view;
    if view == View::Render {
        format!("{name}_{}spp", request.snapshot.samples_mean.round())
    } else {
        format!("{name}_{}", view.name())
    }
}

/// Beside the scene where files can be made there, else the pictures folder, the home folder, or
/// the temporary one.
pub(super) fn folder(scene: Option<&Path>) -> PathBuf {
    let beside = scene.and_then(Path::parent).map(|parent| {
        if parent.as_os_str().is_empty() {
            PathBuf::from(".")
        } else {
            parent.to_owned()
        }
    });
    let home = std::env::home_dir();
    let pictures = home.as_ref().map(|home| home.join("Pictures"));
    beside
        .into_iter()
        .chain(pictures)
        .chain(home)
        .find(|folder| is_writable(folder))
        .unwrap_or_else(std::env::temp_dir)
}

fn is_writable(folder: &Path) -> bool {
    folder.is_dir() && tempfile::Builder::new().tempfile_in(folder).is_ok()
}
