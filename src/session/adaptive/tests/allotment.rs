//! Least error: who gets the samples.

use super::super::Schedule;
use super::synthetic::{film_at_the_end, settings};
use crate::film::{Film, PixelStats};
use crate::sampling::Slot;
use crate::settings::AdaptiveGoal;

const WIDTH: u32 = 64;

/// A picture whose left quarter is plain, the second one hardly noisy, the others four times as much.
fn picture(budget: u32) -> Film {
    let settings = settings(AdaptiveGoal::LeastError, budget);
    film_at_the_end([WIDTH, 32], &settings, |x, numbers| {
        let u = numbers.get_1d(0, Slot::Roulette);
        let deviation = match x / (WIDTH / 4) {
            0 => 0.0,
            1 => 0.2,
            _ => 0.8,
        };
        1.0 + deviation * (u - 0.5)
    })
}

fn mean_count(film: &Film, columns: std::ops::Range<u32>) -> f64 {
    let region = film.region();
    let pixels = columns.clone().flat_map(|x| (0..32).map(move |y| (x, y)));
    let counts = pixels.map(|(x, y)| {
        film.pixel(region.x + x, region.y + y)
            .map_or(0, PixelStats::count)
    });
    counts.map(f64::from).sum::<f64>() / f64::from(columns.len() as u32 * 32)
}

#[test]
fn samples_follow_the_deviation_within_the_budget() {
    let film = picture(512);
    let mean = mean_count(&film, 0..WIDTH);
    assert!((500.0..=512.0).contains(&mean), "{mean}");
    let plain = mean_count(&film, 2..14);
    assert!((63.0..=65.0).contains(&plain), "{plain}");
    let (calm, noisy) = (mean_count(&film, 18..30), mean_count(&film, 34..62));
    assert!((3.5..4.5).contains(&(noisy / calm)), "{calm} {noisy}");
}

/// Test F4 for least error: the own samples of a pixel have no say in their number.
#[test]
fn rare_light_is_not_given_up() {
    let settings = settings(AdaptiveGoal::LeastError, 1024);
    for p in [0.05, 0.01] {
        let film = film_at_the_end([80, 80], &settings, |_, numbers| {
            let u = numbers.get_1d(0, Slot::Roulette);
            if u < p { 1.0 / p } else { 0.0 }
        });
        let pixels = film.tiles().iter().flat_map(|tile| tile.pixels());
        let bias = pixels.map(|pixel| pixel.mean()[0]).sum::<f64>() / 6400.0 - 1.0;
        // The noise of the picture's mean.
        let deviation = ((1.0 / f64::from(p) - 1.0) / 900.0 / 6400.0).sqrt();
        assert!(
            bias.abs() < 0.002 + 3.0 * deviation,
            "{p}: {bias} {deviation}"
        );
    }
}

/// What was given out does not depend on where the render was going to stop.
#[test]
fn a_raised_budget_goes_on_as_if_it_had_been_there() {
    let settings = |budget| settings(AdaptiveGoal::LeastError, budget);
    let mut schedule = Schedule::default();
    let mut film = Film::new(crate::image::Region {
        x: 0,
        y: 0,
        width: 8,
        height: 8,
    });
    assert_eq!(schedule.bound(&settings(32)), 32);
    for tile in film.tiles_mut() {
        for index in 0..64 {
            for sample in 0..64 {
                tile.add(index, crate::color::Rgb::splat((sample % 3) as f32));
            }
        }
    }
    schedule.arrive(64, (&mut film, 1), &settings(64));
    assert!(schedule.has_all_samples(&settings(64)));
    assert!(!schedule.has_all_samples(&settings(128)));
    let bound = schedule.bound(&settings(128));
    schedule.arrive(bound, (&mut film, 1), &settings(128));
    assert!(!schedule.has_all_samples(&settings(128)));
    assert_eq!(film.pixel(3, 3).map(PixelStats::limit), Some(128));
}

/// Pixels that are traced together get the same, and the mean stays what it is.
#[test]
fn companions_get_the_same_samples() {
    let settings = settings(AdaptiveGoal::LeastError, 512);
    let mut film = picture(64);
    Schedule::default().arrive(64, (&mut film, 16), &settings);
    let limit = |[x, y]: [u32; 2]| film.pixel(x, y).map(PixelStats::limit);
    let mut limits = std::collections::HashSet::new();
    let mut clusters = film.tiles().iter().flat_map(|tile| tile.clusters(16));
    assert!(clusters.all(|cluster| {
        let mut of_cluster = cluster.pixels().filter_map(limit);
        let first = of_cluster.next();
        limits.extend(first);
        first.is_none_or(|first| of_cluster.all(|other| other == first))
    }));
    assert!(limits.len() > 3, "{limits:?}");
    let pixels = film.tiles().iter().flat_map(|tile| tile.pixels());
    let total: u64 = pixels.map(|pixel| u64::from(pixel.limit())).sum();
    let most = 128 * u64::from(WIDTH) * 32;
    assert!((most * 9 / 10..=most).contains(&total), "{total} of {most}");
}
