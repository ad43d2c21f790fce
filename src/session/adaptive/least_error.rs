use super::set_limits;
use crate::film::{Film, Rows};

/// Samples are given out in multiples of this, whose aligned blocks are spread evenly.
const STEP: u32 = 8;
/// Every pixel gets at least the mean over this: what looks plain may not be.
const LEAST_SHARE: u32 = 8;
/// A pixel grows at most this many times from one decision to the next: early deviations are not to
/// be trusted far.
const MOST_GROWTH: u32 = 4;

/// Gives each pixel of `film` its number of samples, so that their mean is at most `mean`: in
/// proportion to its deviation, as far as it has not more already. Returns the least number that an
/// open pixel has and the greatest that one shall have.
///
/// Neyman 1934, "On the Two Different Aspects of the Representative Method": that makes the sum of
/// the squared errors the least. The deviation is that of the neighbours: had the pixel's own samples a
/// say, those that have not met their light would get fewer, and the picture would be too dark.
pub(super) fn allot(film: &mut Film, mean: u32) -> (u32, u32) {
    let rows = film.rows();
    let places = || (0..rows.height()).flat_map(|y| (0..rows.width()).map(move |x| (x, y)));
    let wants: Vec<Want> = places()
        .map(|(x, y)| Want::new(&rows, (x, y), mean))
        .collect();
    let budget = u64::from(mean) * wants.len() as u64;
    let total = |scale: f64| {
        wants
            .iter()
            .map(|want| u64::from(want.limit(scale)))
            .sum::<u64>()
    };
    // The total grows with the scale.
    let (mut low, mut high) = (0.0, f64::from(mean) / LEAST_WEIGHT);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if total(middle) <= budget {
            low = middle;
        } else {
            high = middle;
        }
    }
    set_limits(film, |place| wants[place].limit(low));
    let open = || wants.iter().filter(|want| want.limit(low) > want.has);
    let least = open().map(|want| want.has).min();
    let most = open().map(|want| want.limit(low)).max();
    (least.unwrap_or(mean), most.unwrap_or(mean))
}

/// Below this deviation of a single sample, relative to the brightness, pixels count as plain.
const LEAST_WEIGHT: f64 = 1e-5;
const BISECTIONS: u32 = 60;

/// What one pixel has and would have.
struct Want {
    has: u32,
    /// Deviation of a single sample relative to the brightness.
    weight: f64,
    least: u32,
}

impl Want {
    fn new(rows: &Rows, (x, y): (usize, usize), mean: u32) -> Self {
        let has = rows.count(x, y);
        let weight = rows.pooled_neighbours(x, y).map_or(1.0, |pooled| {
            pooled.relative_error() * f64::from(has).sqrt()
        });
        Self {
            has,
            weight,
            least: mean / LEAST_SHARE,
        }
    }

    /// The samples that it gets at `scale` samples for a deviation of 1.
    fn limit(&self, scale: f64) -> u32 {
        let most = self.has.saturating_mul(MOST_GROWTH);
        let wanted = ((self.weight * scale) as u32).clamp(self.least, most.max(self.least));
        (wanted / STEP * STEP).max(self.has)
    }
}
