use std::sync::Arc;

use super::RenderJob;
use crate::bvh::{BvhQuality, BvhSettings};
use crate::settings::AdaptiveGoal;

/// How much of a running render a new job leaves standing, from nothing lost to all.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Change {
    /// The same picture.
    None,
    /// Another view, stop rule or number of threads: the film goes on.
    Continue,
    /// Another picture of the same runtime scene: a new film.
    Film,
    /// Another runtime scene.
    Scene,
}

impl Change {
    pub(super) fn between(old: &RenderJob, new: &RenderJob) -> Self {
        if old == new {
            return Self::None;
        }
        let (a, b) = (&old.settings, &new.settings);
        if !Arc::ptr_eq(&old.scene, &new.scene)
            || needs_new_tree(&a.bvh, &b.bvh)
            || a.course_compatible != b.course_compatible
            || a.isa != b.isa
        {
            return Self::Scene;
        }
        // The parts of the settings that do not touch the film are made equal; what still differs does.
        let mut film_settings = b.clone();
        film_settings.view = a.view;
        film_settings.stop = a.stop;
        film_settings.threads = a.threads;
        film_settings.bvh = a.bvh;
        let ends_between_decisions = a.adaptive.is_some_and(|adaptive| {
            let end = a.stop.samples_per_pixel.unwrap_or(0);
            adaptive.goal == AdaptiveGoal::LeastError && !end.is_multiple_of(adaptive.batch.max(1))
        });
        if ends_between_decisions && a.stop != b.stop {
            // The last samples were given out for this end.
            return Self::Film;
        }
        if old.camera != new.camera || *a != film_settings {
            Self::Film
        } else {
            Self::Continue
        }
    }
}

/// A tree of standard quality is what high quality begins with.
fn needs_new_tree(old: &BvhSettings, new: &BvhSettings) -> bool {
    let can_grow = (old.quality, new.quality) == (BvhQuality::Standard, BvhQuality::High);
    let as_before = BvhSettings {
        quality: old.quality,
        ..*new
    };
    if can_grow {
        as_before != *old
    } else {
        new != old
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;
    use crate::math::Isa;
    use crate::scene::Scene;
    use crate::settings::{Adaptive, RenderSettings, View};

    #[test]
    fn only_what_touches_the_film_drops_it() {
        let job = RenderJob {
            scene: Arc::new(Scene::default()),
            camera: Camera::default(),
            settings: RenderSettings::default(),
        };
        let with = |edit: fn(&mut RenderJob)| {
            let mut new = job.clone();
            edit(&mut new);
            Change::between(&job, &new)
        };
        assert_eq!(with(|_| ()), Change::None);
        assert_eq!(with(|j| j.settings.view = View::Noise), Change::Continue);
        assert_eq!(
            with(|j| j.settings.stop.samples_per_pixel = Some(9)),
            Change::Continue
        );
        assert_eq!(with(|j| j.settings.threads = 3), Change::Continue);
        assert_eq!(with(|j| j.settings.seed = 1), Change::Film);
        assert_eq!(with(|j| j.camera.lens_radius = 0.1), Change::Film);
        assert_eq!(with(|j| j.settings.bvh.leaf_size = 9), Change::Scene);
        assert_eq!(
            with(|j| j.settings.bvh.quality = BvhQuality::Standard),
            Change::Scene
        );
        assert_eq!(
            with(|j| j.settings.isa = Some(Isa::Portable)),
            Change::Scene
        );
        let mut least_error = job.clone();
        least_error.settings.adaptive = Some(Adaptive {
            batch: 32,
            tolerance: 0.05,
            goal: AdaptiveGoal::LeastError,
            exposure: 0.0,
        });
        for (end, change) in [(64, Change::Continue), (65, Change::Film)] {
            least_error.settings.stop.samples_per_pixel = Some(end);
            let mut longer = least_error.clone();
            longer.settings.stop.samples_per_pixel = Some(128);
            assert_eq!(Change::between(&least_error, &longer), change);
        }
        let mut standard = job.clone();
        standard.settings.bvh.quality = BvhQuality::Standard;
        assert_eq!(Change::between(&standard, &job), Change::Continue);
        let mut smaller_leaves = job.clone();
        smaller_leaves.settings.bvh.leaf_size = 2;
        assert_eq!(Change::between(&standard, &smaller_leaves), Change::Scene);
        assert_eq!(
            with(|j| j.scene = Arc::new(Scene::default())),
            Change::Scene
        );
    }
}
