use glam::{Vec2, Vec3};

use super::LightSampleContext;
use super::parallelogram::Parallelogram;
use crate::sampling::Bilinear;

/// Samples a parallelogram far away: its area with a density that is bilinear between what the four
/// corners send to the point.
///
/// Hart, Pharr, Müller, Lopes, McGuire, Shirley 2020, "Practical Product Sampling by Fitting and
/// Composing Warps".
pub(super) struct CornerWarp<'a> {
    light: &'a Parallelogram,
    from: Vec3,
    density: Bilinear,
}

impl<'a> CornerWarp<'a> {
    /// `None` where the light lies wholly below the horizon of `from`.
    ///
    /// cos at the light / distance² is height / distance³, and the height is that of all corners. A
    /// corner below the horizon weighs nothing: the cosine times the distance is linear over the
    /// light, so that the density is above 0 wherever the light is above the horizon.
    pub(super) fn new(light: &'a Parallelogram, from: &LightSampleContext) -> Option<Self> {
        let weights = light.corners().map(|corner| {
            let segment = corner - from.point;
            let distance2 = segment.length_squared();
            from.foreshortened(segment, distance2.sqrt()) / (distance2 * distance2)
        });
        Some(Self {
            light,
            from: from.point,
            density: Bilinear::new(weights)?,
        })
    }

    /// Point and density per steradian.
    pub(super) fn sample(&self, u: Vec2) -> (Vec3, f32) {
        let place = self.density.sample(u);
        let point = self.light.at(place);
        (point, self.density_at(place, point))
    }

    /// Density per steradian at a point of the light.
    pub(super) fn pdf(&self, point: Vec3) -> f32 {
        let place = self.light.place_of(point);
        self.density_at(place.clamp(Vec2::ZERO, Vec2::ONE), point)
    }

    fn density_at(&self, place: Vec2, point: Vec3) -> f32 {
        let segment = point - self.from;
        let distance2 = segment.length_squared();
        let height = self.light.normal.dot(segment).abs();
        self.density.pdf(place) * distance2 * distance2.sqrt() / (self.light.area * height)
    }
}
