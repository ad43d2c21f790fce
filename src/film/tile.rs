use super::PixelStats;
use crate::image::Region;

/// Edge of a tile in pixels.
pub const TILE_SIZE: u32 = 32;

/// Width of a block of pixels that are traced together.
pub(super) const BLOCK_WIDTH: u32 = 8;
/// Its height.
pub(super) const BLOCK_HEIGHT: u32 = 4;

/// A rectangle of pixels of the film, the unit of work; at most [`TILE_SIZE`] wide and high.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    area: Region,
    pixels: Vec<PixelStats>,
}

impl Tile {
    /// Forgets all samples.
    pub fn clear(&mut self) {
        self.pixels.fill(PixelStats::default());
    }

    /// Where the tile lies in the image.
    pub fn area(&self) -> Region {
        self.area
    }

    /// Statistics row by row.
    pub fn pixels(&self) -> &[PixelStats] {
        &self.pixels
    }

    /// Statistics row by row, to be added to.
    pub fn pixels_mut(&mut self) -> &mut [PixelStats] {
        &mut self.pixels
    }

    /// Image coordinates of pixel number `index` of the tile.
    pub fn position(&self, index: usize) -> (u32, u32) {
        let index = index as u32;
        (
            self.area.x + index % self.area.width,
            self.area.y + index / self.area.width,
        )
    }

    /// The number in the tile of the pixel at image coordinates `x`, `y`, which lies inside.
    pub fn index(&self, x: u32, y: u32) -> usize {
        ((y - self.area.y) * self.area.width + (x - self.area.x)) as usize
    }
}

/// Tiles that cover `region`, row by row: what lies in it of a grid that begins at pixel (0, 0).
pub(super) fn cover(region: Region) -> Vec<Tile> {
    let (right, bottom) = (region.x + region.width, region.y + region.height);
    let mut tiles = Vec::new();
    for (y, height) in steps(region.y, bottom) {
        for (x, width) in steps(region.x, right) {
            let area = Region {
                x,
                y,
                width,
                height,
            };
            let pixels = vec![PixelStats::default(); (width * height) as usize];
            tiles.push(Tile { area, pixels });
        }
    }
    tiles
}

/// The number of tiles that the pixels from `start` up to `end` fall in.
pub(super) fn tiles_across(start: u32, end: u32) -> u32 {
    end.div_ceil(TILE_SIZE) - start / TILE_SIZE
}

/// Starts and lengths of those tiles.
fn steps(start: u32, end: u32) -> impl Iterator<Item = (u32, u32)> {
    (start / TILE_SIZE..end.div_ceil(TILE_SIZE)).map(move |tile| {
        let from = (tile * TILE_SIZE).max(start);
        (from, ((tile + 1) * TILE_SIZE).min(end) - from)
    })
}
