use std::ops::Range;

use rayon::prelude::*;

/// Puts together what `make` gives for each stretch of `length` of the numbers below `count`, the last
/// one shorter, in their order; on all threads of the current pool.
///
/// # Panics
/// If `length` is 0.
pub fn map_stretches<T: Clone + Send + Sync>(
    count: usize,
    length: usize,
    make: impl Fn(Range<usize>) -> Vec<T> + Sync,
) -> Vec<T> {
    let starts = (0..count).into_par_iter().step_by(length);
    let parts: Vec<_> = starts
        .map(|start| make(start..count.min(start + length)))
        .collect();
    parts.concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_comes_once_in_order() {
        for count in [0, 1, 6, 7, 8, 100] {
            let all = map_stretches(count, 7, |stretch| {
                assert!(stretch.len() == 7 || stretch.end == count);
                stretch.collect()
            });
            assert!(all.into_iter().eq(0..count), "{count}");
        }
    }
}
