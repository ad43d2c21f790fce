use serde::{Deserialize, Serialize};

/// A rectangle of pixels, y down, inside the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Region {
    /// Left edge.
    pub x: u32,
    /// Top edge.
    pub y: u32,
    /// Width, at least 1.
    pub width: u32,
    /// Height, at least 1.
    pub height: u32,
}

impl Region {
    /// The part of the region that lies in a `width` × `height` image; `None` when nothing does.
    pub fn clipped(self, width: u32, height: u32) -> Option<Self> {
        let (x, y) = (self.x.min(width), self.y.min(height));
        let right = self.x.saturating_add(self.width).min(width);
        let bottom = self.y.saturating_add(self.height).min(height);
        (right > x && bottom > y).then(|| Self {
            x,
            y,
            width: right - x,
            height: bottom - y,
        })
    }

    /// True when the pixel lies inside.
    pub fn contains(self, x: u32, y: u32) -> bool {
        x >= self.x && y >= self.y && x - self.x < self.width && y - self.y < self.height
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_are_clipped_to_the_image() {
        let region = |x, y, width, height| Region {
            x,
            y,
            width,
            height,
        };
        assert_eq!(
            region(10, 10, 100, 100).clipped(50, 40),
            Some(region(10, 10, 40, 30))
        );
        assert_eq!(region(50, 0, 5, 5).clipped(50, 40), None);
        assert_eq!(
            region(0, 0, u32::MAX, u32::MAX).clipped(7, 9),
            Some(region(0, 0, 7, 9))
        );
    }
}
