/// One channel of a picture, row by row.
#[derive(Clone, Debug)]
pub(super) struct Plane {
    width: usize,
    height: usize,
    values: Vec<f32>,
}

impl Plane {
    pub(super) fn new(width: usize, height: usize, values: Vec<f32>) -> Self {
        assert_eq!(values.len(), width * height, "a plane of {width}×{height}");
        Self {
            width,
            height,
            values,
        }
    }

    pub(super) fn values(&self) -> &[f32] {
        &self.values
    }

    /// A plane of the same size.
    pub(super) fn with_values(&self, values: Vec<f32>) -> Self {
        Self::new(self.width, self.height, values)
    }

    /// Each value of this and the other plane joined into one.
    pub(super) fn combine(&self, other: &Self, join: impl Fn(f32, f32) -> f32) -> Self {
        let pairs = self.values.iter().zip(&other.values);
        self.with_values(pairs.map(|(&a, &b)| join(a, b)).collect())
    }

    /// The plane filtered with `across` along rows, then with `down` along columns. Kernels have odd
    /// length and their middle in the middle; beyond the border the border's value goes on.
    pub(super) fn filter(&self, across: &[f32], down: &[f32]) -> Self {
        let rows = self.convolve(across, |x, y, offset| (clamp_add(x, offset, self.width), y));
        rows.convolve(down, |x, y, offset| (x, clamp_add(y, offset, self.height)))
    }

    fn convolve(
        &self,
        kernel: &[f32],
        source: impl Fn(usize, usize, isize) -> (usize, usize),
    ) -> Self {
        let radius = (kernel.len() / 2) as isize;
        let value = |index: usize| {
            let (x, y) = (index % self.width, index / self.width);
            let taps = kernel.iter().zip(-radius..);
            taps.map(|(weight, offset)| {
                let (x, y) = source(x, y, offset);
                weight * self.values[y * self.width + x]
            })
            .sum()
        };
        self.with_values((0..self.values.len()).map(value).collect())
    }
}

fn clamp_add(index: usize, offset: isize, length: usize) -> usize {
    index.saturating_add_signed(offset).min(length - 1)
}

/// `f(x)` at x = −radius, …, radius.
pub(super) fn kernel(radius: usize, f: impl Fn(f32) -> f32) -> Vec<f32> {
    let radius = radius as i32;
    (-radius..=radius).map(|x| f(x as f32)).collect()
}

/// Scales the positive weights to the sum 1 and the negative ones to −1.
pub(super) fn normalize(mut kernel: Vec<f32>) -> Vec<f32> {
    let positive: f32 = kernel.iter().map(|w| w.max(0.0)).sum();
    let negative: f32 = kernel.iter().map(|w| (-w).max(0.0)).sum();
    for weight in &mut kernel {
        *weight /= if *weight > 0.0 {
            positive
        } else {
            negative.max(f32::MIN_POSITIVE)
        };
    }
    kernel
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn filters_keep_flat_planes_and_repeat_the_border() {
        let flat = Plane::new(5, 4, vec![0.25; 20]);
        let box_filter = normalize(vec![1.0; 7]);
        let filtered = flat.filter(&box_filter, &box_filter);
        assert!(filtered.values().iter().all(|v| (v - 0.25).abs() < 1e-6));
        let ramp = Plane::new(3, 1, vec![0.0, 3.0, 6.0]);
        let filtered = ramp.filter(&[0.0, 0.0, 1.0], &[1.0]);
        assert_eq!(filtered.values(), [3.0, 6.0, 6.0]);
    }

    #[test]
    fn both_signs_are_normalised() {
        assert_eq!(
            normalize(vec![-3.0, -1.0, 0.0, 2.0]),
            [-0.75, -0.25, 0.0, 1.0]
        );
    }
}
