use std::io::BufReader;
use std::path::Path;

use png::{BitDepth, ColorType, SrgbRenderingIntent, Transformations};

use crate::color::{Rgb, srgb_decode};
use crate::image::Image;

use super::metadata::PREFIX;
use super::whole_file::write_whole;
use super::{MAX_PIXELS, Metadata, OutputError, Picture, PictureError};

/// Writes displayed bytes, marked as sRGB, with the metadata as text chunks.
///
/// # Errors
/// When the file cannot be written.
///
/// # Panics
/// When `pixels` does not hold `width · height` values.
pub fn write_png(
    path: &Path,
    width: usize,
    height: usize,
    pixels: &[[u8; 3]],
    metadata: &Metadata,
) -> Result<(), OutputError> {
    assert_eq!(
        pixels.len(),
        width * height,
        "a picture of {width}×{height}"
    );
    let too_large = |_| OutputError::Encode {
        path: path.into(),
        reason: "the picture is too large for PNG".to_owned(),
    };
    let columns = u32::try_from(width).map_err(too_large)?;
    let rows = u32::try_from(height).map_err(too_large)?;
    write_whole(path, |file| {
        encode(file, [columns, rows], pixels.as_flattened(), metadata).map_err(|error| {
            OutputError::Encode {
                path: path.into(),
                reason: error.to_string(),
            }
        })
    })
}

fn encode(
    file: impl std::io::Write,
    [columns, rows]: [u32; 2],
    bytes: &[u8],
    metadata: &Metadata,
) -> Result<(), png::EncodingError> {
    let mut encoder = png::Encoder::new(file, columns, rows);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    encoder.add_text_chunk(
        "Software".to_owned(),
        concat!("softbox ", env!("CARGO_PKG_VERSION")).to_owned(),
    )?;
    if let Some(command) = metadata.get(Metadata::COMMAND) {
        add_text(&mut encoder, "Comment", command)?;
    }
    for (key, value) in metadata.iter() {
        add_text(&mut encoder, &format!("{PREFIX}{key}"), value)?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(bytes)?;
    writer.finish()
}

/// Plain ASCII goes into `tEXt`, which every program shows; the rest into `iTXt`, which is UTF-8.
fn add_text<W: std::io::Write>(
    encoder: &mut png::Encoder<'_, W>,
    keyword: &str,
    text: &str,
) -> Result<(), png::EncodingError> {
    if text.is_ascii() {
        encoder.add_text_chunk(keyword.to_owned(), text.to_owned())
    } else {
        encoder.add_itxt_chunk(keyword.to_owned(), text.to_owned())
    }
}

/// Reads a PNG of any kind as 8-bit sRGB and decodes it to linear values in 0..1; alpha is dropped.
///
/// # Errors
/// When the file cannot be read or is not one.
pub fn read_png(path: &Path) -> Result<Picture, PictureError> {
    let file = std::fs::File::open(path).map_err(|source| PictureError::Io {
        path: path.into(),
        source,
    })?;
    decode(BufReader::new(file)).map_err(|reason| PictureError::Decode {
        path: path.into(),
        reason,
    })
}

fn decode(file: impl std::io::BufRead + std::io::Seek) -> Result<Picture, String> {
    let text = |error: png::DecodingError| error.to_string();
    let mut decoder = png::Decoder::new(file);
    decoder.set_transformations(Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(text)?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    if width.saturating_mul(height) > MAX_PIXELS {
        return Err("its size in pixels is not supported".to_owned());
    }
    let size = reader.output_buffer_size().ok_or("it is too large")?;
    let mut bytes = vec![0; size];
    let frame = reader.next_frame(&mut bytes).map_err(text)?;
    bytes.truncate(frame.buffer_size());
    let linear: Vec<f32> = (0..=255_u8)
        .map(|c| srgb_decode(f32::from(c) / 255.0))
        .collect();
    let at = |byte: u8| linear[usize::from(byte)];
    let pixels = match frame.color_type.samples() {
        samples @ 1..=2 => bytes
            .chunks_exact(samples)
            .map(|p| Rgb::splat(at(p[0])))
            .collect(),
        samples => bytes
            .chunks_exact(samples)
            .map(|p| Rgb::new(at(p[0]), at(p[1]), at(p[2])))
            .collect(),
    };
    // Text may also follow the pixels.
    reader.finish().map_err(text)?;
    Ok(Picture {
        image: Image::from_pixels(width, height, pixels),
        metadata: texts(reader.info()),
    })
}

fn texts(info: &png::Info<'_>) -> Metadata {
    let mut metadata = Metadata::default();
    for chunk in &info.uncompressed_latin1_text {
        metadata.insert_prefixed(&chunk.keyword, chunk.text.clone());
    }
    for chunk in &info.utf8_text {
        if let Ok(text) = chunk.get_text() {
            metadata.insert_prefixed(&chunk.keyword, text);
        }
    }
    metadata
}
