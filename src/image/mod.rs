//! Floor 2: plain pixels and rectangles of them.

mod compare;
mod flip;
mod region;
mod score;

pub use compare::{CompareError, Comparison, compare};
pub use region::Region;
pub use score::{Score, score};

/// A rectangle of pixels, row by row from the top left, y down.
#[derive(Clone, Debug, PartialEq)]
pub struct Image<T> {
    width: usize,
    height: usize,
    pixels: Vec<T>,
}

impl<T> Image<T> {
    /// An image from its rows.
    ///
    /// # Panics
    /// When `pixels` does not hold `width · height` values.
    pub fn from_pixels(width: usize, height: usize, pixels: Vec<T>) -> Self {
        assert_eq!(
            pixels.len(),
            width * height,
            "an image of {width}×{height} pixels"
        );
        Self {
            width,
            height,
            pixels,
        }
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// All pixels, row by row from the top.
    pub fn pixels(&self) -> &[T] {
        &self.pixels
    }

    /// The pixel in column `x` of row `y`.
    pub fn get(&self, x: usize, y: usize) -> &T {
        &self.pixels[y * self.width + x]
    }
}

impl<T: Clone> Image<T> {
    /// The pixels inside `region`.
    ///
    /// # Panics
    /// When the region reaches beyond the image.
    pub fn part(&self, region: Region) -> Self {
        let (width, height) = (region.width as usize, region.height as usize);
        let (x, y) = (region.x as usize, region.y as usize);
        let rows = (y..y + height).map(|y| y * self.width);
        let pixels = rows
            .flat_map(|row| &self.pixels[row + x..row + x + width])
            .cloned()
            .collect();
        Self::from_pixels(width, height, pixels)
    }

    /// An image of one value.
    pub fn filled(width: usize, height: usize, value: T) -> Self {
        Self {
            width,
            height,
            pixels: vec![value; width * height],
        }
    }
}
