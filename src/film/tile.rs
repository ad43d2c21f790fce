use super::PixelStats;
use crate::image::Region;

/// Edge of a tile in pixels.
pub const TILE_SIZE: u32 = 32;

/// Width of a block of pixels that are close together.
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

    /// Numbers of all pixels, block by block of 8 × 4 pixels, so that
    /// those that follow each other lie close together.
    pub fn in_blocks(&self) -> impl Iterator<Item = usize> {
        let Region { width, height, .. } = self.area;
        let starts = move |length: u32, step: u32| (0..length).step_by(step as usize);
        let blocks = starts(height, BLOCK_HEIGHT)
            .flat_map(move |y| starts(width, BLOCK_WIDTH).map(move |x| (x, y)));
        blocks.flat_map(move |(x, y)| {
            let (right, bottom) = ((x + BLOCK_WIDTH).min(width), (y + BLOCK_HEIGHT).min(height));
            (y..bottom).flat_map(move |y| (x..right).map(move |x| (y * width + x) as usize))
        })
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_hold_every_pixel_once() {
        let region = Region {
            x: 3,
            y: 5,
            width: 45,
            height: 35,
        };
        for tile in cover(region) {
            let mut order: Vec<_> = tile.in_blocks().collect();
            let (x, y) = (tile.area.x, tile.area.y);
            if tile.area.width >= BLOCK_WIDTH {
                assert!(order[..BLOCK_WIDTH as usize].is_sorted());
                let (right, _) = tile.position(order[BLOCK_WIDTH as usize - 1]);
                assert_eq!(right, x + BLOCK_WIDTH - 1);
            }
            assert_eq!(tile.position(order[0]), (x, y));
            order.sort_unstable();
            assert_eq!(order, (0..tile.pixels.len()).collect::<Vec<_>>());
        }
    }
}
