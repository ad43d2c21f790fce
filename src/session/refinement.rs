//! Whether a better hierarchy is worth its making: a pure decision from counts, no clock.

use crate::bvh::{BvhKind, BvhQuality};
use crate::integrator::PathCounts;
use crate::settings::RenderSettings;

/// Rays to come for each primitive from which a refinement pays. Refining one primitive takes about
/// as long as tracing twenty rays, and makes a ray about a quarter cheaper on meshes; it should pay
/// on others too.
const RAYS_PER_PRIMITIVE: f64 = 100.0;

/// True when the settings ask for a refined hierarchy of what they show. A view of the first hit
/// takes one ray a pixel: too few for a better tree to matter.
pub(super) fn is_asked_for(settings: &RenderSettings) -> bool {
    settings.bvh.kind == BvhKind::Sah
        && settings.bvh.quality == BvhQuality::High
        && !settings.view.is_first_hit()
}

/// Whether refining pays in a render that ends by itself, after the work in `counts`.
pub(super) fn is_worth_it(
    primitives: usize,
    settings: &RenderSettings,
    counts: &PathCounts,
) -> bool {
    rays_to_come(settings, counts) >= primitives as f64 * RAYS_PER_PRIMITIVE
}

/// Rays that are expected until the end. A number of samples says how many; a rule that may end
/// the render at any time is expected to let it go on for as long as it has lasted.
fn rays_to_come(settings: &RenderSettings, counts: &PathCounts) -> f64 {
    let done = (counts.closest_rays + counts.shadow_rays) as f64;
    let stop = &settings.stop;
    let by_samples = stop.samples_per_pixel.map(|samples| {
        let region = settings.active_region();
        let pixels = f64::from(region.width) * f64::from(region.height);
        let paths_done = counts.camera_rays as f64;
        let paths_to_come = (pixels * f64::from(samples) - paths_done).max(0.0);
        paths_to_come * done / paths_done.max(1.0)
    });
    let ends_any_time =
        stop.seconds.is_some() || stop.relative_error.is_some() || settings.adaptive.is_some();
    match by_samples {
        Some(rays) if ends_any_time => rays.min(done),
        Some(rays) => rays,
        None => done,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::{StopRule, View};

    fn settings(stop: StopRule) -> RenderSettings {
        RenderSettings {
            width: 100,
            height: 100,
            stop,
            ..RenderSettings::default()
        }
    }

    /// After `samples` per pixel of five rays each.
    fn counts(samples: u64) -> PathCounts {
        PathCounts {
            camera_rays: samples * 10_000,
            closest_rays: samples * 20_000,
            shadow_rays: samples * 30_000,
            ..PathCounts::default()
        }
    }

    #[test]
    fn many_samples_to_come_pay_and_few_do_not() {
        let of = |samples| {
            settings(StopRule {
                samples_per_pixel: Some(samples),
                ..StopRule::default()
            })
        };
        // 50 000 rays a sample; 10 000 primitives want a million rays.
        assert!(is_worth_it(10_000, &of(21), &counts(1)));
        assert!(!is_worth_it(10_000, &of(20), &counts(1)));
        assert!(!is_worth_it(10_000, &of(100), &counts(90)));
        assert!(!is_worth_it(10_000, &of(100), &counts(0)));
    }

    #[test]
    fn a_time_limit_is_trusted_as_far_as_the_render_has_come() {
        let mut by_time = settings(StopRule {
            seconds: Some(5.0),
            ..StopRule::default()
        });
        assert!(!is_worth_it(10_000, &by_time, &counts(19)));
        assert!(is_worth_it(10_000, &by_time, &counts(20)));
        by_time.stop.samples_per_pixel = Some(30);
        assert!(!is_worth_it(10_000, &by_time, &counts(20)));
    }

    #[test]
    fn only_trees_of_high_quality_and_pictures_of_many_rays_are_refined() {
        let good = settings(StopRule::default());
        assert!(is_asked_for(&good));
        let with = |edit: fn(&mut RenderSettings)| {
            let mut other = good.clone();
            edit(&mut other);
            is_asked_for(&other)
        };
        assert!(!with(|s| s.bvh.quality = BvhQuality::Standard));
        assert!(!with(|s| s.bvh.quality = BvhQuality::Fast));
        assert!(!with(|s| s.bvh.kind = BvhKind::Median));
        assert!(!with(|s| s.view = View::Cost));
        assert!(with(|s| s.view = View::Noise));
    }
}
