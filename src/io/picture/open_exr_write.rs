use std::io::{Cursor, Write};
use std::path::Path;

use exr::meta::attribute::{AttributeValue, Chromaticities};
use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image as ExrImage, Layer,
    LayerAttributes, LineOrder, SmallVec, Text, Vec2, WritableImage,
};

use crate::color::Rgb;

use super::metadata::PREFIX;
use super::whole_file::write_whole;
use super::{Metadata, OutputError};

/// The primaries and the white point of Rec.709 (ITU-R BT.709-6, table 1) as CIE x, y.
const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.3, 0.6),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.329),
};

/// Writes OpenEXR: 32-bit float channels R, G, B, ZIP compression, the metadata as text attributes.
/// Equal pixels and metadata give equal bytes.
///
/// # Errors
/// When the file cannot be written.
///
/// # Panics
/// When `pixels` does not hold `width · height` values.
pub fn write_exr(
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
    let bytes = encode(width, height, pixels, metadata).map_err(|error| OutputError::Encode {
        path: path.into(),
        reason: error.to_string(),
    })?;
    write_whole(path, |file| {
        file.write_all(&bytes).map_err(|source| OutputError::Io {
            path: path.into(),
            source,
        })
    })
}

fn encode(
    width: usize,
    height: usize,
    pixels: &[Rgb],
    metadata: &Metadata,
) -> exr::error::Result<Vec<u8>> {
    let channel = |name, index: usize| {
        let samples = pixels.iter().map(|p| p[index]).collect();
        AnyChannel::new(name, FlatSamples::F32(samples))
    };
    let channels = AnyChannels::sort(SmallVec::from_vec(vec![
        channel("R", 0),
        channel("G", 1),
        channel("B", 2),
    ]));
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let layer = Layer::new((width, height), attributes(metadata), encoding, channels);
    let mut image = ExrImage::from_layer(layer);
    image.attributes.chromaticities = Some(REC_709);
    let mut bytes = Vec::new();
    image
        .write()
        .non_parallel()
        .to_buffered(Cursor::new(&mut bytes))?;
    sort_attributes(&mut bytes);
    Ok(bytes)
}

fn attributes(metadata: &Metadata) -> LayerAttributes {
    let utf8 = |text: &str| Text::from_slice_unchecked(text.as_bytes());
    let mut attributes = LayerAttributes {
        software_name: Some(utf8(concat!("softbox ", env!("CARGO_PKG_VERSION")))),
        comments: metadata.get(Metadata::COMMAND).map(utf8),
        ..LayerAttributes::default()
    };
    for (key, value) in metadata.iter() {
        let name = utf8(&format!("{PREFIX}{key}"));
        let _ = attributes
            .other
            .insert(name, AttributeValue::Text(utf8(value)));
    }
    attributes
}

/// Puts the attributes of the one header into the order of their names: the encoder keeps ours in a
/// hash map, whose order changes from run to run.
///
/// Layout: OpenEXR file layout, "Header": name 0, type 0, size (i32, little-endian), value; an
/// empty name ends the header.
fn sort_attributes(bytes: &mut [u8]) {
    const START: usize = 8;
    let text_end = |from: usize| {
        bytes[from..]
            .iter()
            .position(|&b| b == 0)
            .map(|n| from + n + 1)
    };
    let mut entries = Vec::new();
    let mut at = START;
    while bytes.get(at).is_some_and(|&b| b != 0) {
        let Some(size_at) = text_end(at).and_then(text_end) else {
            return;
        };
        let Some(raw) = bytes.get(size_at..size_at + 4) else {
            return;
        };
        let size = i32::from_le_bytes([raw[0], raw[1], raw[2], raw[3]]);
        let end = size_at + 4 + usize::try_from(size).unwrap_or(0);
        let Some(entry) = bytes.get(at..end) else {
            return;
        };
        entries.push(entry.to_vec());
        at = end;
    }
    entries.sort();
    let sorted = entries.concat();
    bytes[START..START + sorted.len()].copy_from_slice(&sorted);
}
