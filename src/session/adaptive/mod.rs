//! When adaptive sampling ends a pixel, or how many samples it gets. Decisions are made between
//! passes, from the film alone, so that they depend neither on threads nor on time. Pixels that share
//! light are traced together anyway, so they get the same samples.

mod companions;
mod course;
mod even;
mod least_error;
mod schedule;

#[cfg(test)]
mod tests;

pub(super) use schedule::Schedule;

use crate::film::Film;

/// Sets the limit of each pixel of `film` to what `limit` says of its place in the region, row by
/// row.
fn set_limits(film: &mut Film, limit: impl Fn(usize) -> u32) {
    let region = film.region();
    for tile in film.tiles_mut() {
        for index in 0..tile.pixels().len() {
            let (x, y) = tile.position(index);
            let place = (y - region.y) * region.width + (x - region.x);
            tile.pixels_mut()[index].set_limit(limit(place as usize));
        }
    }
}
