use glam::Vec3;

use super::LOBES;
use super::lobes::LobeSphere;

/// Share of the probability that all lobes get alike.
const EVEN: f32 = 0.1;

/// Bundles that spread by less, in cell widths, are left whole.
const SMALL: f32 = 0.1;

/// The smallest radius of a lobe in cell widths: that far a reflection moves about when the eye moves
/// through the cell.
const LEAST_RADIUS: f32 = 0.3;

/// Places beyond the known ones that a lobe allows for, counted in places: few tell little about how far
/// they reach.
const ALLOWANCE: f32 = 3.0;

/// A few spheres that hold nearly all places from which light comes, `seen` with weights, for a cell
/// of width `width`. Changes the order of `seen`, which is not empty.
pub(super) fn spheres(seen: &mut [(Vec3, f32)], width: f32) -> Vec<LobeSphere> {
    let (small, least) = (SMALL * width, LEAST_RADIUS * width);
    let mut bundles = vec![Bundle::new(seen)];
    while bundles.len() < LOBES {
        let widest = bundles
            .iter()
            .enumerate()
            .filter(|(_, c)| c.spread() > small * small)
            .max_by(|a, b| a.1.cost().total_cmp(&b.1.cost()));
        let Some((index, _)) = widest else {
            break;
        };
        let (a, b) = bundles.swap_remove(index).split();
        bundles.extend([a, b]);
    }
    let total: f32 = bundles.iter().map(|c| c.weight).sum();
    let even = EVEN / bundles.len() as f32;
    bundles
        .iter()
        .map(|c| c.sphere(least, c.weight / total * (1.0 - EVEN) + even))
        .collect()
}

/// Places that one sphere is to hold.
struct Bundle<'a> {
    seen: &'a mut [(Vec3, f32)],
    weight: f32,
    mean: Vec3,
    /// Of each coordinate.
    variance: Vec3,
}

impl<'a> Bundle<'a> {
    fn new(seen: &'a mut [(Vec3, f32)]) -> Self {
        let n = seen.len() as f32;
        let mean = seen.iter().map(|s| s.0).sum::<Vec3>() / n;
        let squares = seen.iter().map(|s| (s.0 - mean) * (s.0 - mean));
        Self {
            weight: seen.iter().map(|s| s.1).sum(),
            mean,
            variance: squares.sum::<Vec3>() / n,
            seen,
        }
    }

    fn spread(&self) -> f32 {
        self.variance.element_sum()
    }

    fn cost(&self) -> f32 {
        self.weight * self.spread()
    }

    /// At the mean of the coordinate that varies most; both parts hold something when it does.
    fn split(self) -> (Self, Self) {
        let axis = self.variance.max_position();
        let mut low = 0;
        for i in 0..self.seen.len() {
            if self.seen[i].0[axis] < self.mean[axis] {
                self.seen.swap(i, low);
                low += 1;
            }
        }
        let (a, b) = self.seen.split_at_mut(low.clamp(1, self.seen.len() - 1));
        (Self::new(a), Self::new(b))
    }

    fn sphere(&self, least: f32, weight: f32) -> LobeSphere {
        let (min, max) = self
            .seen
            .iter()
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), s| {
                (min.min(s.0), max.max(s.0))
            });
        let center = 0.5 * (min + max);
        let reach = |s: &(Vec3, f32)| s.0.distance(center);
        let radius = self.seen.iter().map(reach).fold(0.0, f32::max);
        let wider = 1.0 + ALLOWANCE / self.seen.len() as f32;
        let radius = (radius * wider).max(least);
        LobeSphere {
            center,
            radius2: radius * radius,
            weight,
        }
    }
}
