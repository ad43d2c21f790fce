use crate::color::{Rgb, srgb_byte};

use super::{DisplaySettings, ToneCurve};

/// What a pixel that holds a NaN looks like: magenta, which no tone curve makes from grey light, so
/// that a broken pixel is seen.
pub(super) const NAN_COLOR: [u8; 3] = [255, 0, 255];

/// Linear pixels as displayed bytes, exactly: for files.
///
/// Negative values show as 0, values beyond the curve (and infinity) as 255, NaN as magenta.
pub fn tone_map(pixels: &[Rgb], display: &DisplaySettings) -> Vec<[u8; 3]> {
    pixels.iter().map(|&p| tone_map_pixel(p, display)).collect()
}

/// One pixel of [`tone_map`].
pub fn tone_map_pixel(pixel: Rgb, display: &DisplaySettings) -> [u8; 3] {
    if pixel.is_nan() {
        return NAN_COLOR;
    }
    let gain = display.gain();
    pixel
        .to_array()
        .map(|channel| display_byte(channel * gain, display.tone_curve))
}

/// One exposed linear value as a displayed byte; NaN shows as 0.
pub fn display_byte(exposed: f32, curve: ToneCurve) -> u8 {
    match curve {
        ToneCurve::Course => course_byte(exposed),
        _ => srgb_byte(compress(exposed, curve)),
    }
}

/// The part of the curve before the transfer function: from 0..∞ to 0..1 (0..∞ for curves that
/// clip).
///
/// Reinhard, Stark, Shirley, Ferwerda 2002, "Photographic Tone Reproduction for Digital Images",
/// equation 3; Narkowicz 2015, "ACES Filmic Tone Mapping Curve".
pub(super) fn compress(exposed: f32, curve: ToneCurve) -> f32 {
    // Far beyond white both rational curves have reached 1 in f32; infinity must not become NaN.
    let x = exposed.clamp(0.0, 1e9);
    match curve {
        ToneCurve::Srgb | ToneCurve::Course => x,
        ToneCurve::Reinhard => x / (1.0 + x),
        ToneCurve::Filmic => (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14),
    }
}

/// The course program's conversion: floor(255 · clamp((√2 · L)^(1/2.2))).
fn course_byte(exposed: f32) -> u8 {
    let encoded = (std::f32::consts::SQRT_2 * exposed.max(0.0)).powf(1.0 / 2.2);
    // The cast truncates and turns NaN into 0.
    (255.0 * encoded.min(1.0)) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(tone_curve: ToneCurve) -> DisplaySettings {
        DisplaySettings {
            exposure: 0.0,
            tone_curve,
        }
    }

    #[test]
    fn srgb_is_exact_at_known_codes() {
        let display = with(ToneCurve::Srgb);
        let map = |x: f32| tone_map_pixel(Rgb::splat(x), &display)[0];
        // IEC 61966-2-1: linear 0.214041 is code 127.5, 0.5 is 187.5 (rounded up to 188).
        assert_eq!([map(0.0), map(0.5), map(1.0), map(7.0)], [0, 188, 255, 255]);
        assert_eq!(map(0.003_130_8), 10);
    }

    #[test]
    fn the_course_curve_follows_its_formula() {
        let display = with(ToneCurve::Course);
        let map = |x: f32| tone_map_pixel(Rgb::splat(x), &display)[0];
        assert_eq!(map(0.0), 0);
        // (√2 · 0.1)^(1/2.2) = 0.41100; · 255 = 104.8.
        assert_eq!(map(0.1), 104);
        // Clips at 1/√2 = 0.7071.
        assert_eq!([map(0.700), map(0.7072)], [253, 255]);
    }

    #[test]
    fn every_curve_is_monotone_and_survives_anything() {
        for curve in ToneCurve::ALL {
            let ramp: Vec<u8> = (0..4000)
                .map(|i| display_byte(i as f32 / 250.0, curve))
                .collect();
            assert!(ramp.is_sorted(), "{curve:?}");
            let display = with(curve);
            let map = |x| tone_map_pixel(Rgb::splat(x), &display);
            assert_eq!(map(f32::NAN), NAN_COLOR);
            assert_eq!(map(f32::INFINITY), [255; 3]);
            assert_eq!(map(f32::MAX), [255; 3]);
            assert_eq!(map(-1.0), [0; 3]);
            assert_eq!(map(f32::NEG_INFINITY), [0; 3]);
            assert_eq!(map(1e-40), [0; 3]);
        }
    }

    #[test]
    fn one_stop_doubles_the_light() {
        let stop = DisplaySettings {
            exposure: 1.0,
            ..DisplaySettings::default()
        };
        let pixels = [Rgb::new(0.1, 0.2, 0.3)];
        assert_eq!(
            tone_map(&pixels, &stop),
            tone_map(&[pixels[0] * 2.0], &DisplaySettings::default())
        );
        assert_ne!(
            tone_map(&pixels, &stop),
            tone_map(&pixels, &DisplaySettings::default())
        );
    }
}
