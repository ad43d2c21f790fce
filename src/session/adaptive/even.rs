use super::companions::Companions;
use super::set_limits;
use crate::film::{Film, Pooled};
use crate::settings::{Adaptive, Mode, RenderSettings};
use crate::study::student_975;

/// Half the first code of an 8-bit picture: darker differences are not seen.
const DARK_FLOOR: f64 = 0.5 / 255.0;

/// Opens the pixels that are not good enough, all their neighbours and the companions of both in
/// clusters of `cluster_size` pixels, and ends the others; to be asked when all open pixels have the
/// same number of samples. Pixels that were ended are looked at again: what their neighbours have found
/// since counts for them too.
pub(super) fn decide(
    (film, cluster_size): (&mut Film, usize),
    adaptive: &Adaptive,
    settings: &RenderSettings,
) {
    let least = if settings.mode == Mode::Hemisphere {
        256
    } else {
        64
    };
    let floor = DARK_FLOOR * (-f64::from(adaptive.exposure)).exp2();
    let tolerance = f64::from(adaptive.tolerance);
    let replicates = (film.replicates(), independent_of_nine(settings));
    let rows = film.rows();
    let (width, height) = (rows.width(), rows.height());
    let mut is_open = vec![false; width * height];
    for y in 0..height {
        for x in 0..width {
            let is_good = rows.count(x, y) >= least
                && rows
                    .pooled(x, y)
                    .is_some_and(|pooled| is_within(&pooled, replicates, (tolerance, floor)));
            if !is_good {
                open_around(&mut is_open, (width, height), (x, y));
            }
        }
    }
    let companions = Companions::new(film, cluster_size);
    let mut is_group_open = vec![false; companions.len()];
    for (place, _) in is_open.iter().enumerate().filter(|(_, is_open)| **is_open) {
        is_group_open[companions.of(place)] = true;
    }
    set_limits(film, |place| match is_group_open[companions.of(place)] {
        true => u32::MAX,
        false => rows.count(place % width, place / width),
    });
}

/// Every channel is within the tolerance.
fn is_within(pooled: &Pooled, replicates: (u32, usize), (tolerance, floor): (f64, f64)) -> bool {
    let half_width = half_width_95(pooled, replicates);
    (0..3).all(|c| half_width[c] <= tolerance * pooled.mean[c].max(floor))
}

/// Of 3×3 pixels, the number whose noise is independent.
pub(super) fn independent_of_nine(settings: &RenderSettings) -> usize {
    match settings.mode {
        Mode::Best => settings.reuse.independent_of_nine(),
        Mode::Hemisphere | Mode::Importance => 9,
    }
}

/// Half the width of the 95 % interval of the mean of a pixel, per channel. Each of the pooled pixels,
/// as far as they are `independent`, has one degree of freedom less than replicates.
pub(super) fn half_width_95(pooled: &Pooled, (replicates, independent): (u32, usize)) -> [f64; 3] {
    let freedom = pooled.pixels.min(independent) * (replicates.max(2) as usize - 1);
    let quantile = student_975(freedom);
    pooled.squared_error.map(|e| quantile * e.sqrt())
}

fn open_around(is_open: &mut [bool], (width, height): (usize, usize), (x, y): (usize, usize)) {
    for row in y.saturating_sub(1)..(y + 2).min(height) {
        is_open[row * width..][x.saturating_sub(1)..(x + 2).min(width)].fill(true);
    }
}
