//! Floor 3: accumulated statistics of the picture, in disjoint tiles.

mod cluster;
mod pixel;
mod replicates;
mod rows;
mod tile;

pub use cluster::Cluster;
pub use pixel::PixelStats;
pub use rows::{Pooled, Rows};
pub use tile::{TILE_SIZE, Tile, TileSummary};

use crate::image::Region;

/// The running mean and variance of every pixel of a region, tile by tile.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    region: Region,
    replicates: u32,
    tiles: Vec<Tile>,
}

impl Film {
    /// An empty film of `region`.
    pub fn new(region: Region) -> Self {
        Self::with_replicates(region, 1)
    }

    /// An empty film of `region` that also keeps the means of `replicates` independent sequences
    /// of samples, at least 1, of each pixel.
    pub fn with_replicates(region: Region, replicates: u32) -> Self {
        Self {
            region,
            replicates,
            tiles: tile::cover(region, replicates),
        }
    }

    /// The sequences whose means are kept apart.
    pub fn replicates(&self) -> u32 {
        self.replicates
    }

    /// The pixels that the film covers, in image coordinates.
    pub fn region(&self) -> Region {
        self.region
    }

    /// The tiles; they are disjoint and cover the region.
    pub fn tiles(&self) -> &[Tile] {
        &self.tiles
    }

    /// The tiles, to be filled side by side.
    pub fn tiles_mut(&mut self) -> &mut [Tile] {
        &mut self.tiles
    }

    /// The statistics of the pixel at image coordinates `x`, `y`; `None` outside the region.
    pub fn pixel(&self, x: u32, y: u32) -> Option<&PixelStats> {
        if !self.region.contains(x, y) {
            return None;
        }
        let column = x / TILE_SIZE - self.region.x / TILE_SIZE;
        let tile = &self.tiles_of_row(y)[column as usize];
        Some(&tile.pixels()[tile.index(x, y)])
    }

    /// The tiles with the pixels of row `y` of the image, which the region has, from left to right.
    pub fn tiles_of_row(&self, y: u32) -> &[Tile] {
        let region = self.region;
        let columns = tile::tiles_across(region.x, region.x + region.width) as usize;
        let row = (y / TILE_SIZE - region.y / TILE_SIZE) as usize;
        &self.tiles[row * columns..(row + 1) * columns]
    }

    /// The pixels row by row, for what looks at neighbours.
    pub fn rows(&self) -> Rows {
        Rows::new(self)
    }

    /// Sums over all pixels: samples taken, and the relative squared error of the picture as the
    /// samples tell it ([`Tile::squared_error`]).
    pub fn summary(&self) -> FilmSummary {
        self.tiles.iter().map(Tile::summary).collect()
    }
}

/// What [`Film::summary`] tells.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FilmSummary {
    /// Number of pixels.
    pub pixels: u64,
    /// Samples in all pixels together.
    pub samples: u64,
    /// Most samples in one pixel.
    pub most: u32,
    /// Pixels with too few samples, whose error is unknown.
    pub unknown: u64,
    /// Root of the mean relative squared error; `None` while some pixel's error is unknown.
    pub relative_error: Option<f64>,
}

/// From those of all tiles of a film, in their order.
impl FromIterator<TileSummary> for FilmSummary {
    fn from_iter<I: IntoIterator<Item = TileSummary>>(tiles: I) -> Self {
        let mut summary = Self::default();
        let mut error = 0.0;
        for tile in tiles {
            error += tile.relative_squared_error;
            summary.unknown += tile.unknown;
            summary.pixels += tile.pixels;
            summary.samples += tile.samples;
            summary.most = summary.most.max(tile.most);
        }
        if summary.unknown == 0 && summary.pixels > 0 {
            summary.relative_error = Some((error / summary.pixels as f64).sqrt());
        }
        summary
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Rgb;

    #[test]
    fn tiles_cover_odd_regions_once_and_pixels_are_found() {
        let region = Region {
            x: 5,
            y: 7,
            width: 71,
            height: 45,
        };
        let mut film = Film::new(region);
        let covered: usize = film.tiles().iter().map(|t| t.pixels().len()).sum();
        assert_eq!(covered, 71 * 45);
        for tile in film.tiles_mut() {
            for i in 0..tile.pixels().len() {
                let (x, y) = tile.position(i);
                tile.pixels_mut()[i].add(Rgb::new(x as f32, y as f32, 0.0));
            }
        }
        for (x, y) in [(5, 7), (75, 51), (40, 40), (36, 38), (37, 39)] {
            assert_eq!(
                film.pixel(x, y).map(PixelStats::mean),
                Some([f64::from(x), f64::from(y), 0.0])
            );
        }
        assert!(film.pixel(4, 7).is_none() && film.pixel(76, 7).is_none());
    }
}
