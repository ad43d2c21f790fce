use rayon::prelude::*;

use super::workers::{WorkerArrays, Workers};
use crate::film::{Film, Tile};
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

/// Takes samples until every open pixel of `film` has `target` of them or `stop` says so; it is
/// asked before each batch of paths. The film is whole at any time: what a stopped pass left out,
/// the next one takes up. Returns the work done and whether every open pixel has reached `target`.
pub(super) fn render_pass(
    workers: &Workers,
    tracer: &PathTracer<'_>,
    integrator: IntegratorKind,
    film: &mut Film,
    target: u32,
    stop: &(dyn Fn() -> bool + Sync),
) -> (PathCounts, bool) {
    workers.install(|| {
        film.tiles_mut()
            .par_iter_mut()
            .with_max_len(1)
            .map(|tile| {
                workers.with_arrays(|arrays| {
                    let mut counts = PathCounts::default();
                    while next_batch(tile, target, workers.batch_size(), &mut arrays.ids) {
                        if stop() {
                            return (counts, false);
                        }
                        arrays.trace(tracer, integrator, &mut counts);
                        add_batch(tile, arrays);
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

/// Collects up to `size` of the samples that `tile` still lacks, lowest numbers first; false when
/// there are none.
fn next_batch(tile: &Tile, target: u32, size: usize, ids: &mut Vec<PathId>) -> bool {
    ids.clear();
    let open = || {
        tile.in_blocks()
            .map(|index| (index, &tile.pixels()[index]))
            .filter(|(_, pixel)| !pixel.is_closed())
    };
    let first = open()
        .map(|(_, pixel)| pixel.count())
        .min()
        .unwrap_or(target);
    for sample in first..target {
        for (index, _) in open().filter(|(_, pixel)| pixel.count() <= sample) {
            let (x, y) = tile.position(index);
            ids.push(PathId {
                pixel: [x, y],
                sample,
            });
            if ids.len() == size {
                return true;
            }
        }
    }
    !ids.is_empty()
}

fn add_batch(tile: &mut Tile, arrays: &WorkerArrays) {
    for (id, &radiance) in arrays.ids.iter().zip(&arrays.radiance) {
        let index = tile.index(id.pixel[0], id.pixel[1]);
        tile.pixels_mut()[index].add(radiance);
    }
}
