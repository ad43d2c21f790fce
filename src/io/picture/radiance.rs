use std::io::{BufReader, Write};
use std::path::Path;

use image::codecs::hdr::HdrDecoder;
use image::{DynamicImage, ImageDecoder};

use crate::color::Rgb;
use crate::image::Image;

use super::metadata::PREFIX;
use super::whole_file::write_whole;
use super::{MAX_PIXELS, Metadata, OutputError, Picture, PictureError};

/// Writes Radiance HDR: 8 bits a channel with a common exponent (Ward 1991, "Real Pixels"), flat
/// rows. Each channel is off by at most 1/256 of the pixel's largest. Negative values and NaN
/// become 0.
///
/// # Errors
/// When the file cannot be written.
///
/// # Panics
/// When `pixels` does not hold `width · height` values.
pub fn write_hdr(
    path: &Path,
    width: usize,
    height: usize,
    pixels: &[Rgb],
    metadata: &Metadata,
) -> Result<(), OutputError> {
    assert_eq!(
        pixels.len(),
        width * height,
        "a picture of {width}×{height}"
    );
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n".to_vec();
    for (key, value) in metadata.iter() {
        // A JSON text holds no line break, which would end the header line.
        let value = serde_json::Value::from(value);
        bytes.extend_from_slice(format!("{PREFIX}{key}={value}\n").as_bytes());
    }
    bytes.extend_from_slice(format!("\n-Y {height} +X {width}\n").as_bytes());
    bytes.extend(pixels.iter().flat_map(|&pixel| encode(pixel)));
    write_whole(path, |file| {
        file.write_all(&bytes).map_err(|source| OutputError::Io {
            path: path.into(),
            source,
        })
    })
}

/// Mantissas and the exponent e with value = mantissa · 2^(e − 136).
fn encode(pixel: Rgb) -> [u8; 4] {
    let clean = pixel.to_array().map(|c| f64::from(c.clamp(0.0, f32::MAX)));
    let clean = clean.map(|c| if c.is_nan() { 0.0 } else { c });
    let largest = clean.into_iter().fold(0.0, f64::max);
    if largest < 1e-38 {
        return [0; 4];
    }
    let mut exponent = largest.log2().floor() as i32 + 1;
    if (largest * 2_f64.powi(8 - exponent)).round() > 255.0 {
        exponent += 1;
    }
    // 2^127 · 255/256 is the largest value of the format.
    let exponent = exponent.min(127);
    let scale = 2_f64.powi(8 - exponent);
    let [r, g, b] = clean.map(|c| (c * scale).round().min(255.0) as u8);
    [r, g, b, (exponent + 128) as u8]
}

/// Reads Radiance HDR, flat or run-length coded; the header's exposure is taken off.
///
/// # Errors
/// When the file cannot be read or is not one.
pub fn read_hdr(path: &Path) -> Result<Picture, PictureError> {
    let decode_error = |reason: String| PictureError::Decode {
        path: path.into(),
        reason,
    };
    let file = std::fs::File::open(path).map_err(|source| PictureError::Io {
        path: path.into(),
        source,
    })?;
    let decoder =
        HdrDecoder::new_nonstrict(BufReader::new(file)).map_err(|e| decode_error(e.to_string()))?;
    let (width, height) = decoder.dimensions();
    let (width, height) = (width as usize, height as usize);
    if width.saturating_mul(height) > MAX_PIXELS {
        return Err(decode_error("its size in pixels is not supported".into()));
    }
    let header = decoder.metadata();
    let mut metadata = Metadata::default();
    for (name, value) in &header.custom_attributes {
        let text = serde_json::from_str(value).unwrap_or_else(|_| value.clone());
        metadata.insert_prefixed(name, text);
    }
    let decoded = DynamicImage::from_decoder(decoder).map_err(|e| decode_error(e.to_string()))?;
    let scale = 1.0 / header.exposure.unwrap_or(1.0);
    let pixels = decoded
        .into_rgb32f()
        .pixels()
        .map(|p| Rgb::from_array(p.0) * scale)
        .collect();
    Ok(Picture {
        image: Image::from_pixels(width, height, pixels),
        metadata,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_stay_inside_the_format() {
        assert_eq!(encode(Rgb::splat(f32::NAN)), [0; 4]);
        assert_eq!(encode(Rgb::new(-1.0, 0.0, 1e-39)), [0; 4]);
        assert_eq!(encode(Rgb::splat(1.0)), [128, 128, 128, 129]);
        assert_eq!(encode(Rgb::splat(f32::INFINITY)), [255, 255, 255, 255]);
        // 255.9/256 rounds up into the next exponent.
        assert_eq!(encode(Rgb::splat(255.9 / 256.0)), [128, 128, 128, 129]);
    }
}
