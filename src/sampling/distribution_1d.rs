use super::ONE_MINUS_EPSILON;

/// Chooses among entries in proportion to their weights.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution1d {
    /// Running sums scaled to end at exactly 1, with a leading 0.
    cdf: Vec<f64>,
    guide: Vec<u32>,
}

impl Distribution1d {
    /// A distribution proportional to `weights`.
    ///
    /// Weights that are not finite and positive count as zero; `None` when nothing is left.
    pub fn new(weights: &[f32]) -> Option<Self> {
        Self::from_usable(weights.iter().copied().map(usable_weight))
    }

    /// As [`Self::new`], for finite weights of which none is negative.
    pub(super) fn from_usable(weights: impl Iterator<Item = f64>) -> Option<Self> {
        let mut sum = 0.0;
        let mut cdf = vec![0.0];
        cdf.extend(weights.map(|weight| {
            sum += weight;
            sum
        }));
        if sum <= 0.0 {
            return None;
        }
        for value in &mut cdf {
            *value /= sum;
        }
        let guide = guide(&cdf).collect();
        Some(Self { cdf, guide })
    }

    /// Number of entries, those of weight zero included.
    pub fn len(&self) -> usize {
        self.cdf.len() - 1
    }

    /// Always false: a distribution has an entry of positive weight.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// The entry that `u` in [0, 1) falls on, the probability with which it is chosen, and `u`
    /// stretched over the entry: uniform in [0, 1) again, to be used once more.
    ///
    /// Entries of weight zero are never chosen.
    pub fn sample(&self, u: f32) -> (usize, f32, f32) {
        if self.cdf.len() == 2 {
            return (0, 1.0, u.clamp(0.0, ONE_MINUS_EPSILON));
        }
        let u = f64::from(u).clamp(0.0, f64::from(ONE_MINUS_EPSILON));
        let (index, remapped) = invert(&self.cdf, &self.guide, u);
        (index, self.pmf(index), remapped)
    }

    /// The probability of entry `index`; 0 when there is no such entry.
    pub fn pmf(&self, index: usize) -> f32 {
        match (self.cdf.get(index), self.cdf.get(index + 1)) {
            (Some(low), Some(high)) => (high - low) as f32,
            _ => 0.0,
        }
    }
}

/// What a weight counts for: itself, or nothing when it is not finite and positive.
pub(super) fn usable_weight(weight: f32) -> f64 {
    if weight.is_finite() && weight > 0.0 {
        f64::from(weight)
    } else {
        0.0
    }
}

/// For every k in 0..=n the last edge of `cdf`, which has n steps, at or below k / n. Chen and Asau
/// 1974, "On Generating Random Variates from an Empirical Distribution".
pub(super) fn guide(cdf: &[f64]) -> impl Iterator<Item = u32> + '_ {
    let steps = cdf.len() - 1;
    let mut edge = 0;
    (0..=steps).map(move |k| {
        let share = k as f64 / steps as f64;
        while edge < steps && cdf[edge + 1] <= share {
            edge += 1;
        }
        edge as u32
    })
}

/// The interval of `cdf` (rising from 0 to 1, at least one step) that holds `u` in [0, 1), and where
/// in it `u` lies, in [0, 1). `guide` is that of `cdf`.
pub(super) fn invert(cdf: &[f64], guide: &[u32], u: f64) -> (usize, f32) {
    let steps = cdf.len() - 1;
    // Exact: `u` was single precision. So the guide's edges enclose the one that is sought.
    let k = ((u * steps as f64) as usize).min(steps - 1);
    let (first, last) = (guide[k] as usize, guide[k + 1] as usize);
    // The last edge at or below u: flat stretches, the entries of weight zero, are stepped over.
    let index = first + cdf[first + 1..=last].partition_point(|&edge| edge <= u);
    let (low, high) = (cdf[index], cdf[index + 1]);
    let remapped = ((u - low) / (high - low)) as f32;
    (index, remapped.min(ONE_MINUS_EPSILON))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The guide changes how long the search takes and nothing else.
    #[test]
    fn the_guide_leads_where_a_search_of_everything_leads() {
        let even = vec![1.0; 1000];
        let spikes: Vec<f32> = (0..1000)
            .map(|i| if i % 337 == 5 { 1e6 } else { 1e-3 })
            .collect();
        let gaps: Vec<f32> = (0..1000).map(|i| ((i / 100) % 2) as f32).collect();
        for weights in [even, spikes, gaps, vec![0.0, 1.0, 0.0]] {
            let Distribution1d { cdf, guide } = Distribution1d::new(&weights).expect("not black");
            for i in 0..100_000_u32 {
                let u = f64::from(i as f32 / 100_000.0);
                let (index, _) = invert(&cdf, &guide, u);
                assert_eq!(index, cdf.partition_point(|&edge| edge <= u) - 1, "{u}");
            }
        }
    }

    #[test]
    fn nothing_to_choose_from_gives_no_distribution() {
        assert!(Distribution1d::new(&[]).is_none());
        assert!(Distribution1d::new(&[0.0, -1.0, f32::NAN, f32::INFINITY]).is_none());
    }

    #[test]
    fn zero_weights_are_never_chosen_and_frequencies_match() {
        let weights = [0.0, 3.0, 0.0, 0.0, 1.0, 1e-9, 4.0, f32::NAN, 0.0];
        let distribution = Distribution1d::new(&weights).expect("some weights are positive");
        let n = 1 << 20;
        let mut counts = [0_u32; 9];
        for i in 0..n {
            let (index, pmf, remapped) = distribution.sample(i as f32 / n as f32);
            assert_eq!(pmf, distribution.pmf(index));
            assert!(pmf > 0.0 && (0.0..1.0).contains(&remapped));
            counts[index] += 1;
        }
        let expected = [0.0, 0.375, 0.0, 0.0, 0.125, 0.0, 0.5, 0.0, 0.0];
        for (count, share) in counts.into_iter().zip(expected) {
            assert!(
                (f64::from(count) / f64::from(n) - share).abs() < 2e-6,
                "{counts:?}"
            );
        }
        for end in [0.0, ONE_MINUS_EPSILON, 1.0] {
            assert!(distribution.sample(end).1 > 0.0);
        }
        assert_eq!((distribution.len(), distribution.pmf(99)), (9, 0.0));
    }

    #[test]
    fn probabilities_add_to_one_and_the_number_is_used_again() {
        let weights: Vec<f32> = (0..1000).map(|i| ((i * 7919) % 101) as f32).collect();
        let distribution = Distribution1d::new(&weights).expect("some weights are positive");
        let sum: f64 = (0..1000).map(|i| f64::from(distribution.pmf(i))).sum();
        assert!((sum - 1.0).abs() < 1e-6);
        let (index, pmf, remapped) = distribution.sample(0.4321);
        let below: f64 = (0..index).map(|i| f64::from(distribution.pmf(i))).sum();
        let back = below + f64::from(remapped * pmf);
        assert!((back - 0.4321).abs() < 1e-6);
    }
}
