//! When adaptive sampling ends a pixel. Biased: a pixel that has not met its light yet looks done.

use crate::film::{Film, PixelStats};
use crate::settings::{Adaptive, AdaptiveRule, Mode};

/// 97.5 % quantile of the normal distribution: the half width of a 95 % interval in deviations.
const QUANTILE_95: f64 = 1.96;
/// Half the first code of an 8-bit picture at exposure 0: darker differences are not seen.
const DARK_FLOOR: f64 = 0.5 / 255.0;

/// Closes the pixels of `film` that are done; to be asked when all open pixels have the same
/// number of samples, a multiple of the batch. True when no pixel is open any more.
pub(super) fn close_pixels(film: &mut Film, adaptive: &Adaptive, mode: Mode) -> bool {
    match adaptive.rule {
        AdaptiveRule::Course => close_where(film, |pixel| passes_course(pixel, adaptive.tolerance)),
        AdaptiveRule::Neighbourhood => {
            let least = if mode == Mode::Hemisphere { 256 } else { 64 };
            let passed = pooled_test(film, adaptive.tolerance, least);
            close_agreed(film, &passed);
        }
    }
    film.tiles()
        .iter()
        .all(|tile| tile.pixels().iter().all(PixelStats::is_closed))
}

fn close_where(film: &mut Film, is_done: impl Fn(&PixelStats) -> bool) {
    for pixel in film
        .tiles_mut()
        .iter_mut()
        .flat_map(|tile| tile.pixels_mut())
    {
        if !pixel.is_closed() && is_done(pixel) {
            pixel.close();
        }
    }
}

/// The course's rule: 1.96 · sqrt(σ²/n) <= tolerance · mean, of the luminance.
fn passes_course(pixel: &PixelStats, tolerance: f32) -> bool {
    let Some((mean, variance)) = pixel.luminance() else {
        return false;
    };
    QUANTILE_95 * (variance / f64::from(pixel.count())).sqrt() <= f64::from(tolerance) * mean
}

/// For each pixel of the region, row by row: whether it and its neighbours together are precise
/// enough in every channel.
fn pooled_test(film: &Film, tolerance: f32, least: u32) -> Vec<bool> {
    let region = film.region();
    let (width, height) = (region.width as usize, region.height as usize);
    let flat = flattened(film);
    let mut passed = Vec::with_capacity(flat.len());
    for y in 0..height {
        for x in 0..width {
            passed.push(neighbourhood_passes(
                &flat,
                (width, height),
                (x, y),
                f64::from(tolerance),
                least,
            ));
        }
    }
    passed
}

fn neighbourhood_passes(
    flat: &[PixelStats],
    (width, height): (usize, usize),
    (x, y): (usize, usize),
    tolerance: f64,
    least: u32,
) -> bool {
    let center = &flat[y * width + x];
    if center.is_closed() {
        return true;
    }
    if center.count() < least {
        return false;
    }
    let (mut mean, mut variance, mut pixels) = ([0.0; 3], [0.0; 3], 0.0);
    for row in y.saturating_sub(1)..(y + 2).min(height) {
        for column in x.saturating_sub(1)..(x + 2).min(width) {
            let pixel = &flat[row * width + column];
            let Some(v) = pixel.variance() else {
                return false;
            };
            for c in 0..3 {
                mean[c] += pixel.mean()[c];
                variance[c] += v[c];
            }
            pixels += 1.0;
        }
    }
    (0..3).all(|c| {
        let half_width = QUANTILE_95 * (variance[c] / pixels / f64::from(center.count())).sqrt();
        half_width <= tolerance * (mean[c] / pixels).max(DARK_FLOOR)
    })
}

/// Closes each pixel that passed together with all of its neighbours.
fn close_agreed(film: &mut Film, passed: &[bool]) {
    let region = film.region();
    let (width, height) = (region.width as usize, region.height as usize);
    for tile in film.tiles_mut() {
        for index in 0..tile.pixels().len() {
            let (x, y) = tile.position(index);
            let (x, y) = ((x - region.x) as usize, (y - region.y) as usize);
            let all_agree = (y.saturating_sub(1)..(y + 2).min(height)).all(|row| {
                (x.saturating_sub(1)..(x + 2).min(width)).all(|column| passed[row * width + column])
            });
            if all_agree {
                tile.pixels_mut()[index].close();
            }
        }
    }
}

/// The pixels of the film row by row.
pub(super) fn flattened(film: &Film) -> Vec<PixelStats> {
    let region = film.region();
    let mut flat = Vec::with_capacity((region.width * region.height) as usize);
    for y in region.y..region.y + region.height {
        for tile in film.tiles_of_row(y) {
            let area = tile.area();
            let start = tile.index(area.x, y);
            flat.extend_from_slice(&tile.pixels()[start..start + area.width as usize]);
        }
    }
    flat
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Rgb;
    use crate::image::Region;
    use crate::sampling::{PathSampler, Slot};

    fn film_of(width: u32, height: u32) -> Film {
        Film::new(Region {
            x: 3,
            y: 5,
            width,
            height,
        })
    }

    fn add_bernoulli(film: &mut Film, samples: std::ops::Range<u32>, p: f32) {
        for tile in film.tiles_mut() {
            for index in 0..tile.pixels().len() {
                let (x, y) = tile.position(index);
                if tile.pixels()[index].is_closed() {
                    continue;
                }
                for sample in samples.clone() {
                    let u = PathSampler::new(11, [x, y], sample).get_1d(0, Slot::Roulette);
                    let value = if u < p { 1.0 / p } else { 0.0 };
                    tile.pixels_mut()[index].add(Rgb::splat(value));
                }
            }
        }
    }

    fn bias_at_the_end(rule: AdaptiveRule, p: f32) -> f64 {
        let mut film = film_of(60, 50);
        let adaptive = Adaptive {
            batch: 64,
            tolerance: 0.05,
            rule,
        };
        for batch in 0..200 {
            add_bernoulli(&mut film, batch * 64..(batch + 1) * 64, p);
            if close_pixels(&mut film, &adaptive, Mode::Best) {
                break;
            }
        }
        let flat = flattened(&film);
        flat.iter().map(|pixel| pixel.mean()[0]).sum::<f64>() / flat.len() as f64 - 1.0
    }

    /// Test F4 of the stress list: one sample in a hundred finds the light.
    #[test]
    fn the_neighbourhood_rule_waits_for_rare_light_where_the_courses_rule_gives_up() {
        let course = bias_at_the_end(AdaptiveRule::Course, 0.01);
        let neighbourhood = bias_at_the_end(AdaptiveRule::Neighbourhood, 0.01);
        assert!(course < -0.3, "{course}");
        assert!(neighbourhood.abs() < 0.01, "{neighbourhood}");
    }

    /// Test F5: black pixels end, after the least number of samples.
    #[test]
    fn black_pixels_end_by_the_floor() {
        let mut film = film_of(40, 40);
        let adaptive = Adaptive {
            batch: 32,
            tolerance: 0.05,
            rule: AdaptiveRule::Neighbourhood,
        };
        add_bernoulli(&mut film, 0..32, 0.0);
        assert!(
            !close_pixels(&mut film, &adaptive, Mode::Best),
            "too few samples"
        );
        add_bernoulli(&mut film, 32..64, 0.0);
        assert!(close_pixels(&mut film, &adaptive, Mode::Best));
    }

    #[test]
    fn flattened_rows_are_in_image_order() {
        let mut film = film_of(70, 40);
        for tile in film.tiles_mut() {
            for index in 0..tile.pixels().len() {
                let (x, y) = tile.position(index);
                tile.pixels_mut()[index].add(Rgb::new(x as f32, y as f32, 0.0));
            }
        }
        for (i, pixel) in flattened(&film).iter().enumerate() {
            assert_eq!(
                pixel.mean()[0..2],
                [3.0 + (i % 70) as f64, 5.0 + (i / 70) as f64]
            );
        }
    }
}
