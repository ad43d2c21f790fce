//! LDR-FLIP: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild 2020, "FLIP: A
//! Difference Evaluator for Alternating Images". Section numbers here are the paper's.

mod color_difference;
mod features;
mod plane;

use crate::color::Rgb;

use super::Image;
use color_difference::{OpponentImage, color_difference};
use features::feature_difference;

/// Pixels per degree of the observer: 0.7 m away from a 0.7 m wide screen of 3840 pixels, the
/// paper's default.
const PIXELS_PER_DEGREE: f32 = 67.0206;

/// FLIP, mean over the picture, 0 (equal) to 1.
///
/// Both pictures are linear and are clamped to 0..1 first, as a display does; NaN counts as 0. They
/// must have the same size and at least one pixel.
pub(super) fn mean_flip(image: &Image<Rgb>, reference: &Image<Rgb>) -> f64 {
    let (test, reference) = (OpponentImage::new(image), OpponentImage::new(reference));
    let color = color_difference(&test, &reference, PIXELS_PER_DEGREE);
    let feature = feature_difference(&test.achromatic, &reference.achromatic, PIXELS_PER_DEGREE);
    // Section 4.3: features raise the colour difference.
    let pairs = color.values().iter().zip(feature.values());
    let sum: f64 = pairs.map(|(&c, &f)| f64::from(c.powf(1.0 - f))).sum();
    sum / color.values().len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(value: Rgb) -> Image<Rgb> {
        Image::filled(24, 16, value)
    }

    #[test]
    fn flat_colours_differ_by_the_colour_term_alone() {
        // Black to white is 100 in lightness: 0.95 + 0.05 (100^0.7 − 0.4 m)/(0.6 m), where m = 203^0.7
        // is the distance from green to blue.
        let flip = mean_flip(&flat(Rgb::ZERO), &flat(Rgb::ONE));
        assert!((flip - 0.967).abs() < 2e-3, "{flip}");
        // Green to blue is the largest distance there is.
        let flip = mean_flip(&flat(Rgb::Y), &flat(Rgb::Z));
        assert!((flip - 1.0).abs() < 2e-3, "{flip}");
        // Beyond white nothing is displayed.
        assert_eq!(mean_flip(&flat(Rgb::splat(3.0)), &flat(Rgb::ONE)), 0.0);
    }

    #[test]
    fn stronger_noise_is_a_larger_difference_and_order_does_not_matter() {
        let reference = flat(Rgb::splat(0.4));
        let noisy = |amount: f32| {
            let pixels = (0..24 * 16_u32)
                .map(|i| {
                    let u = (i.wrapping_mul(2_654_435_761) >> 8) as f32 / 16_777_216.0;
                    Rgb::splat(0.4 + amount * (u - 0.5))
                })
                .collect();
            Image::from_pixels(24, 16, pixels)
        };
        let flips = [0.02, 0.1, 0.4].map(|amount| mean_flip(&noisy(amount), &reference));
        assert!(
            flips.is_sorted() && flips[0] > 0.0 && flips[2] < 1.0,
            "{flips:?}"
        );
        let swapped = mean_flip(&reference, &noisy(0.4));
        assert!((swapped - flips[2]).abs() < 1e-6);
    }

    #[test]
    fn a_difference_at_an_edge_weighs_more_than_the_same_difference_without() {
        let step = |height: f32| {
            let pixels = (0..24 * 16).map(|i| Rgb::splat(if i % 24 < 12 { 0.3 } else { height }));
            Image::from_pixels(24, 16, pixels.collect())
        };
        let with_edge = mean_flip(&step(0.4), &step(0.3));
        let half_flat = mean_flip(&flat(Rgb::splat(0.4)), &flat(Rgb::splat(0.3))) / 2.0;
        assert!(with_edge > half_flat, "{with_edge} {half_flat}");
    }

    /// A picture with smooth colours and hard edges, moved to the right by `shift` columns (what
    /// leaves comes back on the left), times `gain`.
    fn pattern(shift: usize, gain: f32) -> Image<Rgb> {
        const WIDTH: usize = 120;
        let pixel = |i: usize| {
            let (x, y) = ((i % WIDTH + WIDTH - shift) % WIDTH, i / WIDTH);
            let checker = (x / 15 + y / 15) % 2;
            let red = 0.5 + 0.5 * (x as f64 / 9.0).sin();
            let green = 0.5 + 0.5 * (y as f64 / 7.0).cos();
            glam::DVec3::new(red, green, checker as f64 * 0.7 + 0.1).as_vec3() * gain
        };
        Image::from_pixels(WIDTH, 90, (0..WIDTH * 90).map(pixel).collect())
    }

    /// Figures of the authors' own program (flip-evaluator, default observer) for the same
    /// pictures.
    #[test]
    fn the_figures_are_those_of_the_authors() {
        let reference = pattern(0, 1.0);
        for (test, expected) in [(pattern(1, 1.0), 0.172_640), (pattern(0, 0.8), 0.383_776)] {
            let flip = mean_flip(&test, &reference);
            assert!((flip - expected).abs() < 2e-5, "{flip} {expected}");
        }
    }
}
