//! Floor 0: linear Rec.709 colour and the sRGB transfer function.

use glam::Vec3;

/// Linear Rec.709 values: radiance (W·sr⁻¹·m⁻² per channel) or a reflectance in 0..1.
pub type Rgb = Vec3;

/// Relative luminance of linear Rec.709, as the course weighs it (0.2126, 0.7152, 0.0722).
pub fn luminance(rgb: Rgb) -> f32 {
    rgb.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

/// The exact piecewise sRGB encoding (IEC 61966-2-1) of one linear value; clamps to 0..1, NaN to 0.
pub fn srgb_encode(linear: f32) -> f32 {
    let x = if linear > 0.0 { linear.min(1.0) } else { 0.0 };
    if x <= 0.003_130_8 {
        12.92 * x
    } else {
        1.055 * x.powf(1.0 / 2.4) - 0.055
    }
}

/// The inverse of [`srgb_encode`].
pub fn srgb_decode(encoded: f32) -> f32 {
    if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
}

/// One linear value as an 8-bit sRGB code, rounded to nearest.
pub fn srgb_byte(linear: f32) -> u8 {
    (srgb_encode(linear) * 255.0 + 0.5) as u8
}

/// True when every channel is finite and not negative, as radiance must be.
pub fn is_valid_radiance(rgb: Rgb) -> bool {
    rgb.is_finite() && rgb.min_element() >= 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Test F9 of the stress list.
    #[test]
    fn all_codes_survive_and_the_ramp_is_monotone() {
        for code in 0..=255_u8 {
            assert_eq!(srgb_byte(srgb_decode(f32::from(code) / 255.0)), code);
        }
        let ramp: Vec<u8> = (0..65_536)
            .map(|i| srgb_byte(i as f32 / 65_535.0))
            .collect();
        assert!(ramp.is_sorted());
        assert_eq!(
            (srgb_byte(f32::NAN), srgb_byte(-1.0), srgb_byte(9.0)),
            (0, 0, 255)
        );
    }

    #[test]
    fn radiance_must_be_finite_and_not_negative() {
        assert!(is_valid_radiance(Rgb::new(0.0, 1.0, 1e30)));
        assert!(!is_valid_radiance(Rgb::new(0.0, -1e-9, 0.0)));
        assert!(!is_valid_radiance(Rgb::new(f32::NAN, 0.0, 0.0)));
    }
}
