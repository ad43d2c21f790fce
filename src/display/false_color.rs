use serde::{Deserialize, Serialize};

use crate::color::{Rgb, srgb_byte};

use super::tone_map::NAN_COLOR;

/// How a number becomes a colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ColorMap {
    /// Blue at 0, green at ½, red at 1, as in the course's picture of the sampling rate.
    Rate,
    /// Dark violet at 0 over red to light yellow at 1, even steps of perceived lightness.
    Heat,
    /// Black at 0, white at 1, as displayed.
    Grey,
}

/// The largest number of values that [`value_range`] looks at.
const RANGE_SAMPLES: usize = 65_536;

/// Numbers as displayed bytes: `range.0` gets the map's first colour, `range.1` its last, NaN
/// magenta. An empty range shows everything at the first colour.
pub fn false_color(values: &[f32], map: ColorMap, range: (f32, f32)) -> Vec<[u8; 3]> {
    let width = range.1 - range.0;
    let table: Vec<[u8; 3]> = (0..=1023).map(|i| color(i as f32 / 1023.0, map)).collect();
    let look_up = |value: f32| {
        if value.is_nan() {
            return NAN_COLOR;
        }
        let t = if width > 0.0 {
            ((value - range.0) / width).clamp(0.0, 1.0)
        } else {
            0.0
        };
        table[(t * 1023.0 + 0.5) as usize]
    };
    values.iter().map(|&v| look_up(v)).collect()
}

/// From the smallest value to the 99th percentile, so that a few outliers do not darken the rest;
/// large pictures are thinned out. (0, 1) when no value is finite.
pub fn value_range(values: &[f32]) -> (f32, f32) {
    let step = values.len().div_ceil(RANGE_SAMPLES).max(1);
    let mut finite: Vec<f32> = values.iter().copied().step_by(step).collect();
    finite.retain(|v| v.is_finite());
    if finite.is_empty() {
        return (0.0, 1.0);
    }
    let rank = (finite.len() - 1) * 99 / 100;
    let (below, high, _) = finite.select_nth_unstable_by(rank, f32::total_cmp);
    let low = below.iter().copied().fold(*high, f32::min);
    (low, *high)
}

/// The displayed colour of `t` in 0..1.
fn color(t: f32, map: ColorMap) -> [u8; 3] {
    let byte = |x: f32| (x.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    match map {
        ColorMap::Rate if t < 0.5 => [0, byte(2.0 * t), byte(1.0 - 2.0 * t)],
        ColorMap::Rate => [byte(2.0 * t - 1.0), byte(2.0 - 2.0 * t), 0],
        ColorMap::Heat => heat(t).to_array().map(srgb_byte),
        ColorMap::Grey => [byte(t); 3],
    }
}

/// A path through Oklab: lightness rises evenly from 0.18 to 0.96 while the hue turns from violet
/// (−70°) over red to yellow (105°); the chroma fades towards both ends to stay inside Rec.709.
fn heat(t: f32) -> Rgb {
    let lightness = 0.18 + 0.78 * t;
    let hue = (-70.0 + 175.0 * t).to_radians();
    let chroma = 0.05 + 0.49 * t * (1.0 - t);
    oklab_to_linear(lightness, chroma * hue.cos(), chroma * hue.sin())
}

/// Ottosson 2020, "A perceptual color space for image processing".
fn oklab_to_linear(lightness: f32, a: f32, b: f32) -> Rgb {
    let l = (lightness + 0.396_337_78 * a + 0.215_803_76 * b).powi(3);
    let m = (lightness - 0.105_561_346 * a - 0.063_854_17 * b).powi(3);
    let s = (lightness - 0.089_484_18 * a - 1.291_485_5 * b).powi(3);
    Rgb::new(
        4.076_741_7 * l - 3.307_711_6 * m + 0.230_969_94 * s,
        -1.268_438 * l + 2.609_757_4 * m - 0.341_319_38 * s,
        -0.004_196_086_3 * l - 0.703_418_6 * m + 1.707_614_7 * s,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::{luminance, srgb_decode};

    #[test]
    fn the_rate_goes_from_blue_over_green_to_red() {
        let shown = false_color(&[0.0, 8.0, 16.0, 4.0], ColorMap::Rate, (0.0, 16.0));
        assert_eq!(shown[0], [0, 0, 255]);
        assert!(shown[1][1] >= 254 && shown[1][0] <= 1 && shown[1][2] <= 1);
        assert_eq!(shown[2], [255, 0, 0]);
        assert!(shown[3][0] == 0 && shown[3][1].abs_diff(shown[3][2]) <= 1);
    }

    #[test]
    fn heat_rises_in_even_steps_of_lightness() {
        // CIE 1976 L* of the displayed colour.
        let lightness = |t: f32| {
            let linear = color(t, ColorMap::Heat).map(|c| srgb_decode(f32::from(c) / 255.0));
            116.0 * luminance(Rgb::from_array(linear)).cbrt() - 16.0
        };
        let steps: Vec<f32> = (0..16)
            .map(|i| lightness((i + 1) as f32 / 16.0) - lightness(i as f32 / 16.0))
            .collect();
        assert!(steps.iter().all(|&s| (2.5..9.0).contains(&s)), "{steps:?}");
    }

    #[test]
    fn nothing_breaks_on_odd_values_or_ranges() {
        let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 3.0];
        let shown = false_color(&odd, ColorMap::Grey, (0.0, 6.0));
        assert_eq!(shown, [NAN_COLOR, [255; 3], [0; 3], [128; 3]]);
        assert_eq!(
            false_color(&[3.0], ColorMap::Rate, (3.0, 3.0)),
            [[0, 0, 255]]
        );
        assert_eq!(value_range(&[f32::NAN]), (0.0, 1.0));
        assert_eq!(value_range(&[]), (0.0, 1.0));
    }

    #[test]
    fn outliers_do_not_stretch_the_range() {
        let mut values: Vec<f32> = (1..=200).map(|i| i as f32).collect();
        values.push(1e9);
        assert_eq!(value_range(&values), (1.0, 199.0));
    }
}
