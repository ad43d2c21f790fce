use std::ffi::OsStr;
use std::fs::File;
use std::io::Read;
use std::ops::ControlFlow;
use std::path::Path;

use super::{ImportError, ImportReport, LoadProgress, read_collada};
use crate::scene::Scene;

/// A scene and how it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The scene.
    pub scene: Scene,
    /// What was read, guessed and dropped.
    pub report: ImportReport,
}

/// Reads a scene file: `.dae` as COLLADA, and any other file as COLLADA when it starts like XML.
/// `progress` is called often; when it breaks, reading stops.
///
/// # Errors
/// [`ImportError`], whose message is fit to be shown.
pub fn load_scene(
    path: &Path,
    progress: &mut dyn FnMut(LoadProgress) -> ControlFlow<()>,
) -> Result<Loaded, ImportError> {
    check_is_file(path)?;
    let extension = path.extension().and_then(OsStr::to_str).unwrap_or("");
    if extension.eq_ignore_ascii_case("dae") || extension.eq_ignore_ascii_case("xml") {
        return read_collada(path, progress);
    }
    let start = read_start(path)?;
    if start.is_empty() {
        return Err(ImportError::Empty {
            path: path.to_owned(),
        });
    }
    if starts_like_xml(&start) {
        return read_collada(path, progress);
    }
    let found = if extension.is_empty() {
        "a file without an extension that does not start like XML".to_owned()
    } else {
        format!("a .{extension} file that does not start like XML")
    };
    Err(ImportError::UnsupportedFormat {
        path: path.to_owned(),
        found,
    })
}

/// Refuses folders, pipes and devices before anything waits on them.
pub(super) fn check_is_file(path: &Path) -> Result<u64, ImportError> {
    let metadata = std::fs::metadata(path).map_err(|error| ImportError::from_io(path, error))?;
    if metadata.is_file() {
        return Ok(metadata.len());
    }
    let kind = if metadata.is_dir() {
        "a folder"
    } else {
        "a pipe or a device"
    };
    Err(ImportError::NotAFile {
        path: path.to_owned(),
        kind,
    })
}

fn read_start(path: &Path) -> Result<Vec<u8>, ImportError> {
    let mut start = Vec::new();
    File::open(path)
        .and_then(|file| file.take(256).read_to_end(&mut start))
        .map_err(|error| ImportError::from_io(path, error))?;
    Ok(start)
}

/// True when the first sign after a byte order mark, NULs of UTF-16 and blanks is `<`.
pub(super) fn starts_like_xml(start: &[u8]) -> bool {
    start
        .iter()
        .find(|byte| {
            !matches!(byte, 0 | 0xEF | 0xBB | 0xBF | 0xFE | 0xFF) && !byte.is_ascii_whitespace()
        })
        .is_some_and(|&byte| byte == b'<')
}
