use super::PixelStats;
use crate::image::Region;

/// Edge of a tile in pixels.
pub const TILE_SIZE: u32 = 32;

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

/// Tiles that cover `region`, row by row.
pub(super) fn cover(region: Region) -> Vec<Tile> {
    let mut tiles = Vec::new();
    for y in (0..region.height).step_by(TILE_SIZE as usize) {
        for x in (0..region.width).step_by(TILE_SIZE as usize) {
            let area = Region {
                x: region.x + x,
                y: region.y + y,
                width: TILE_SIZE.min(region.width - x),
                height: TILE_SIZE.min(region.height - y),
            };
            let pixels = vec![PixelStats::default(); (area.width * area.height) as usize];
            tiles.push(Tile { area, pixels });
        }
    }
    tiles
}
