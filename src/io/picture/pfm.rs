use std::io::Write;
use std::path::Path;

use crate::color::Rgb;
use crate::image::Image;

use super::whole_file::write_whole;
use super::{MAX_PIXELS, Metadata, OutputError, Picture, PictureError};

/// Writes a portable float map: little-endian 32-bit channels, bottom row first. The format has no
/// room for metadata.
///
/// # Errors
/// When the file cannot be written.
///
/// # Panics
/// When `pixels` does not hold `width · height` values.
pub fn write_pfm(
    path: &Path,
    width: usize,
    height: usize,
    pixels: &[Rgb],
) -> Result<(), OutputError> {
    assert_eq!(
        pixels.len(),
        width * height,
        "a picture of {width}×{height}"
    );
    let mut bytes = format!("PF\n{width} {height}\n-1.0\n").into_bytes();
    bytes.reserve(pixels.len() * 12);
    for y in (0..height).rev() {
        for pixel in &pixels[y * width..(y + 1) * width] {
            for channel in pixel.to_array() {
                bytes.extend_from_slice(&channel.to_le_bytes());
            }
        }
    }
    write_whole(path, |file| {
        file.write_all(&bytes).map_err(|source| OutputError::Io {
            path: path.into(),
            source,
        })
    })
}

/// Reads a portable float map, in colour or grey, of either byte order.
///
/// # Errors
/// When the file cannot be read or is not one.
pub fn read_pfm(path: &Path) -> Result<Picture, PictureError> {
    let bytes = std::fs::read(path).map_err(|source| PictureError::Io {
        path: path.into(),
        source,
    })?;
    let image = decode(&bytes).map_err(|reason| PictureError::Decode {
        path: path.into(),
        reason: reason.to_owned(),
    })?;
    Ok(Picture {
        image,
        metadata: Metadata::default(),
    })
}

fn decode(bytes: &[u8]) -> Result<Image<Rgb>, &'static str> {
    const BROKEN: &str = "its PFM header is broken";
    let mut rest = bytes;
    let channels = match next_word(&mut rest).ok_or(BROKEN)? {
        "PF" => 3,
        "Pf" => 1,
        _ => return Err(BROKEN),
    };
    let mut number = || next_word(&mut rest).ok_or(BROKEN);
    let width: usize = number()?.parse().map_err(|_| BROKEN)?;
    let height: usize = number()?.parse().map_err(|_| BROKEN)?;
    let scale: f32 = number()?.parse().map_err(|_| BROKEN)?;
    let count = width
        .checked_mul(height)
        .filter(|&count| count > 0 && count <= MAX_PIXELS)
        .ok_or("its size in pixels is not supported")?;
    if scale == 0.0 || !scale.is_finite() {
        return Err(BROKEN);
    }
    if rest.len() < count * channels * 4 {
        return Err("it ends before its last pixel");
    }
    let value = |index: usize| {
        let raw = [0, 1, 2, 3].map(|k| rest[index * 4 + k]);
        if scale < 0.0 {
            f32::from_le_bytes(raw)
        } else {
            f32::from_be_bytes(raw)
        }
    };
    let pixel = |index: usize| match channels {
        3 => Rgb::new(value(3 * index), value(3 * index + 1), value(3 * index + 2)),
        _ => Rgb::splat(value(index)),
    };
    let pixels = (0..count)
        .map(|i| pixel((height - 1 - i / width) * width + i % width))
        .collect();
    Ok(Image::from_pixels(width, height, pixels))
}

/// Takes the next word and the single white-space byte after it off the front.
fn next_word<'a>(rest: &mut &'a [u8]) -> Option<&'a str> {
    let start = rest.iter().position(|b| !b.is_ascii_whitespace())?;
    let length = rest[start..].iter().position(u8::is_ascii_whitespace)?;
    let word = &rest[start..start + length];
    *rest = &rest[start + length + 1..];
    std::str::from_utf8(word).ok()
}
