use glam::{Vec2, Vec3};

use super::LightSampleContext;
use super::corner_warp::CornerWarp;
use super::cylinder_warp::{CylinderWarp, EdgeFrame};

/// Points nearer than this multiple of the longest edge are near: the density of [`CornerWarp`] no longer
/// follows the light there, that of [`CylinderWarp`] does; likewise for triangles. Not a round number: whole surfaces would lie at
/// just that distance, and rounding would decide.
pub(crate) const NEAR: f32 = 1.037;

/// A flat emitter with four corners, and how it is sampled from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Parallelogram {
    /// One corner.
    pub(super) corner: Vec3,
    /// From the corner to the next.
    pub(super) edge_1: Vec3,
    /// From the corner to the one before.
    pub(super) edge_2: Vec3,
    /// Unit, along `edge_1 × edge_2`.
    pub(super) normal: Vec3,
    /// Above 0.
    pub(super) area: f32,
    /// Dual to the edges: their dot products with `p - corner` are the coordinates of p.
    dual_1: Vec3,
    dual_2: Vec3,
    /// Square of the distance below which points are near.
    pub(super) near2: f32,
    /// As it lies to axes along its edges.
    pub(super) frames: [EdgeFrame; 2],
}

impl Parallelogram {
    /// `None` without area.
    pub(super) fn new(corner: Vec3, edge_1: Vec3, edge_2: Vec3) -> Option<Self> {
        let cross = edge_1.cross(edge_2);
        let area = cross.length();
        let normal = cross.try_normalize()?;
        let longer2 = edge_1.length_squared().max(edge_2.length_squared());
        (area.is_finite() && area > 0.0).then(|| Self {
            corner,
            edge_1,
            edge_2,
            normal,
            area,
            dual_1: edge_2.cross(normal) / area,
            dual_2: normal.cross(edge_1) / area,
            near2: NEAR * NEAR * longer2,
            frames: EdgeFrame::both(edge_1, edge_2, normal),
        })
    }

    /// Dual to the edges: their dot products with `p - corner` are the coordinates of p.
    pub(super) fn duals(&self) -> [Vec3; 2] {
        [self.dual_1, self.dual_2]
    }

    /// The corners at (0, 0), (1, 0), (0, 1), (1, 1) of the unit square.
    pub(super) fn corners(&self) -> [Vec3; 4] {
        self.corners_along(0)
    }

    /// Start and end of the first row, then of the last, where rows run along the first (`edge` 0) or
    /// the second edge (1).
    #[inline]
    pub(super) fn corners_along(&self, edge: usize) -> [Vec3; 4] {
        let (along, other) = if edge == 0 {
            (self.edge_1, self.edge_2)
        } else {
            (self.edge_2, self.edge_1)
        };
        let next = self.corner + along;
        [self.corner, next, self.corner + other, next + other]
    }

    /// The point of the parallelogram that belongs to `place` in the unit square.
    pub(super) fn at(&self, place: Vec2) -> Vec3 {
        self.corner + place.x * self.edge_1 + place.y * self.edge_2
    }

    /// The inverse of [`Self::at`] for the point of the plane that is nearest to `point`.
    pub(super) fn place_of(&self, point: Vec3) -> Vec2 {
        let from_corner = point - self.corner;
        Vec2::new(from_corner.dot(self.dual_1), from_corner.dot(self.dual_2))
    }

    /// True where the light fills so much of the view that its parts differ much in what they send.
    fn is_near(&self, from: Vec3) -> bool {
        let nearest = self.at(self.place_of(from).clamp(Vec2::ZERO, Vec2::ONE));
        from.distance_squared(nearest) < self.near2
    }

    /// A point for `u` in [0, 1)², and its density per steradian; `None` where nothing of the light
    /// counts.
    pub(super) fn sample(&self, from: &LightSampleContext, u: Vec2) -> Option<(Vec3, f32)> {
        if self.is_near(from.point) {
            Some(CylinderWarp::new(self, from)?.sample(u))
        } else {
            Some(CornerWarp::new(self, from)?.sample(u))
        }
    }

    /// The density per steradian with which [`Self::sample`] makes `point`; 0 where it never does.
    pub(super) fn pdf(&self, from: &LightSampleContext, point: Vec3) -> f32 {
        if self.is_near(from.point) {
            CylinderWarp::new(self, from).map_or(0.0, |warp| warp.pdf(point))
        } else {
            CornerWarp::new(self, from).map_or(0.0, |warp| warp.pdf(point))
        }
    }
}
