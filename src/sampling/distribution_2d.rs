use glam::Vec2;

use super::distribution_1d::{guide, invert, usable_weight};
use super::{Distribution1d, ONE_MINUS_EPSILON};

/// Chooses points of the unit square with a density that is constant in each cell of a grid.
///
/// Rows first, then the column in the row (Pharr, Jakob, Humphreys 2016, section 13.6.7).
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution2d {
    width: usize,
    rows: Distribution1d,
    /// For each row its running sums with a leading 0, scaled to end at 1; all 0 in an empty row.
    columns: Vec<f64>,
    /// The guides of all rows.
    guides: Vec<u32>,
}

impl Distribution2d {
    /// A density proportional to `weights`, `width` to a row, the first row at v = 0.
    ///
    /// Weights that are not finite and positive count as zero; `None` when nothing is left.
    ///
    /// # Panics
    /// When `weights` is not made of whole rows.
    pub fn new(width: usize, weights: &[f32]) -> Option<Self> {
        assert!(
            width > 0 && weights.len().is_multiple_of(width),
            "{} weights in rows of {width}",
            weights.len()
        );
        let mut columns = Vec::with_capacity(weights.len() + weights.len() / width);
        let mut row_sums = Vec::with_capacity(weights.len() / width);
        for row in weights.chunks_exact(width) {
            let total: f64 = row.iter().copied().map(usable_weight).sum();
            let divisor = if total > 0.0 { total } else { 1.0 };
            let mut sum = 0.0;
            columns.push(0.0);
            columns.extend(row.iter().map(|&weight| {
                sum += usable_weight(weight);
                sum / divisor
            }));
            row_sums.push(total);
        }
        let guides = columns.chunks_exact(width + 1).flat_map(guide).collect();
        Some(Self {
            width,
            rows: Distribution1d::from_usable(row_sums.into_iter())?,
            columns,
            guides,
        })
    }

    /// A point of the unit square and its density there, above 0; `u` in [0, 1)².
    pub fn sample_continuous(&self, u: Vec2) -> (Vec2, f32) {
        let (row, _, remapped_row) = self.rows.sample(u.y);
        let u_column = f64::from(u.x).clamp(0.0, f64::from(ONE_MINUS_EPSILON));
        let (column, remapped) = invert(self.row(row), self.guide(row), u_column);
        let uv = Vec2::new(
            in_cell(column, remapped, self.width),
            in_cell(row, remapped_row, self.rows.len()),
        );
        (uv, self.cell_pdf(column, row))
    }

    /// The density at `uv` with respect to the area of the unit square.
    pub fn pdf(&self, uv: Vec2) -> f32 {
        self.cell_pdf(cell(uv.x, self.width), cell(uv.y, self.rows.len()))
    }

    fn row(&self, row: usize) -> &[f64] {
        let stride = self.width + 1;
        &self.columns[row * stride..(row + 1) * stride]
    }

    fn guide(&self, row: usize) -> &[u32] {
        let stride = self.width + 1;
        &self.guides[row * stride..(row + 1) * stride]
    }

    fn cell_pdf(&self, column: usize, row: usize) -> f32 {
        let edges = self.row(row);
        let in_row = (edges[column + 1] - edges[column]) as f32;
        self.rows.pmf(row) * self.rows.len() as f32 * in_row * self.width as f32
    }
}

/// The cell of `n` over the unit interval that `x` lies in.
fn cell(x: f32, n: usize) -> usize {
    ((x * n as f32) as usize).min(n - 1)
}

/// The place `offset` in [0, 1) of cell `index` of `n`, rounded so that it stays in its cell.
fn in_cell(index: usize, offset: f32, n: usize) -> f32 {
    let mut x = ((index as f32 + offset) / n as f32).min(ONE_MINUS_EPSILON);
    while cell(x, n) < index {
        x = x.next_up();
    }
    while cell(x, n) > index {
        x = x.next_down();
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{PathSampler, Slot};

    fn lattice_corners() -> impl Iterator<Item = Vec2> {
        let values = [0.0, f32::EPSILON * 0.5, 0.5, ONE_MINUS_EPSILON];
        values
            .into_iter()
            .flat_map(move |x| values.into_iter().map(move |y| Vec2::new(x, y)))
    }

    #[test]
    fn density_of_the_sample_is_that_of_the_query_and_black_cells_stay_empty() {
        let (width, height) = (37, 49);
        let weights: Vec<f32> = (0..width * height)
            .map(|i| {
                let row = i / width;
                if row == 0 || row == 20 || i % 5 == 0 {
                    0.0
                } else {
                    ((i * 31) % 17) as f32
                }
            })
            .collect();
        let distribution = Distribution2d::new(width, &weights).expect("not all weights are zero");
        let random = (0..100_000).map(|i| PathSampler::new(5, [i, 0], 0).get_2d(0, Slot::Scatter));
        for u in random.chain(lattice_corners()) {
            let (uv, pdf) = distribution.sample_continuous(u);
            assert!(uv.min_element() >= 0.0 && uv.max_element() < 1.0 && pdf > 0.0);
            assert_eq!(pdf, distribution.pdf(uv), "{u}");
        }
        let cells = (width * height) as f64;
        let integral: f64 = (0..width * height)
            .map(|i| f64::from(distribution.cell_pdf(i % width, i / width)) / cells)
            .sum();
        assert!((integral - 1.0).abs() < 1e-5, "{integral}");
    }

    #[test]
    fn one_bright_cell_is_always_found() {
        let mut weights = vec![0.0; 64 * 32];
        weights[5 * 64 + 40] = 1e-3;
        let distribution = Distribution2d::new(64, &weights).expect("one weight is positive");
        for u in lattice_corners() {
            let (uv, pdf) = distribution.sample_continuous(u);
            assert_eq!(((uv.x * 64.0) as usize, (uv.y * 32.0) as usize), (40, 5));
            assert_eq!(pdf, 64.0 * 32.0);
        }
        assert!(Distribution2d::new(2, &[0.0; 4]).is_none());
    }
}
