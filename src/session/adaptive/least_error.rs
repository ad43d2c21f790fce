use super::companions::Companions;
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
/// proportion to its deviation, as far as it has not more already; the same to all pixels of a cluster
/// of `cluster_size`, in proportion to the root of the mean of their squared deviations. Returns the least
/// number that an open pixel has and the greatest that one shall have.
///
/// Neyman 1934, "On the Two Different Aspects of the Representative Method": that makes the sum of
/// the squared errors the least. The deviation is that of the neighbours: had the pixel's own samples a
/// say, those that have not met their light would get fewer, and the picture would be too dark.
pub(super) fn allot((film, cluster_size): (&mut Film, usize), mean: u32) -> (u32, u32) {
    let rows = film.rows();
    let companions = Companions::new(film, cluster_size);
    let mut wants = vec![Want::of_none(mean); companions.len()];
    for place in 0..rows.width() * rows.height() {
        let at = (place % rows.width(), place / rows.width());
        wants[companions.of(place)].add(&rows, at);
    }
    let budget = u64::from(mean) * (rows.width() * rows.height()) as u64;
    let total = |scale: f64| {
        wants
            .iter()
            .map(|want| u64::from(want.pixels) * u64::from(want.limit(scale)))
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
    set_limits(film, |place| wants[companions.of(place)].limit(low));
    let open = || {
        let open = wants.iter().filter(|want| want.pixels > 0);
        open.filter(|want| want.limit(low) > want.least_has)
    };
    let least = open().map(|want| want.least_has).min();
    let most = open().map(|want| want.limit(low)).max();
    (least.unwrap_or(mean), most.unwrap_or(mean))
}

/// Below this deviation of a single sample, relative to the brightness, pixels count as plain.
const LEAST_WEIGHT: f64 = 1e-5;
const BISECTIONS: u32 = 60;

/// What the pixels of a cluster have and would have.
#[derive(Clone, Copy, Debug)]
struct Want {
    pixels: u32,
    /// The fewest samples that one of them has, and the most.
    least_has: u32,
    most_has: u32,
    /// Sum over the pixels of the squared deviation of a single sample relative to the brightness.
    squares: f64,
    /// What each gets in any case.
    least: u32,
}

impl Want {
    fn of_none(mean: u32) -> Self {
        Self {
            pixels: 0,
            least_has: u32::MAX,
            most_has: 0,
            squares: 0.0,
            least: mean / LEAST_SHARE,
        }
    }

    fn add(&mut self, rows: &Rows, (x, y): (usize, usize)) {
        let has = rows.count(x, y);
        let weight = rows.pooled_neighbours(x, y).map_or(1.0, |pooled| {
            pooled.relative_error() * f64::from(has).sqrt()
        });
        self.pixels += 1;
        self.least_has = self.least_has.min(has);
        self.most_has = self.most_has.max(has);
        self.squares += weight * weight;
    }

    /// The samples that each pixel gets at `scale` samples for a deviation of 1.
    fn limit(&self, scale: f64) -> u32 {
        let weight = (self.squares / f64::from(self.pixels.max(1))).sqrt();
        let most = self.most_has.saturating_mul(MOST_GROWTH);
        let wanted = ((weight * scale) as u32).clamp(self.least, most.max(self.least));
        (wanted / STEP * STEP).max(self.most_has)
    }
}
