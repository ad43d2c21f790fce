//! Pictures in files: linear data as OpenEXR, Radiance HDR or PFM, displayed bytes as PNG, each with
//! the words that tell how the picture came about. A file appears whole or not at all.

mod error;
mod format;
mod metadata;
mod open_exr_read;
mod open_exr_write;
mod output_path;
mod pfm;
mod png_file;
mod radiance;
mod whole_file;

use std::path::Path;

pub use error::{OutputError, PictureError};
pub use format::PictureFormat;
pub use metadata::Metadata;
pub use open_exr_read::read_exr;
pub use open_exr_write::write_exr;
pub use output_path::{append_extension, check_writable, numbered_path};
pub use pfm::{read_pfm, write_pfm};
pub use png_file::{read_png, write_png};
pub use radiance::{read_hdr, write_hdr};
pub(super) use whole_file::write_whole;

use crate::color::Rgb;
use crate::image::Image;

/// Pictures with more pixels than this are refused when read (a 16 384 × 16 384 picture fits), so
/// that a broken header cannot exhaust the memory.
const MAX_PIXELS: usize = 1 << 28;

/// A picture read from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Linear Rec.709 values, y down.
    pub image: Image<Rgb>,
    /// What softbox wrote beside the pixels; empty for files of other programs.
    pub metadata: Metadata,
}

/// Reads linear data: OpenEXR, Radiance HDR or PFM, by content.
///
/// # Errors
/// [`PictureError::NotLinear`] for PNG, which holds displayed bytes; otherwise when the file cannot
/// be read or decoded.
pub fn read_picture(path: &Path) -> Result<Picture, PictureError> {
    match format::detect(path)? {
        PictureFormat::Exr => read_exr(path),
        PictureFormat::Hdr => read_hdr(path),
        PictureFormat::Pfm => read_pfm(path),
        PictureFormat::Png => Err(PictureError::NotLinear { path: path.into() }),
    }
}

/// Reads a picture of the surroundings: as [`read_picture`], and PNG decoded from sRGB to linear.
///
/// # Errors
/// When the file cannot be read or decoded.
pub fn read_environment(path: &Path) -> Result<Picture, PictureError> {
    match format::detect(path)? {
        PictureFormat::Png => read_png(path),
        _ => read_picture(path),
    }
}

/// Writes linear data in the format that the extension names: `.exr`, `.hdr` or `.pfm`.
///
/// # Errors
/// For an extension without linear data (`.png` needs displayed bytes, see [`write_png`]) and when
/// the file cannot be written.
///
/// # Panics
/// When `pixels` does not hold `width · height` values.
pub fn write_linear(
    path: &Path,
    width: usize,
    height: usize,
    pixels: &[Rgb],
    metadata: &Metadata,
) -> Result<(), OutputError> {
    match PictureFormat::from_path(path) {
        Some(PictureFormat::Exr) => write_exr(path, width, height, pixels, metadata),
        Some(PictureFormat::Hdr) => write_hdr(path, width, height, pixels, metadata),
        Some(PictureFormat::Pfm) => write_pfm(path, width, height, pixels),
        Some(PictureFormat::Png) | None => Err(OutputError::NoLinearFormat { path: path.into() }),
    }
}
