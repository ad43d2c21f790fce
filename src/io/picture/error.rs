use std::io;
use std::path::PathBuf;

/// Why a picture cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// No known picture format has this extension.
    #[error("Cannot write '{}': the name must end in .png, .exr, .hdr or .pfm.", path.display())]
    UnknownExtension {
        /// The output.
        path: PathBuf,
    },
    /// Linear data was given for a format that does not hold it.
    #[error("Cannot write linear data to '{}': the name must end in .exr, .hdr or .pfm.", path.display())]
    NoLinearFormat {
        /// The output.
        path: PathBuf,
    },
    /// The folder is missing.
    #[error("Cannot write '{}': the folder '{}' does not exist.", path.display(), folder.display())]
    NoFolder {
        /// The output.
        path: PathBuf,
        /// Its folder.
        folder: PathBuf,
    },
    /// The name is taken by something that is not a file.
    #[error("Cannot write '{}': it exists and is not a file.", path.display())]
    NotAFile {
        /// The output.
        path: PathBuf,
    },
    /// The file exists and is marked read-only.
    #[error("Cannot write '{}': the file is read-only.", path.display())]
    ReadOnly {
        /// The output.
        path: PathBuf,
    },
    /// The operating system refused.
    #[error("Cannot write '{}': {source}.", path.display())]
    Io {
        /// The output.
        path: PathBuf,
        /// Its reason.
        source: io::Error,
    },
    /// The encoder refused.
    #[error("Cannot write '{}': {reason}.", path.display())]
    Encode {
        /// The output.
        path: PathBuf,
        /// The encoder's reason.
        reason: String,
    },
}

/// Why a picture cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The operating system refused.
    #[error("Cannot read '{}': {source}.", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// Its reason.
        source: io::Error,
    },
    /// The content is of no known format.
    #[error("Cannot read '{}': it is not an OpenEXR, Radiance HDR, PFM or PNG picture.", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// The file is damaged or uses a feature that is not supported.
    #[error("Cannot read '{}': {reason}.", path.display())]
    Decode {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// Displayed bytes where linear data is needed.
    #[error("Cannot use '{}': a PNG holds displayed bytes, not linear data; give an .exr, .hdr or .pfm file.", path.display())]
    NotLinear {
        /// The file.
        path: PathBuf,
    },
}
