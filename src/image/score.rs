use serde::{Deserialize, Serialize};

use crate::color::Rgb;

use super::{CompareError, Image};

/// Added to r² in relMSE so that black pixels do not divide by zero.
const REL_MSE_FLOOR: f64 = 0.01;
/// The worst of this many pixels is left out of the trimmed figure.
const TRIM_ONE_IN: usize = 1000;

/// Squared errors of a linear picture, without clamping. Cheap enough for a picture that is being
/// made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Mean over pixels and channels of (x − r)² / (r² + 0.01).
    pub rel_mse: f64,
    /// [`Self::rel_mse`] without the worst 0.1 % of the pixels.
    pub rel_mse_trimmed: f64,
    /// Mean over pixels and channels of (x − r)².
    pub mse: f64,
    /// Sum of x over sum of r, all pixels and channels: above 1 where the picture is too bright.
    /// 1 when both are black.
    pub mean_ratio: f64,
}

/// Scores `image` against `reference`, leaving out pixels that are not finite in either.
///
/// # Errors
/// When the sizes differ or nothing is left to compare.
pub fn score(image: &Image<Rgb>, reference: &Image<Rgb>) -> Result<Score, CompareError> {
    let pairs = pairs(image, reference)?;
    let differences = pairs.map(|(&x, &r)| (x.as_dvec3() - r.as_dvec3(), r.as_dvec3()));
    let mut errors = Vec::with_capacity(image.pixels().len());
    let (mut squares, mut sums) = (0.0, [0.0; 2]);
    for (difference, r) in differences {
        let square = difference * difference;
        errors.push((square / (r * r + REL_MSE_FLOOR)).element_sum() / 3.0);
        squares += square.element_sum() / 3.0;
        sums[0] += (difference + r).element_sum();
        sums[1] += r.element_sum();
    }
    let count = errors.len();
    if count == 0 {
        return Err(CompareError::NoPixels);
    }
    Ok(Score {
        rel_mse: mean(&errors),
        rel_mse_trimmed: trimmed_mean(&mut errors),
        mse: squares / count as f64,
        mean_ratio: if sums == [0.0; 2] {
            1.0
        } else {
            sums[0] / sums[1]
        },
    })
}

/// The pixels of both pictures that are finite in both, in order.
pub(super) fn pairs<'a>(
    image: &'a Image<Rgb>,
    reference: &'a Image<Rgb>,
) -> Result<impl Iterator<Item = (&'a Rgb, &'a Rgb)>, CompareError> {
    let size = |i: &Image<Rgb>| (i.width(), i.height());
    if size(image) != size(reference) {
        return Err(CompareError::Size {
            size: size(image),
            reference: size(reference),
        });
    }
    let both = image.pixels().iter().zip(reference.pixels());
    Ok(both.filter(|(x, r)| x.is_finite() && r.is_finite()))
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The mean without the largest 0.1 % of the values, which are reordered; not empty.
fn trimmed_mean(values: &mut [f64]) -> f64 {
    let left_out = values.len() / TRIM_ONE_IN;
    if left_out == 0 {
        return mean(values);
    }
    let kept = values.len() - left_out;
    let (small, ..) = values.select_nth_unstable_by(kept, f64::total_cmp);
    mean(small)
}
