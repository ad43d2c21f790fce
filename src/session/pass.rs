use rayon::prelude::*;

use super::workers::{WorkerArrays, Workers};
use crate::film::{Film, Tile};
use crate::integrator::{BATCH_SIZE, PathCounts, PathId, PathTracer};
use crate::settings::IntegratorKind;

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
                    while next_batch(tile, target, &mut arrays.ids) {
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

/// Collects the samples that `tile` still lacks, in rounds of one sample for each pixel, up to a
/// batch; false when there are none.
fn next_batch(tile: &Tile, target: u32, ids: &mut Vec<PathId>) -> bool {
    ids.clear();
    for round in 0.. {
        let before = ids.len();
        for (index, pixel) in tile.pixels().iter().enumerate() {
            let sample = pixel.count().saturating_add(round);
            if !pixel.is_closed() && sample < target {
                let (x, y) = tile.position(index);
                ids.push(PathId {
                    pixel: [x, y],
                    sample,
                });
            }
        }
        let added = ids.len() - before;
        if added == 0 || ids.len() + added > BATCH_SIZE {
            break;
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
