use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::batches::Batches;
use super::workers::Workers;
use crate::color::Rgb;
use crate::film::{Film, FilmSummary, Tile};
use crate::integrator::{PathCounts, PathId, PathTracer};
use crate::settings::IntegratorKind;

/// Forgets all samples of `film`; false when `stop` said so, asked before each tile.
pub(super) fn clear_pass(
    workers: &Workers,
    film: &mut Film,
    stop: &(dyn Fn() -> bool + Sync),
) -> bool {
    workers.install(|| {
        film.tiles_mut().par_iter_mut().all(|tile| {
            if stop() {
                return false;
            }
            tile.clear();
            true
        })
    })
}

/// [`Film::summary`], by all workers: on large pictures one alone would keep the others waiting.
pub(super) fn summary_pass(workers: &Workers, film: &Film) -> FilmSummary {
    let tiles: Vec<_> = workers.install(|| film.tiles().par_iter().map(Tile::summary).collect());
    tiles.into_iter().collect()
}

/// When a pass ends early; asked before each batch of paths.
#[derive(Clone, Copy)]
pub(super) struct Stop<'a> {
    /// Somebody wants something else.
    pub(super) at_once: &'a (dyn Fn() -> bool + Sync),
    /// The time is up. Heeded only after a batch: on a busy machine it may be up before the first
    /// one, every time, and the picture would never get on.
    pub(super) when_due: &'a (dyn Fn() -> bool + Sync),
}

/// Takes samples until every pixel of `film` has `target` of them or its own limit, or until `stop`
/// says so. The film is whole at any time: what a stopped pass left out, the next one takes up.
/// Returns the work done and whether every open pixel has reached `target`.
pub(super) fn render_pass(
    workers: &Workers,
    tracer: &PathTracer<'_>,
    integrator: IntegratorKind,
    film: &mut Film,
    target: u32,
    stop: Stop<'_>,
) -> (PathCounts, bool) {
    let has_begun = AtomicBool::new(false);
    let is_over = || (stop.at_once)() || (has_begun.load(Ordering::Relaxed) && (stop.when_due)());
    workers.install(|| {
        film.tiles_mut()
            .par_iter_mut()
            .with_max_len(1)
            .map(|tile| {
                workers.with_arrays(|arrays| {
                    let mut counts = PathCounts::default();
                    let mut batches = Batches::new(tile, target, tracer.cluster_size() as u32);
                    while batches.next(workers.batch_size(), &mut arrays.ids) {
                        if is_over() {
                            return (counts, false);
                        }
                        arrays.trace(tracer, integrator, &mut counts);
                        add_batch(tile, &arrays.ids, &arrays.radiance);
                        has_begun.store(true, Ordering::Relaxed);
                    }
                    (counts, true)
                })
            })
            .reduce(
                || (PathCounts::default(), true),
                |(mut counts, is_whole), other| {
                    counts += other.0;
                    (counts, is_whole && other.1)
                },
            )
    })
}

/// Adds the samples `ids`, of the given `radiance`, to those pixels of `tile` whose next ones they are.
pub(super) fn add_batch(tile: &mut Tile, ids: &[PathId], radiance: &[Rgb]) {
    for (id, &radiance) in ids.iter().zip(radiance) {
        let [x, y] = id.pixel;
        if !tile.area().contains(x, y) {
            continue;
        }
        let index = tile.index(x, y);
        if tile.pixels()[index].takes(id.sample) {
            tile.add(index, radiance);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::*;
    use crate::camera::{Camera, RayCamera};
    use crate::image::Region;
    use crate::integrator::PathSettings;
    use crate::scene::{PrepareSettings, cornell_box, prepare};
    use crate::settings::RenderSettings;

    /// On a busy machine the next snapshot may be due before a pass has begun.
    #[test]
    fn a_pass_that_is_always_late_gets_on() {
        let scene = cornell_box("box").finish();
        let scene = prepare(&scene, &PrepareSettings::default(), &|_, _| {
            ControlFlow::Continue(())
        })
        .expect("nothing asks it to stop");
        let camera = RayCamera::new(&Camera::default(), 80, 60, scene.normalization());
        let settings = PathSettings::from(&RenderSettings::default());
        let tracer = PathTracer::new(&scene, &camera, settings);
        let mut film = Film::new(Region {
            x: 0,
            y: 0,
            width: 80,
            height: 60,
        });
        let workers = Workers::new(2, true);
        let late = Stop {
            at_once: &|| false,
            when_due: &|| true,
        };
        // At least one batch of each pass; the last ones of tiles are smaller.
        let passes = (0..40).position(|_| {
            let integrator = IntegratorKind::Wavefront;
            render_pass(&workers, &tracer, integrator, &mut film, 2, late).1
        });
        assert!(passes.is_some());
        let never = Stop {
            at_once: &|| true,
            when_due: &|| false,
        };
        let integrator = IntegratorKind::Wavefront;
        let (counts, is_whole) = render_pass(&workers, &tracer, integrator, &mut film, 3, never);
        assert_eq!((counts.camera_rays, is_whole), (0, false));
    }
}
