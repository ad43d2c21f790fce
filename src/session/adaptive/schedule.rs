use super::{course, even, least_error};
use crate::film::Film;
use crate::settings::{Adaptive, AdaptiveGoal, RenderSettings};

/// How far a picture is, and where adaptive sampling decides next.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::session) struct Schedule {
    done: u32,
    allotted: Option<Allotted>,
    all_closed: bool,
}

/// What least error has given out.
#[derive(Clone, Copy, Debug)]
struct Allotted {
    /// Mean samples of all pixels.
    mean: u32,
    /// Most samples of a pixel.
    most: u32,
}

impl Schedule {
    /// Every pixel has this many samples, or its limit.
    pub(in crate::session) fn done(&self) -> u32 {
        self.done
    }

    /// Adaptive sampling has ended all pixels.
    pub(in crate::session) fn all_closed(&self) -> bool {
        self.all_closed
    }

    /// The number of samples that no pass may go beyond: of the next decision, or of the end.
    pub(in crate::session) fn bound(&self, settings: &RenderSettings) -> u32 {
        let end = settings.stop.samples_per_pixel.unwrap_or(u32::MAX);
        match (settings.adaptive, self.allotted) {
            (None, _) => end,
            (Some(_), Some(allotted)) => allotted.most,
            (Some(adaptive), None) => next_multiple(self.done, adaptive.batch).min(end),
        }
    }

    /// True when all samples per pixel of the stop rule are taken.
    pub(in crate::session) fn has_all_samples(&self, settings: &RenderSettings) -> bool {
        let end = settings.stop.samples_per_pixel;
        let reached = match self.allotted {
            None => self.done,
            Some(allotted) if self.done < allotted.most => 0,
            Some(allotted) => allotted.mean,
        };
        end.is_some_and(|end| reached >= end)
    }

    /// Takes note of a pass that has brought every pixel of `film` to `target` samples or its limit,
    /// and decides, if it is time to. Paths are traced in clusters of `cluster_size`.
    pub(in crate::session) fn arrive(
        &mut self,
        target: u32,
        (film, cluster_size): (&mut Film, usize),
        settings: &RenderSettings,
    ) {
        let bound = self.bound(settings);
        self.done = target;
        let Some(adaptive) = settings.adaptive else {
            return;
        };
        let is_decision = match self.allotted {
            None => target.is_multiple_of(adaptive.batch.max(1)),
            Some(_) => target >= bound,
        };
        match adaptive.goal {
            _ if !is_decision => {}
            AdaptiveGoal::LeastError => self.allot((film, cluster_size), &adaptive, settings),
            AdaptiveGoal::Even => even::decide((film, cluster_size), &adaptive, settings),
            AdaptiveGoal::Course => course::close_pixels(film, adaptive.tolerance),
        }
        if adaptive.goal != AdaptiveGoal::LeastError {
            let mut pixels = film.tiles().iter().flat_map(|tile| tile.pixels());
            self.all_closed = pixels.all(|pixel| pixel.is_closed());
        }
    }

    fn allot(&mut self, film: (&mut Film, usize), adaptive: &Adaptive, settings: &RenderSettings) {
        let end = settings.stop.samples_per_pixel.unwrap_or(u32::MAX);
        let mean = self.allotted.map_or(self.done, |allotted| allotted.mean);
        let next = next_multiple(mean, adaptive.batch).min(end);
        let most = if next > mean {
            let (least, most) = least_error::allot(film, next);
            self.done = least;
            most
        } else {
            self.done
        };
        self.allotted = Some(Allotted {
            mean: next.max(mean),
            most,
        });
    }
}

fn next_multiple(done: u32, batch: u32) -> u32 {
    let batch = batch.max(1);
    (done / batch).saturating_add(1).saturating_mul(batch)
}
