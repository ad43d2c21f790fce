use crate::sampling::Distribution1d;

/// Chooses one of the lights in proportion to its power.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LightSampler {
    /// Nothing when no light shines.
    distribution: Option<Distribution1d>,
}

impl LightSampler {
    /// A sampler over lights of the given powers; powers that are not finite and positive count as
    /// zero.
    pub fn new(powers: &[f32]) -> Self {
        Self {
            distribution: Distribution1d::new(powers),
        }
    }

    /// The light that `u` in [0, 1) falls on and the probability of that choice; lights of power zero
    /// are never chosen. When no light shines, index 0 with probability 0.
    pub fn sample(&self, u: f32) -> (usize, f32) {
        self.distribution.as_ref().map_or((0, 0.0), |lights| {
            let (index, pmf, _) = lights.sample(u);
            (index, pmf)
        })
    }

    /// The probability with which light `index` is chosen; 0 when there is no such light.
    pub fn pmf(&self, index: usize) -> f32 {
        self.distribution
            .as_ref()
            .map_or(0.0, |lights| lights.pmf(index))
    }
}
