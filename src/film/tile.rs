use super::PixelStats;
use super::replicates::Replicates;
use crate::color::Rgb;
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
    replicates: Replicates,
}

/// What [`Tile::summary`] tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TileSummary {
    /// Number of pixels.
    pub pixels: u64,
    /// Samples in all pixels together.
    pub samples: u64,
    /// Most samples in one pixel.
    pub most: u32,
    /// Pixels with too few samples, whose error is unknown.
    pub unknown: u64,
    /// Sum of the relative squared errors of the others.
    pub relative_squared_error: f64,
}

impl Tile {
    /// Forgets all samples.
    pub fn clear(&mut self) {
        self.pixels.fill(PixelStats::default());
        self.replicates.clear();
    }

    /// Adds the next sample of pixel number `index`, of finite radiance.
    pub fn add(&mut self, index: usize, radiance: Rgb) {
        let pixel = &mut self.pixels[index];
        self.replicates.add(index, pixel.count(), radiance);
        pixel.add(radiance);
    }

    /// The squared error of the mean of pixel number `index` per channel: by its replicates where it
    /// has some, else by [`PixelStats::squared_error`]. `None` while there are too few samples.
    pub fn squared_error(&self, index: usize) -> Option<[f64; 3]> {
        let pixel = &self.pixels[index];
        if self.replicates.number() > 1 {
            self.replicates.squared_error(index, pixel.count())
        } else {
            pixel.squared_error()
        }
    }

    /// What the pixels add to [`super::Film::summary`].
    pub fn summary(&self) -> TileSummary {
        let counts = || self.pixels.iter().map(PixelStats::count);
        let (relative_squared_error, unknown) = self.relative_squared_error();
        TileSummary {
            pixels: self.pixels.len() as u64,
            samples: counts().map(u64::from).sum(),
            most: counts().max().unwrap_or(0),
            relative_squared_error,
            unknown,
        }
    }

    /// The sum over all pixels of their squared error relative to their brightness as in relMSE, the
    /// mean over the channels of e² / (µ² + 0.01); and the number of pixels whose error is unknown.
    ///
    /// The brightness µ is the pixel's own or that of its neighbours, whichever is less. Its own
    /// alone is large when, by chance, its error is: where few samples meet a light, that hides up to
    /// three quarters of the squared error.
    fn relative_squared_error(&self) -> (f64, u64) {
        let (width, height) = (self.area.width as usize, self.area.height as usize);
        let mut columns = vec![[0.0; 3]; width];
        let (mut sum, mut unknown) = (0.0, 0);
        for y in 0..height {
            let rows = y.saturating_sub(1)..(y + 2).min(height);
            for (x, column) in columns.iter_mut().enumerate() {
                let of_row = |row: usize| self.pixels[row * width + x].mean();
                *column = rows.clone().map(of_row).fold([0.0; 3], added);
            }
            for x in 0..width {
                let index = y * width + x;
                let around = x.saturating_sub(1)..(x + 2).min(width);
                let others = (around.len() * rows.len()).saturating_sub(1);
                let own = self.pixels[index].mean();
                let all = columns[around].iter().copied().fold([0.0; 3], added);
                match self.squared_error(index) {
                    Some(error) => sum += relative(error, own, all, others),
                    None => unknown += 1,
                }
            }
        }
        (sum, unknown)
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

fn added(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// The relative squared error of a pixel of mean `own`; `all` is the sum of the means of it and its
/// `others` neighbours.
fn relative(error: [f64; 3], own: [f64; 3], all: [f64; 3], others: usize) -> f64 {
    let of_channel = |c: usize| {
        let brightness = match others {
            0 => own[c],
            n => own[c].min((all[c] - own[c]) / n as f64),
        };
        error[c] / (brightness * brightness + 0.01)
    };
    (0..3).map(of_channel).sum::<f64>() / 3.0
}

/// Tiles that cover `region`, row by row: what lies in it of a grid that begins at pixel (0, 0), with
/// `replicates` of each pixel.
pub(super) fn cover(region: Region, replicates: u32) -> Vec<Tile> {
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
            tiles.push(Tile {
                area,
                replicates: Replicates::new(replicates, pixels.len()),
                pixels,
            });
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
