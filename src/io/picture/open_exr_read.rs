use std::path::Path;

use exr::meta::MetaData;
use exr::meta::attribute::AttributeValue;
use exr::prelude::{AnyChannels, FlatSamples, Image as ExrImage, Layer, ReadChannels, ReadLayers};

use crate::color::Rgb;
use crate::image::Image;

use super::{MAX_PIXELS, Metadata, Picture, PictureError};

type FlatLayer = Layer<AnyChannels<FlatSamples>>;

/// Reads OpenEXR: half, float or integer channels in any order, one grey channel `Y`, any data
/// window. The picture is the display window; pixels outside the data window are black.
///
/// # Errors
/// When the file cannot be read, is damaged, has no colour channels or uses a compression that is
/// not supported.
pub fn read_exr(path: &Path) -> Result<Picture, PictureError> {
    let decode_error = |reason: String| PictureError::Decode {
        path: path.into(),
        reason,
    };
    let exr_error = |error: exr::error::Error| match error {
        exr::error::Error::Io(source) => PictureError::Io {
            path: path.into(),
            source,
        },
        other => decode_error(format!("the OpenEXR decoder says '{other}'")),
    };
    let header = MetaData::read_from_file(path, false).map_err(exr_error)?;
    let is_too_large = header.headers.iter().any(|h| {
        let windows = [h.layer_size, h.shared_attributes.display_window.size];
        windows
            .iter()
            .any(|s| s.width().saturating_mul(s.height()) > MAX_PIXELS)
    });
    if is_too_large {
        return Err(decode_error("its size in pixels is not supported".into()));
    }
    let file = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_file(path)
        .map_err(exr_error)?;
    let image = assemble(&file).map_err(|reason| decode_error(reason.to_owned()))?;
    Ok(Picture {
        image,
        metadata: metadata_of(&file.layer_data),
    })
}

fn assemble(file: &ExrImage<FlatLayer>) -> Result<Image<Rgb>, &'static str> {
    let layer = &file.layer_data;
    let channels = find_channels(layer)?;
    let values = channels.map(|samples| samples.values_as_f32().collect::<Vec<f32>>());
    let window = file.attributes.display_window;
    let (width, height) = (window.size.width(), window.size.height());
    // From display window to data window.
    let shift = window.position - layer.attributes.layer_position;
    let (columns, rows) = (layer.size.width() as i64, layer.size.height() as i64);
    let pixels = (0..width * height)
        .map(|i| {
            let x = (i % width) as i64 + i64::from(shift.x());
            let y = (i / width) as i64 + i64::from(shift.y());
            if !(0..columns).contains(&x) || !(0..rows).contains(&y) {
                return Rgb::ZERO;
            }
            let at = (y * columns + x) as usize;
            Rgb::new(values[0][at], values[1][at], values[2][at])
        })
        .collect();
    Ok(Image::from_pixels(width, height, pixels))
}

/// Red, green and blue: the channels of these names, else the first of which the last part of the
/// name (after a dot) is so called, else the grey channel `Y` three times.
fn find_channels(layer: &FlatLayer) -> Result<[&FlatSamples; 3], &'static str> {
    let list = &layer.channel_data.list;
    let named = |wanted: &str| {
        let full = list.iter().find(|c| c.name.to_string() == wanted);
        full.or_else(|| {
            let ending = format!(".{wanted}");
            list.iter().find(|c| c.name.to_string().ends_with(&ending))
        })
    };
    let found = match (named("R"), named("G"), named("B"), named("Y")) {
        (Some(r), Some(g), Some(b), _) => [r, g, b],
        (_, _, _, Some(y)) => [y, y, y],
        _ => return Err("it has neither the channels R, G, B nor Y"),
    };
    let is_whole = |samples: &FlatSamples| samples.len() == layer.size.area();
    if found.iter().all(|c| is_whole(&c.sample_data)) {
        Ok(found.map(|c| &c.sample_data))
    } else {
        Err("its colour channels are subsampled, which is not supported")
    }
}

fn metadata_of(layer: &FlatLayer) -> Metadata {
    let mut metadata = Metadata::default();
    for (name, value) in &layer.attributes.other {
        if let AttributeValue::Text(text) = value {
            let text = String::from_utf8_lossy(text.as_slice()).into_owned();
            metadata.insert_prefixed(&name.to_string(), text);
        }
    }
    metadata
}
