use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::OutputError;

/// Writes a file so that it appears whole or not at all: into a temporary file of the same folder,
/// which takes the name at the end. An existing file is replaced in that last step.
pub(in crate::io) fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&mut File>) -> Result<(), OutputError>,
) -> Result<(), OutputError> {
    let io_error = |source| OutputError::Io {
        path: path.into(),
        source,
    };
    let target = resolve_link(path);
    let mut temporary = temporary_beside(&target).map_err(io_error)?;
    {
        let mut writer = BufWriter::new(temporary.as_file_mut());
        write(&mut writer)?;
        writer.flush().map_err(io_error)?;
    }
    temporary
        .persist(&target)
        .map(drop)
        .map_err(|e| io_error(e.error))
}

/// An empty file in the folder of `path`, removed when dropped.
pub(super) fn temporary_beside(path: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".softbox-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder_of(path))
}

/// The folder of `path`; `.` for a bare name.
pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// The file that a symbolic link leads to, so that the link stays when the file is replaced.
fn resolve_link(path: &Path) -> PathBuf {
    if path.is_symlink() {
        path.canonicalize().unwrap_or_else(|_| path.into())
    } else {
        path.into()
    }
}
