use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::PictureError;

/// The formats of pictures that softbox reads and writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// Displayed bytes, sRGB.
    Png,
    /// Linear, 32 bits a channel.
    Exr,
    /// Linear, 8 bits a channel with a common exponent.
    Hdr,
    /// Linear, 32 bits a channel, no metadata.
    Pfm,
}

impl PictureFormat {
    /// The format that the extension names, in any case of letters.
    pub fn from_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "png" => Some(Self::Png),
            "exr" => Some(Self::Exr),
            "hdr" => Some(Self::Hdr),
            "pfm" => Some(Self::Pfm),
            _ => None,
        }
    }

    /// True for formats that hold linear radiance.
    pub fn is_linear(self) -> bool {
        self != Self::Png
    }
}

/// The format of an existing file, from its first bytes.
pub(super) fn detect(path: &Path) -> Result<PictureFormat, PictureError> {
    let io_error = |source| PictureError::Io {
        path: path.into(),
        source,
    };
    let mut start = Vec::with_capacity(16);
    let file = File::open(path).map_err(io_error)?;
    file.take(16).read_to_end(&mut start).map_err(io_error)?;
    let starts = |magic: &[u8]| start.starts_with(magic);
    if starts(&[0x76, 0x2F, 0x31, 0x01]) {
        Ok(PictureFormat::Exr)
    } else if starts(b"#?RADIANCE") || starts(b"#?RGBE") {
        Ok(PictureFormat::Hdr)
    } else if starts(b"PF") || starts(b"Pf") {
        Ok(PictureFormat::Pfm)
    } else if starts(b"\x89PNG") {
        Ok(PictureFormat::Png)
    } else {
        Err(PictureError::UnknownFormat { path: path.into() })
    }
}
