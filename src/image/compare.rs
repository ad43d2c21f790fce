use serde::{Deserialize, Serialize};

use crate::color::Rgb;

use super::Image;
use super::flip::mean_flip;
use super::score::{Score, pairs, score};

/// Edge of the blocks whose means are compared, in pixels.
const BLOCK: usize = 8;

/// How far a picture is from its reference, both linear, without clamping (but for FLIP).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// Mean over pixels and channels of (x − r)² / (r² + 0.01).
    pub rel_mse: f64,
    /// [`Self::rel_mse`] without the worst 0.1 % of the pixels.
    pub rel_mse_trimmed: f64,
    /// Mean over pixels and channels of (x − r)².
    pub mse: f64,
    /// LDR-FLIP, mean over the picture, 0 (equal) to 1; both clamped to 0..1 first.
    pub flip: f64,
    /// Mean of x − r per channel: the bias, positive where the picture is too bright.
    pub mean_difference: [f64; 3],
    /// Mean of x per channel.
    pub mean: [f64; 3],
    /// Mean of r per channel.
    pub reference_mean: [f64; 3],
    /// Largest |X − R| / (R + 0.001) of any channel over all blocks of 8 × 8 pixels, X and R being
    /// the block's means.
    pub max_block_difference: f64,
    /// Pixels that are not finite in either picture; they are left out of every figure.
    pub invalid_pixels: usize,
}

/// The pictures cannot be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CompareError {
    /// Their sizes differ.
    #[error("The picture has {} × {} pixels, its reference {} × {}.", size.0, size.1, reference.0, reference.1)]
    Size {
        /// Width and height of the picture.
        size: (usize, usize),
        /// Width and height of the reference.
        reference: (usize, usize),
    },
    /// They have no pixel at which both are finite.
    #[error("The pictures have no pixel at which both are finite.")]
    NoPixels,
}

/// Compares linear pictures.
///
/// # Errors
/// When the sizes differ or nothing is left to compare.
pub fn compare(image: &Image<Rgb>, reference: &Image<Rgb>) -> Result<Comparison, CompareError> {
    let Score {
        rel_mse,
        rel_mse_trimmed,
        mse,
        ..
    } = score(image, reference)?;
    let (mut sums, mut count) = ([glam::DVec3::ZERO; 2], 0);
    for (x, r) in pairs(image, reference)? {
        sums[0] += x.as_dvec3();
        sums[1] += r.as_dvec3();
        count += 1;
    }
    let [x, r] = sums.map(|sum| sum / count as f64);
    Ok(Comparison {
        rel_mse,
        rel_mse_trimmed,
        mse,
        flip: mean_flip(image, reference),
        mean_difference: (x - r).to_array(),
        mean: x.to_array(),
        reference_mean: r.to_array(),
        max_block_difference: max_block_difference(image, reference),
        invalid_pixels: image.pixels().len() - count,
    })
}

fn max_block_difference(image: &Image<Rgb>, reference: &Image<Rgb>) -> f64 {
    let blocks = |extent: usize| (0..extent).step_by(BLOCK);
    blocks(image.height())
        .flat_map(|y| blocks(image.width()).map(move |x| (x, y)))
        .map(|corner| block_difference(image, reference, corner))
        .fold(0.0, f64::max)
}

/// The difference of the block whose top left pixel is `corner`; 0 when no pixel is finite.
fn block_difference(image: &Image<Rgb>, reference: &Image<Rgb>, corner: (usize, usize)) -> f64 {
    let (mut x_sum, mut r_sum, mut count) = (glam::DVec3::ZERO, glam::DVec3::ZERO, 0.0);
    for y in corner.1..(corner.1 + BLOCK).min(image.height()) {
        for x in corner.0..(corner.0 + BLOCK).min(image.width()) {
            let (p, r) = (image.get(x, y), reference.get(x, y));
            if p.is_finite() && r.is_finite() {
                x_sum += p.as_dvec3();
                r_sum += r.as_dvec3();
                count += 1.0;
            }
        }
    }
    if count == 0.0 {
        return 0.0;
    }
    let (x, r) = (x_sum / count, r_sum / count);
    ((x - r).abs() / (r.abs() + 0.001)).max_element()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-6 * b.abs().max(1e-6)
    }

    #[test]
    fn the_figures_follow_their_formulas() {
        let reference = Image::from_pixels(2, 1, vec![Rgb::new(0.0, 1.0, 2.0), Rgb::splat(0.5)]);
        let image = Image::from_pixels(2, 1, vec![Rgb::new(0.5, 1.0, 1.0), Rgb::splat(0.5)]);
        let c = compare(&image, &reference).unwrap();
        assert!(close(c.rel_mse, (0.25 / 0.01 + 1.0 / 4.01) / 6.0));
        assert!(close(c.mse, 1.25 / 6.0));
        assert!(close(c.mean_difference[0], 0.25) && close(c.mean_difference[2], -0.5));
        assert!(close(c.mean[0], 0.5) && close(c.reference_mean[1], 0.75));
        // One block: means (0.5, 0.75, 0.75) against (0.25, 0.75, 1.25).
        assert!(close(c.max_block_difference, 0.25 / 0.251));
        assert_eq!((c.rel_mse_trimmed, c.invalid_pixels), (c.rel_mse, 0));
    }

    #[test]
    fn trimming_leaves_out_one_pixel_in_a_thousand() {
        let reference = Image::filled(100, 20, Rgb::splat(0.3));
        let mut pixels = reference.pixels().to_vec();
        pixels[77] = Rgb::splat(1e3);
        pixels[1500] = Rgb::splat(50.0);
        pixels[1501] = Rgb::splat(0.4);
        let c = compare(&Image::from_pixels(100, 20, pixels), &reference).unwrap();
        assert!(c.rel_mse > 1000.0);
        assert!(close(c.rel_mse_trimmed, 0.1_f64.powi(2) / 0.1 / 1998.0));
    }

    #[test]
    fn equal_pictures_have_no_error_and_broken_pixels_are_counted() {
        let mut pixels = vec![Rgb::splat(0.7); 64];
        let reference = Image::from_pixels(8, 8, pixels.clone());
        let c = compare(&reference, &reference).unwrap();
        assert_eq!(
            (c.rel_mse, c.mse, c.flip, c.max_block_difference),
            (0.0, 0.0, 0.0, 0.0)
        );
        pixels[5].y = f32::NAN;
        pixels[6].x = f32::INFINITY;
        let c = compare(&Image::from_pixels(8, 8, pixels), &reference).unwrap();
        assert_eq!(
            (c.invalid_pixels, c.rel_mse, c.max_block_difference),
            (2, 0.0, 0.0)
        );
        assert!(
            c.flip > 0.0 && c.flip < 0.7,
            "a broken pixel shows in FLIP as black"
        );
    }

    #[test]
    fn pictures_of_different_size_are_refused() {
        let (a, b) = (Image::filled(2, 3, Rgb::ONE), Image::filled(3, 2, Rgb::ONE));
        assert!(matches!(compare(&a, &b), Err(CompareError::Size { .. })));
        let empty = Image::filled(0, 0, Rgb::ONE);
        assert_eq!(compare(&empty, &empty), Err(CompareError::NoPixels));
    }
}
