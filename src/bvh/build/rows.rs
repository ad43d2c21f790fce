use rayon::prelude::*;

use super::primitive::{Bounds, PrimitiveRef};

/// Boxes of a row that one thread gathers at a time; runs do not reach over the ends.
const STRETCH: usize = 4096;

/// Longest run.
pub(super) const LONGEST: usize = 8;

/// How much of the area that the longest possible run would have is added to that of every run.
///
/// What lies above in the tree costs more the more runs there are.
const SHARE: f32 = 0.4;

/// Parts a row of `count` boxes into runs of up to `most`, such that the sum of the areas of their
/// boxes is small. `gather` gives the boxes of a stretch; the runs hold places in the row.
pub(super) fn runs(
    count: usize,
    most: usize,
    gather: &(impl Fn(std::ops::Range<usize>) -> Vec<Bounds> + Sync),
) -> Vec<PrimitiveRef> {
    let stretches = (0..count).into_par_iter().step_by(STRETCH);
    let runs: Vec<_> = stretches
        .map(|first| {
            let row = gather(first..(first + STRETCH).min(count));
            best_runs(&row, first, most.clamp(1, LONGEST))
        })
        .collect();
    runs.concat()
}

/// The runs of the least cost, by dynamic programming from left to right.
fn best_runs(row: &[Bounds], first: usize, most: usize) -> Vec<PrimitiveRef> {
    // Least cost of all up to here, and the length of its last run.
    let mut best = vec![(0.0_f32, 0_usize); row.len() + 1];
    for end in 1..=row.len() {
        let most = most.min(end);
        let mut bounds = Bounds::EMPTY;
        let mut costs = [0.0; LONGEST];
        for length in 1..=most {
            bounds = bounds.union(&row[end - length]);
            costs[length - 1] = best[end - length].0 + bounds.half_area();
        }
        let share = SHARE * bounds.half_area();
        let mut least = (f32::INFINITY, 1);
        for (cost, length) in costs[..most].iter().zip(1..) {
            // Sums that overflow, or are no number, are all the same.
            let cost = (cost + share).min(f32::MAX);
            if cost <= least.0 {
                least = (cost, length);
            }
        }
        best[end] = least;
    }
    let mut runs = Vec::with_capacity(row.len() / 2);
    let mut end = row.len();
    while end > 0 {
        let start = end - best[end].1;
        let boxes = row[start..end].iter();
        let bounds = boxes.fold(Bounds::EMPTY, |all, b| all.union(b));
        let place = (first + start) as u32;
        runs.push(PrimitiveRef::run(place, end - start, &bounds));
        end = start;
    }
    runs.reverse();
    runs
}

#[cfg(test)]
mod tests {
    use glam::Vec4;

    use super::*;

    fn boxes(count: usize) -> Vec<Bounds> {
        let place = |i: usize| Vec4::new((i * i % 13) as f32, (i % 7) as f32, (i / 3) as f32, 0.0);
        let boxes = (0..count).map(|i| Bounds {
            min: place(i),
            max: place(i) + Vec4::splat(1.0 + (i % 5) as f32),
        });
        boxes.collect()
    }

    fn parted(row: &[Bounds], most: usize) -> Vec<PrimitiveRef> {
        runs(row.len(), most, &|stretch| row[stretch].to_vec())
    }

    fn join(row: &[Bounds]) -> Bounds {
        row.iter().fold(Bounds::EMPTY, |all, b| all.union(b))
    }

    #[test]
    fn runs_follow_each_other_and_hold_their_boxes() {
        for (count, most) in [(1, 4), (50, 1), (50, 8), (2 * STRETCH + 77, 4)] {
            let row = boxes(count);
            let mut next = 0;
            for run in parted(&row, most) {
                assert_eq!(run.ids().start, next);
                assert!((1..=most).contains(&run.count()));
                next = run.ids().end;
                let members = &row[run.ids().start as usize..next as usize];
                assert_eq!(run.bounds().aabb(), join(members).aabb());
            }
            assert_eq!(next as usize, count);
        }
    }

    /// The least cost of `row` up to `end`, by trying everything.
    fn least(row: &[Bounds], end: usize, most: usize) -> f32 {
        let most = most.min(end);
        let share = SHARE * join(&row[end.saturating_sub(most)..end]).half_area();
        let costs = (1..=most).map(|length| {
            let start = end - length;
            least(row, start, 4) + join(&row[start..end]).half_area() + share
        });
        if end == 0 {
            0.0
        } else {
            costs.fold(f32::INFINITY, f32::min)
        }
    }

    #[test]
    fn no_other_runs_cost_less() {
        let row = boxes(14);
        let found = parted(&row, 4);
        assert!(found.len() > 3);
        let cost: f32 = found
            .iter()
            .map(|run| {
                let end = run.ids().end as usize;
                let longest = &row[end.saturating_sub(4)..end];
                run.bounds().half_area() + SHARE * join(longest).half_area()
            })
            .sum();
        let best = least(&row, row.len(), 4);
        assert!((cost - best).abs() < 1e-4 * best, "{cost} {best}");
    }

    #[test]
    fn areas_that_overflow_are_parted_all_the_same() {
        let huge = Bounds {
            min: Vec4::splat(-3e38),
            max: Vec4::splat(3e38),
        };
        let runs = parted(&[huge; 10], 4);
        assert_eq!(runs.iter().map(PrimitiveRef::count).sum::<usize>(), 10);
    }
}
