use crate::film::{Film, PixelStats};

/// Half the width of a 95 % interval of the normal distribution, in deviations.
const QUANTILE_95: f64 = 1.96;

/// Ends the pixels that pass the course's rule, each by itself and for good. A pixel that has not
/// met its light yet looks done: with light in one of a hundred samples and batches of 64 the picture
/// is half as bright as it should be.
pub(super) fn close_pixels(film: &mut Film, tolerance: f32) {
    let pixels = film
        .tiles_mut()
        .iter_mut()
        .flat_map(|tile| tile.pixels_mut());
    for pixel in pixels {
        if !pixel.is_closed() && passes(pixel, tolerance) {
            pixel.close();
        }
    }
}

/// 1.96 · sqrt(σ²/n) <= tolerance · mean, of the luminance.
fn passes(pixel: &PixelStats, tolerance: f32) -> bool {
    let Some((mean, variance)) = pixel.luminance() else {
        return false;
    };
    QUANTILE_95 * (variance / f64::from(pixel.count())).sqrt() <= f64::from(tolerance) * mean
}
