use std::ffi::OsString;
use std::path::{Path, PathBuf};

use super::whole_file::{folder_of, temporary_beside};
use super::{OutputError, PictureFormat};

/// Finds out before a render whether its picture can be written, and leaves nothing behind.
///
/// # Errors
/// One sentence: unknown extension, missing folder, a folder or device in place of the file, a
/// read-only file, or no permission to create files in the folder.
pub fn check_writable(path: &Path) -> Result<(), OutputError> {
    let path_buf = || path.to_path_buf();
    if path.is_dir() {
        return Err(OutputError::NotAFile { path: path_buf() });
    }
    if PictureFormat::from_path(path).is_none() {
        return Err(OutputError::UnknownExtension { path: path_buf() });
    }
    let folder = folder_of(path);
    if !folder.is_dir() {
        return Err(OutputError::NoFolder {
            path: path_buf(),
            folder: folder.into(),
        });
    }
    if let Ok(existing) = path.metadata() {
        if !existing.is_file() {
            return Err(OutputError::NotAFile { path: path_buf() });
        }
        if existing.permissions().readonly() {
            return Err(OutputError::ReadOnly { path: path_buf() });
        }
    }
    temporary_beside(path)
        .map(drop)
        .map_err(|source| OutputError::Io {
            path: path_buf(),
            source,
        })
}

/// The first of `folder/stem_001`, `folder/stem_002`, … for which no file with any of `extensions`
/// (without dots) exists, so that a snapshot never overwrites another. The extension is not yet
/// part of the result, see [`append_extension`].
pub fn numbered_path(folder: &Path, stem: &str, extensions: &[&str]) -> PathBuf {
    (1_u32..)
        .map(|n| folder.join(format!("{stem}_{n:03}")))
        .find(|candidate| {
            extensions.iter().all(|extension| {
                append_extension(candidate, extension)
                    .symlink_metadata()
                    .is_err()
            })
        })
        .expect("a folder holds fewer than 2^32 files")
}

/// `path` with `.extension` after it, also when the name already holds dots.
pub fn append_extension(path: &Path, extension: &str) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(".");
    name.push(extension);
    name.into()
}
