use glam::{Vec2, Vec3};

use super::LightSampleContext;
use super::parallelogram::NEAR;
use super::triangle_warp::TriangleWarp;
use crate::sampling::uniform_triangle;

/// A flat emitter with three corners, and how it is sampled from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Triangle {
    pub(super) corners: [Vec3; 3],
    /// Unit; nothing without area.
    pub(super) normal: Option<Vec3>,
    /// Of one side.
    pub(super) area: f32,
    /// Centre of gravity.
    center: Vec3,
    /// Square of the distance from there below which points are near.
    near2: f32,
}

impl Triangle {
    pub(super) fn new(corners: [Vec3; 3]) -> Self {
        let [a, b, c] = corners;
        let cross = (b - a).cross(c - a);
        let longest2 = (b - a).length_squared();
        let longest2 = longest2.max((c - b).length_squared());
        let longest2 = longest2.max((a - c).length_squared());
        Self {
            corners,
            normal: cross.try_normalize(),
            area: 0.5 * cross.length(),
            center: (a + b + c) / 3.0,
            near2: NEAR * NEAR * longest2,
        }
    }

    /// A point evenly spread over the area.
    pub(super) fn even_point(&self, u: Vec2) -> Vec3 {
        let [a, b, c] = self.corners;
        let (b1, b2) = uniform_triangle(u);
        a + b1 * (b - a) + b2 * (c - a)
    }

    /// A point for `u` in [0, 1)², and its density per steradian; `None` where nothing of the light
    /// counts.
    pub(super) fn sample(&self, from: &LightSampleContext, u: Vec2) -> Option<(Vec3, f32)> {
        if self.is_near(from.point) {
            return Some(TriangleWarp::new(self, from)?.sample(u));
        }
        let point = self.even_point(u);
        Some((point, self.even_pdf(from.point, point)))
    }

    /// The density per steradian with which [`Self::sample`] makes `point`; 0 where it never does.
    pub(super) fn pdf(&self, from: &LightSampleContext, point: Vec3) -> f32 {
        if self.is_near(from.point) {
            TriangleWarp::new(self, from).map_or(0.0, |warp| warp.pdf(point))
        } else {
            self.even_pdf(from.point, point)
        }
    }

    /// True where the light fills so much of the view that its parts differ much in what they send. Beyond,
    /// what is even by area follows the light as well, and costs less.
    fn is_near(&self, from: Vec3) -> bool {
        from.distance_squared(self.center) < self.near2
    }

    /// r² / (A cos θ), the cosine as height over distance.
    fn even_pdf(&self, from: Vec3, point: Vec3) -> f32 {
        let segment = point - from;
        let height = self.normal.map_or(0.0, |normal| normal.dot(segment).abs());
        // One factor at a time: the third power of a tiny distance would vanish.
        let distance = segment.length();
        distance / height * distance / self.area * distance
    }
}
