use glam::{DVec2, Vec2};
use softbox::sampling::{PathSampler, Slot};

use crate::gamma::chi_square_tail;

const SAMPLES: u32 = 200_000;
const CELLS: usize = 48;
/// Cells that expect fewer samples are pooled.
const LEAST_EXPECTED: f64 = 5.0;

/// The random numbers of one sample: lobe or part, and place.
#[derive(Clone, Copy)]
pub(crate) struct Numbers {
    pub(crate) choice: f32,
    pub(crate) u: Vec2,
}

/// A sampler with its density, both carried over to the unit square.
pub(crate) struct Case {
    pub(crate) name: String,
    /// Where the sample falls; `None` when the sampler gives none.
    pub(crate) sample: Box<dyn Fn(Numbers) -> Option<DVec2>>,
    /// The claimed density per area of the unit square.
    pub(crate) density: Box<dyn Fn(DVec2) -> f64>,
    /// The share of samples that the sampler must give, where it is known.
    pub(crate) integral: Option<f64>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Outcome {
    pub(crate) p_value: f64,
    statistic: f64,
    freedom: f64,
    /// ∫ density over the square.
    integral: f64,
    expected_integral: Option<f64>,
    /// Samples at places whose density is zero; rounding at an edge may make one or two.
    impossible: u32,
}

impl Outcome {
    /// What is wrong, if anything.
    pub(crate) fn complaint(&self, name: &str, level: f64) -> Option<String> {
        let wrong_integral = self.integral > 1.0 + 5e-4
            || self
                .expected_integral
                .is_some_and(|e| (self.integral - e).abs() > 5e-4);
        let fails = self.p_value < level || self.impossible > 2 || wrong_integral;
        fails.then(|| {
            format!(
                "{name}: p = {:.2e} (chi-square {:.1} of {} degrees of freedom), integral {:.5}, \
                 {} samples where the density is zero",
                self.p_value, self.statistic, self.freedom, self.integral, self.impossible
            )
        })
    }
}

impl Case {
    pub(crate) fn run(&self, seed: u64) -> Outcome {
        let mut observed = vec![0_u32; CELLS * CELLS];
        let (mut rejected, mut impossible) = (0_u32, 0_u32);
        for i in 0..SAMPLES {
            let random = PathSampler::new(0x5eed + seed, [i, 0], 0);
            let numbers = Numbers {
                choice: random.get_1d(0, Slot::Lobe),
                u: random.get_2d(0, Slot::Scatter),
            };
            match (self.sample)(numbers) {
                Some(place) => {
                    observed[cell_of(place)] += 1;
                    impossible += u32::from((self.density)(place) <= 0.0);
                }
                None => rejected += 1,
            }
        }
        let expected: Vec<f64> = (0..CELLS * CELLS)
            .map(|cell| self.expected_share(cell, observed[cell]) * f64::from(SAMPLES))
            .collect();
        let integral = expected.iter().sum::<f64>() / f64::from(SAMPLES);
        let missing = (1.0 - integral).max(0.0) * f64::from(SAMPLES);
        let cells = observed
            .iter()
            .map(|&o| f64::from(o))
            .zip(expected)
            .chain([(f64::from(rejected), missing)]);
        let (statistic, freedom) = pooled_statistic(cells.collect());
        Outcome {
            p_value: chi_square_tail(statistic, freedom),
            statistic,
            freedom,
            integral,
            expected_integral: self.integral,
            impossible,
        }
    }

    /// ∫ density over a cell. Where the quadrature sees nothing but samples fell, a corner of the
    /// support was missed, and the search is repeated on a fine grid.
    fn expected_share(&self, cell: usize, observed: u32) -> f64 {
        let size = 1.0 / CELLS as f64;
        let corner = DVec2::new((cell % CELLS) as f64, (cell / CELLS) as f64) * size;
        // A tenth of a sample.
        let tolerance = 0.01 / f64::from(SAMPLES);
        let on_grid = |n: usize, depth: u32| -> f64 {
            let part = size / n as f64;
            (0..n * n)
                .map(|i| corner + part * DVec2::new((i % n) as f64, (i / n) as f64))
                .map(|c| (c, gauss(&self.density, c, part)))
                .map(|(c, whole)| adaptive(&self.density, (c, part), whole, tolerance, depth))
                .sum()
        };
        let share = on_grid(2, 6);
        if share == 0.0 && observed > 0 {
            on_grid(32, 3)
        } else {
            share
        }
    }
}

fn cell_of(place: DVec2) -> usize {
    let index = |x: f64| ((x * CELLS as f64).max(0.0) as usize).min(CELLS - 1);
    index(place.y) * CELLS + index(place.x)
}

/// Pearson's statistic and its degrees of freedom, cells of small expectation pooled.
fn pooled_statistic(mut cells: Vec<(f64, f64)>) -> (f64, f64) {
    cells.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut pools: Vec<(f64, f64)> = Vec::new();
    let mut open = (0.0, 0.0);
    for (observed, expected) in cells {
        open = (open.0 + observed, open.1 + expected);
        if open.1 >= LEAST_EXPECTED {
            pools.push(open);
            open = (0.0, 0.0);
        }
    }
    // Sorted by expectation, so nothing is left open unless everything is.
    let statistic = pools.iter().map(|(o, e)| (o - e).powi(2) / e).sum();
    (statistic, pools.len().saturating_sub(1).max(1) as f64)
}

fn quarters(corner: DVec2, size: f64) -> [DVec2; 4] {
    let half = 0.5 * size;
    [(0.0, 0.0), (half, 0.0), (0.0, half), (half, half)].map(|(x, y)| corner + DVec2::new(x, y))
}

/// ∫ over a square by 3 × 3 Gauss-Legendre points.
fn gauss(f: &dyn Fn(DVec2) -> f64, corner: DVec2, size: f64) -> f64 {
    let points = [
        (0.112_701_665_379_258_3, 5.0),
        (0.5, 8.0),
        (0.887_298_334_620_741_7, 5.0),
    ];
    let mut sum = 0.0;
    for (x, weight_x) in points {
        for (y, weight_y) in points {
            sum += weight_x * weight_y * f(corner + size * DVec2::new(x, y));
        }
    }
    sum * size * size / 324.0
}

fn adaptive(
    f: &dyn Fn(DVec2) -> f64,
    (corner, size): (DVec2, f64),
    whole: f64,
    tolerance: f64,
    depth: u32,
) -> f64 {
    let parts = quarters(corner, size).map(|c| (c, gauss(f, c, size * 0.5)));
    let sum: f64 = parts.iter().map(|part| part.1).sum();
    if depth == 0 || (sum - whole).abs() < tolerance {
        return sum;
    }
    parts
        .into_iter()
        .map(|(c, part)| adaptive(f, (c, size * 0.5), part, tolerance * 0.5, depth - 1))
        .sum()
}
