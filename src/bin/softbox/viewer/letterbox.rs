//! Where the picture lies on the screen, and which pixel is under a point.

use eframe::egui::{Pos2, Rect, Vec2, pos2, vec2};
use softbox::image::Region;

/// A picture of `image` pixels shown inside `rect` of the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Letterbox {
    /// The picture's place in points.
    pub(super) rect: Rect,
    /// The picture's size in pixels.
    pub(super) image: [u32; 2],
}

impl Letterbox {
    /// The largest place in `view` with the picture's aspect; exactly its own size in physical
    /// pixels where it fits and differs by less than one and a half pixels.
    pub(super) fn fit(view: Rect, image: [u32; 2], pixels_per_point: f32) -> Self {
        let size = vec2(image[0].max(1) as f32, image[1].max(1) as f32);
        let scale = (view.width() / size.x).min(view.height() / size.y);
        let natural = size / pixels_per_point;
        let fitted = size * scale;
        let is_near = (fitted - natural).abs().max_elem() * pixels_per_point < 1.5;
        let shown = if is_near { natural } else { fitted };
        let corner = view.center() - shown * 0.5;
        // On whole physical pixels, so that nearest magnification shows every pixel alike.
        let snapped = (corner.to_vec2() * pixels_per_point).round() / pixels_per_point;
        Self {
            rect: Rect::from_min_size(snapped.to_pos2(), shown),
            image,
        }
    }

    /// The position in pixels of a point of the screen; may lie outside of the picture.
    pub(super) fn pixel_position(&self, point: Pos2) -> Vec2 {
        let unit = (point - self.rect.min) / self.rect.size();
        vec2(unit.x * self.image[0] as f32, unit.y * self.image[1] as f32)
    }

    /// The pixel under a point of the screen, `None` outside of the picture.
    pub(super) fn pixel(&self, point: Pos2) -> Option<[u32; 2]> {
        let position = self.pixel_position(point);
        let is_inside = position.min_elem() >= 0.0
            && position.x < self.image[0] as f32
            && position.y < self.image[1] as f32;
        is_inside.then_some([position.x as u32, position.y as u32])
    }

    /// The point of the screen at a position in pixels.
    pub(super) fn screen(&self, position: Vec2) -> Pos2 {
        let size = vec2(self.image[0].max(1) as f32, self.image[1].max(1) as f32);
        self.rect.min + position / size * self.rect.size()
    }

    /// The place of a region of the picture.
    pub(super) fn region_rect(&self, region: Region) -> Rect {
        Rect::from_min_max(
            self.screen(vec2(region.x as f32, region.y as f32)),
            self.screen(vec2(
                (region.x + region.width) as f32,
                (region.y + region.height) as f32,
            )),
        )
    }

    /// The pixels between two points of the screen, at least 2×2 of them inside of the picture.
    pub(super) fn region_between(&self, a: Pos2, b: Pos2) -> Option<Region> {
        let limit = vec2(self.image[0] as f32, self.image[1] as f32);
        let inside = |p: Pos2| self.pixel_position(p).clamp(Vec2::ZERO, limit);
        let (a, b) = (inside(a), inside(b));
        let (min, max) = (a.min(b).floor(), a.max(b).ceil());
        let size = max - min;
        (size.min_elem() >= 2.0).then_some(Region {
            x: min.x as u32,
            y: min.y as u32,
            width: size.x as u32,
            height: size.y as u32,
        })
    }
}

/// The rectangles that cover `outer` apart from `inner`.
pub(super) fn surrounding(outer: Rect, inner: Rect) -> [Rect; 4] {
    let inner = inner.intersect(outer);
    [
        Rect::from_min_max(outer.min, pos2(outer.max.x, inner.min.y)),
        Rect::from_min_max(pos2(outer.min.x, inner.max.y), outer.max),
        Rect::from_min_max(
            pos2(outer.min.x, inner.min.y),
            pos2(inner.min.x, inner.max.y),
        ),
        Rect::from_min_max(
            pos2(inner.max.x, inner.min.y),
            pos2(outer.max.x, inner.max.y),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_as_large_as_the_view_is_shown_pixel_for_pixel() {
        let view = Rect::from_min_size(pos2(10.3, 20.7), vec2(400.2, 300.1));
        let shown = Letterbox::fit(view, [800, 600], 2.0);
        assert_eq!(shown.rect.size(), vec2(400.0, 300.0));
        let corner = shown.rect.min.to_vec2() * 2.0;
        assert!((corner - corner.round()).length() < 1e-4);
    }

    #[test]
    fn pixels_and_points_agree() {
        let view = Rect::from_min_size(pos2(0.0, 0.0), vec2(640.0, 640.0));
        let shown = Letterbox::fit(view, [64, 48], 1.0);
        assert_eq!(shown.pixel(shown.rect.min + vec2(0.5, 0.5)), Some([0, 0]));
        assert_eq!(shown.pixel(shown.rect.max - vec2(0.5, 0.5)), Some([63, 47]));
        assert_eq!(shown.pixel(pos2(320.0, 10.0)), None);
        let at = shown.screen(vec2(12.5, 40.25));
        assert!((shown.pixel_position(at) - vec2(12.5, 40.25)).length() < 1e-4);
    }

    #[test]
    fn a_dragged_region_lies_inside_and_comes_back_to_its_place() {
        let view = Rect::from_min_size(pos2(0.0, 0.0), vec2(640.0, 480.0));
        let shown = Letterbox::fit(view, [64, 48], 1.0);
        let region = shown
            .region_between(pos2(-50.0, 100.0), pos2(205.0, 900.0))
            .unwrap();
        assert_eq!(
            (region.x, region.y, region.width, region.height),
            (0, 10, 21, 38)
        );
        assert_eq!(shown.region_rect(region).min, pos2(0.0, 100.0));
        assert_eq!(shown.region_between(pos2(5.0, 5.0), pos2(6.0, 6.0)), None);
    }

    #[test]
    fn what_surrounds_a_region_covers_the_rest_exactly() {
        let outer = Rect::from_min_size(pos2(0.0, 0.0), vec2(100.0, 80.0));
        let inner = Rect::from_min_size(pos2(20.0, 10.0), vec2(30.0, 40.0));
        let area: f32 = surrounding(outer, inner).iter().map(Rect::area).sum();
        assert_eq!(area, 100.0 * 80.0 - 30.0 * 40.0);
    }
}
