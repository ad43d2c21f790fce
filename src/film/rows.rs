use super::Film;

/// What is known of the pixels of a film, row by row from the top of its region.
#[derive(Clone, Debug)]
pub struct Rows {
    width: usize,
    height: usize,
    pixels: Vec<Known>,
}

/// What is known of one pixel.
#[derive(Clone, Copy, Debug)]
struct Known {
    mean: [f64; 3],
    /// Squared error of the mean times the number of samples; `None` while it is unknown.
    per_sample: Option<[f64; 3]>,
    count: u32,
}

/// A pixel and its neighbours taken together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pooled {
    /// Mean radiance of all.
    pub mean: [f64; 3],
    /// Mean squared error of one of them, had it as many samples as the one in the middle.
    pub squared_error: [f64; 3],
    /// How many they are.
    pub pixels: usize,
}

impl Pooled {
    /// Root of the squared error relative to the brightness as in relMSE.
    pub fn relative_error(&self) -> f64 {
        let of_channel = |c: usize| self.squared_error[c] / (self.mean[c] * self.mean[c] + 0.01);
        ((0..3).map(of_channel).sum::<f64>() / 3.0).sqrt()
    }
}

impl Rows {
    pub(super) fn new(film: &Film) -> Self {
        let region = film.region();
        let mut pixels = Vec::with_capacity((region.width * region.height) as usize);
        for y in region.y..region.y + region.height {
            for tile in film.tiles_of_row(y) {
                let area = tile.area();
                let start = tile.index(area.x, y);
                pixels.extend((start..start + area.width as usize).map(|index| {
                    let pixel = &tile.pixels()[index];
                    let n = f64::from(pixel.count());
                    Known {
                        mean: pixel.mean(),
                        per_sample: tile.squared_error(index).map(|e| e.map(|e| e * n)),
                        count: pixel.count(),
                    }
                }));
            }
        }
        Self {
            width: region.width as usize,
            height: region.height as usize,
            pixels,
        }
    }

    /// Pixels in a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Samples of the pixel at column `x` of row `y`.
    pub fn count(&self, x: usize, y: usize) -> u32 {
        self.pixels[y * self.width + x].count
    }

    /// Mean radiance of the pixel at column `x` of row `y`.
    pub fn mean(&self, x: usize, y: usize) -> [f64; 3] {
        self.pixels[y * self.width + x].mean
    }

    /// The 3×3 pixels about column `x` of row `y`, fewer at the border, together; `None` while the
    /// error of one is unknown.
    pub fn pooled(&self, x: usize, y: usize) -> Option<Pooled> {
        self.pooled_where((x, y), |_, _| true)
    }

    /// The same for the four pixels at its sides: what they say is independent of its samples, since
    /// pixels that share their light never touch ([`super::Cluster`]). `None` also where there are no
    /// neighbours.
    pub fn pooled_neighbours(&self, x: usize, y: usize) -> Option<Pooled> {
        let pooled = self.pooled_where((x, y), |column, row| (column == x) != (row == y));
        pooled.filter(|pooled| pooled.pixels > 0)
    }

    fn pooled_where(
        &self,
        (x, y): (usize, usize),
        takes: impl Fn(usize, usize) -> bool,
    ) -> Option<Pooled> {
        let (mut mean, mut per_sample, mut pixels) = ([0.0; 3], [0.0; 3], 0_usize);
        for row in y.saturating_sub(1)..(y + 2).min(self.height) {
            let columns = x.saturating_sub(1)..(x + 2).min(self.width);
            for column in columns.filter(|&column| takes(column, row)) {
                let pixel = &self.pixels[row * self.width + column];
                let error = pixel.per_sample?;
                for c in 0..3 {
                    mean[c] += pixel.mean[c];
                    per_sample[c] += error[c];
                }
                pixels += 1;
            }
        }
        let n = pixels as f64;
        let samples = f64::from(self.count(x, y));
        Some(Pooled {
            mean: mean.map(|m| m / n),
            squared_error: per_sample.map(|e| e / n / samples),
            pixels,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Rgb;
    use crate::image::Region;

    #[test]
    fn rows_are_in_image_order_and_neighbours_are_pooled() {
        let region = Region {
            x: 3,
            y: 5,
            width: 70,
            height: 40,
        };
        let mut film = Film::new(region);
        for tile in film.tiles_mut() {
            for index in 0..tile.pixels().len() {
                let (x, y) = tile.position(index);
                for z in [0.0, 2.0] {
                    tile.add(index, Rgb::new(x as f32, y as f32, z));
                }
            }
        }
        let rows = film.rows();
        for (x, y) in [(0, 0), (69, 39), (31, 32), (64, 1)] {
            assert_eq!(rows.mean(x, y), [3.0 + x as f64, 5.0 + y as f64, 1.0]);
        }
        let pooled = rows.pooled(32, 31).unwrap();
        assert_eq!((pooled.pixels, pooled.mean), (9, [35.0, 36.0, 1.0]));
        // Half the difference of the halves is 1.
        assert_eq!(pooled.squared_error, [0.0, 0.0, 1.0]);
        assert_eq!(rows.pooled(0, 0).unwrap().pixels, 4);
        let corner = rows.pooled_neighbours(0, 0).unwrap();
        assert_eq!((corner.pixels, corner.mean[0]), (2, 3.5));
        assert_eq!(rows.pooled(69, 3).unwrap().pixels, 6);
    }
}
