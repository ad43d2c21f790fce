use super::Tile;
use super::tile::{BLOCK_HEIGHT, BLOCK_WIDTH};

/// Pixels that share their light: some of a block of 8 × 4 pixels of the picture, as far apart in
/// it as they can be and staggered from row to row, so that their alike noise shows neither as a patch
/// nor as stripes. Blocks lie on a grid that begins at pixel (0, 0), and reach over the edges of
/// pictures, regions and tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cluster {
    block: [u32; 2],
    /// In the block, of the first pixel.
    offset: [u32; 2],
    columns: u32,
    rows: u32,
    step: [u32; 2],
}

impl Cluster {
    /// The pixels, in the order of their numbers.
    pub fn pixels(&self) -> impl ExactSizeIterator<Item = [u32; 2]> + use<> {
        let Self {
            block: [x, y],
            offset: [dx, dy],
            columns,
            rows,
            step,
        } = *self;
        // One range, as two nested ones are slow for clusters of one pixel. All numbers are powers of
        // two.
        (0..columns * rows).map(move |number| {
            let (column, row) = (number & (columns - 1), number >> columns.ilog2());
            let stagger = (dx + row) & (step[0] - 1);
            [x + column * step[0] + stagger, y + row * step[1] + dy]
        })
    }
}

impl Tile {
    /// All clusters of `size` pixels, a power of two up to 32, of which some may lie in the tile,
    /// block by block.
    pub fn clusters(&self, size: u32) -> impl Iterator<Item = Cluster> + use<> {
        let area = self.area();
        let starts = |from: u32, length: u32, step: u32| {
            (from / step * step..from + length).step_by(step as usize)
        };
        let blocks = starts(area.y, area.height, BLOCK_HEIGHT)
            .flat_map(move |y| starts(area.x, area.width, BLOCK_WIDTH).map(move |x| [x, y]));
        // The more nearly square the better: 2 × 1, 2 × 2, 4 × 2, 4 × 4, 8 × 4.
        let columns = 1 << size.ilog2().div_ceil(2);
        let rows = size / columns;
        let step = [BLOCK_WIDTH / columns, BLOCK_HEIGHT / rows];
        blocks.flat_map(move |[x, y]| {
            (0..step[0] * step[1]).map(move |number| Cluster {
                block: [x, y],
                offset: [number & (step[0] - 1), number >> step[0].ilog2()],
                columns,
                rows,
                step,
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::super::Film;
    use crate::image::Region;

    #[test]
    fn clusters_hold_every_pixel_of_the_film_once() {
        let region = Region {
            x: 3,
            y: 5,
            width: 71,
            height: 45,
        };
        for size in [1, 2, 4, 8, 16, 32] {
            let mut seen = HashSet::new();
            for tile in Film::new(region).tiles() {
                let pixels = tile.clusters(size).flat_map(|cluster| {
                    assert_eq!(cluster.pixels().count(), size as usize);
                    cluster.pixels()
                });
                for [x, y] in pixels {
                    assert!(!tile.area().contains(x, y) || seen.insert([x, y]));
                }
            }
            assert_eq!(seen.len(), 71 * 45, "{size}");
        }
    }

    /// Whoever asks the pixels at its sides asks such as are independent.
    #[test]
    fn pixels_that_share_do_not_touch() {
        let film = Film::new(Region {
            x: 0,
            y: 0,
            width: 64,
            height: 32,
        });
        for size in [2, 4, 8, 16] {
            for cluster in (film.tiles().iter()).flat_map(|tile| tile.clusters(size)) {
                let pixels: Vec<_> = cluster.pixels().collect();
                for [x, y] in &pixels {
                    assert!(!pixels.contains(&[x + 1, *y]) && !pixels.contains(&[*x, y + 1]));
                }
            }
        }
    }

    #[test]
    fn clusters_do_not_depend_on_the_region() {
        let clusters = |region| {
            let film = Film::new(region);
            let all: HashSet<Vec<[u32; 2]>> = (film.tiles().iter())
                .flat_map(|tile| tile.clusters(8))
                .map(|cluster| cluster.pixels().collect())
                .collect();
            all
        };
        let region = |x, y, width, height| Region {
            x,
            y,
            width,
            height,
        };
        let whole = clusters(region(0, 0, 128, 96));
        assert!(clusters(region(35, 17, 40, 41)).is_subset(&whole));
    }
}
