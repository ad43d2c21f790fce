//! Values of single options: from the text on the command line, and back.

use glam::DVec3;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde::de::value::{Error as NameError, StrDeserializer};
use softbox::image::Region;

/// Largest picture, as the formats and the memory allow.
const MAX_PIXELS: u64 = 1 << 28;

/// A setting that is one of several names, as the settings' own definition spells them.
pub(crate) fn named<T: DeserializeOwned>(text: &str) -> Result<T, String> {
    T::deserialize(StrDeserializer::<NameError>::new(text)).map_err(|error| error.to_string())
}

/// The reverse of [`named`].
pub(crate) fn name_of<T: Serialize>(value: T) -> String {
    let value = serde_json::to_value(value).expect("a name is valid JSON");
    value.as_str().expect("the setting is a name").to_owned()
}

/// `WIDTHxHEIGHT`.
pub(crate) fn size(text: &str) -> Result<[u32; 2], String> {
    let wrong = || format!("'{text}' is not a size: give WIDTHxHEIGHT, such as 800x600");
    let (width, height) = text.split_once(['x', 'X', '×']).ok_or_else(wrong)?;
    let parse = |word: &str| word.trim().parse::<u32>().map_err(|_| wrong());
    check_size([parse(width)?, parse(height)?])
}

/// A size that can be rendered.
pub(crate) fn check_size([width, height]: [u32; 2]) -> Result<[u32; 2], String> {
    let pixels = u64::from(width) * u64::from(height);
    if pixels == 0 || pixels > MAX_PIXELS {
        return Err(format!("a picture cannot have {width}x{height} pixels"));
    }
    Ok([width, height])
}

/// `X,Y,WIDTH,HEIGHT` from the top left.
pub(crate) fn region(text: &str) -> Result<Region, String> {
    let numbers: Vec<u32> = list(text).map_err(|()| {
        format!("'{text}' is not a region: give X,Y,WIDTH,HEIGHT in pixels from the top left")
    })?;
    match numbers[..] {
        [x, y, width, height] if width > 0 && height > 0 => Ok(Region {
            x,
            y,
            width,
            height,
        }),
        _ => Err(format!(
            "'{text}' is not a region: it needs four numbers, width and height above 0"
        )),
    }
}

/// `X,Y,Z`.
pub(crate) fn point(text: &str) -> Result<DVec3, String> {
    match list::<f64>(text).as_deref() {
        Ok(&[x, y, z]) if DVec3::new(x, y, z).is_finite() => Ok(DVec3::new(x, y, z)),
        _ => Err(format!("'{text}' is not a point: give X,Y,Z")),
    }
}

/// An opening angle in degrees, between 0 and 180.
pub(crate) fn degrees(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(angle) if angle > 0.0 && angle < 180.0 => Ok(angle),
        _ => Err(format!(
            "'{text}' is not an angle between 0 and 180 degrees"
        )),
    }
}

/// A finite number above 0.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number > 0.0 && number.is_finite() => Ok(number),
        _ => Err(format!("'{text}' is not a number above 0")),
    }
}

/// A finite number, 0 or above.
pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number >= 0.0 && number.is_finite() => Ok(number),
        _ => Err(format!("'{text}' is not a number of at least 0")),
    }
}

/// A finite number.
pub(crate) fn finite(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(format!("'{text}' is not a finite number")),
    }
}

/// `BATCH,TOLERANCE` of adaptive sampling.
pub(crate) fn batch_and_tolerance(text: &str) -> Result<(u32, f32), String> {
    let (batch, tolerance) = text
        .split_once(',')
        .ok_or_else(|| format!("'{text}' is not BATCH,TOLERANCE, such as 64,0.05"))?;
    check_batch(batch.trim(), tolerance.trim())
}

/// The two numbers of adaptive sampling: at least one sample, a tolerance of at least 0.
pub(crate) fn check_batch(batch: &str, tolerance: &str) -> Result<(u32, f32), String> {
    let count = batch.parse::<u32>().ok().filter(|&count| count > 0);
    let count = count.ok_or_else(|| format!("'{batch}' is not a whole number of samples"))?;
    let fraction = tolerance.parse::<f32>().ok();
    let fraction = fraction.filter(|&fraction| fraction >= 0.0 && fraction.is_finite());
    let fraction =
        fraction.ok_or_else(|| format!("'{tolerance}' is not a tolerance, such as 0.05"))?;
    Ok((count, fraction))
}

fn list<T: std::str::FromStr>(text: &str) -> Result<Vec<T>, ()> {
    text.split(',')
        .map(|word| word.trim().parse().map_err(|_| ()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use softbox::settings::{AdaptiveGoal, Mode, View};

    #[test]
    fn names_are_those_of_the_settings() {
        for mode in Mode::ALL {
            assert_eq!(named(mode.name()), Ok(mode));
            assert_eq!(name_of(mode), mode.name());
        }
        for view in View::ALL {
            assert_eq!(named(view.name()), Ok(view));
        }
        assert_eq!(named("course"), Ok(AdaptiveGoal::Course));
        assert!(named::<Mode>("worst").unwrap_err().contains("`best`"));
    }

    #[test]
    fn values_are_read_or_refused_with_a_reason() {
        assert_eq!(size("480x360"), Ok([480, 360]));
        assert!(size("480").is_err() && size("0x5").is_err() && size("99999x99999").is_err());
        assert_eq!(point("-1, 2.5,3e2"), Ok(DVec3::new(-1.0, 2.5, 300.0)));
        assert!(point("1,2").is_err() && point("1,2,nan").is_err());
        assert!(degrees("31").is_ok() && degrees("180").is_err());
        assert!(
            region("1,2,3,4").is_ok() && region("1,2,0,4").is_err() && region("1,2,3").is_err()
        );
        assert_eq!(batch_and_tolerance("64,0.05"), Ok((64, 0.05)));
        assert!(batch_and_tolerance("0,0.05").is_err() && batch_and_tolerance("64,-1").is_err());
        assert!(positive("0").is_err() && not_negative("0").is_ok() && finite("inf").is_err());
    }
}
