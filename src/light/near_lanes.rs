use glam::Vec2;

use super::cylinder_warp::LEVEL;
use super::parallelogram::Parallelogram;
use super::{ContextLanes, lanes::place_of};
use crate::math::{Lanes, Vec3Lanes};
use crate::sampling::BilinearLanes;

/// An [`super::cylinder_warp::EdgeFrame`] for each lane, seen from a point.
struct EdgeFrameLanes<L> {
    axis: Vec3Lanes<L>,
    across: Vec3Lanes<L>,
    length: L,
    width: L,
    shear: L,
    /// The first of the light's rows, distance to the axis and start along it.
    near_row: L,
    start: L,
    /// Distance to the plane.
    height: L,
}

/// The part of the light at one distance from the axis.
struct Row<L> {
    radius2: L,
    ends: [L; 2],
    distances: [L; 2],
    sines: L,
}

impl Parallelogram {
    /// Points and densities as [`super::cylinder_warp::CylinderWarp::sample`] gives them, the same bits,
    /// and where there are any.
    #[inline(always)]
    pub(super) fn sample_near<L: Lanes>(
        &self,
        from: &ContextLanes<L>,
        u: [L; 2],
    ) -> (Vec3Lanes<L>, L, L::Mask) {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let [px, py] = place_of(self, from.point);
        let beyond_x = (px - px.max(zero).min(one)).abs();
        let beyond_y = (py - py.max(zero).min(one)).abs();
        let is_second = ((beyond_x - L::splat(LEVEL)) * L::splat(self.frames[0].length))
            .gt(beyond_y * L::splat(self.frames[1].length));
        let to_corner = Vec3Lanes::splat(self.corner) - from.point;
        let signed_height = Vec3Lanes::splat(self.normal).dot(to_corner);
        let frame = self.frame_lanes(is_second, to_corner, signed_height.abs());
        let (middle, quarter, has_middle) = frame.fan();
        let near = frame.row(frame.near_row).sines;
        let far = frame.row(frame.near_row + frame.width).sines;
        let (density, is_usable) = BilinearLanes::new([
            self.near_weight(is_second, 0, from, near),
            self.near_weight(is_second, 1, from, near),
            self.near_weight(is_second, 2, from, far),
            self.near_weight(is_second, 3, from, far),
        ]);
        let place = density.sample(u);
        let tangent = quarter * (L::splat(2.0) * place[1] - one);
        let scale = one / (one + tangent * tangent);
        let cos = (one - tangent * tangent) * scale;
        let sin = L::splat(2.0) * tangent * scale;
        let sideways = middle[0] * cos + middle[1] * sin;
        let downwards = middle[1] * cos - middle[0] * sin;
        let x = frame.height * sideways / downwards.max(L::splat(f32::MIN_POSITIVE));
        // In this order a number that is none stays one.
        let x = frame.near_row.max(x);
        let x = (frame.near_row + frame.width).min(x);
        let row = frame.row(x);
        let y = row.at(place[0]);
        let down = Vec3Lanes::splat(self.normal).scale(one.copysign(signed_height));
        let point =
            from.point + frame.across.scale(x) + frame.axis.scale(y) + down.scale(frame.height);
        let pdf =
            density.pdf(place) * (one + tangent * tangent) / (L::splat(4.0) * quarter * row.sines);
        (point, pdf, is_usable & has_middle & quarter.gt(zero))
    }

    /// What a corner sends, in a row of the given difference of sines.
    #[inline(always)]
    fn near_weight<L: Lanes>(
        &self,
        is_second: L::Mask,
        corner: usize,
        from: &ContextLanes<L>,
        sines: L,
    ) -> L {
        let corner = Vec3Lanes::select(
            is_second,
            Vec3Lanes::splat(self.corners_along(1)[corner]),
            Vec3Lanes::splat(self.corners_along(0)[corner]),
        );
        let segment = corner - from.point;
        sines * from.normal.dot(segment).max(L::splat(0.0)) / segment.length()
    }

    #[inline(always)]
    fn frame_lanes<L: Lanes>(
        &self,
        is_second: L::Mask,
        to_corner: Vec3Lanes<L>,
        height: L,
    ) -> EdgeFrameLanes<L> {
        let [a, b] = &self.frames;
        let axis = Vec3Lanes::select(
            is_second,
            Vec3Lanes::splat(b.axis),
            Vec3Lanes::splat(a.axis),
        );
        let across = Vec3Lanes::select(
            is_second,
            Vec3Lanes::splat(b.across),
            Vec3Lanes::splat(a.across),
        );
        EdgeFrameLanes {
            axis,
            across,
            length: L::select(is_second, L::splat(b.length), L::splat(a.length)),
            width: L::select(is_second, L::splat(b.width), L::splat(a.width)),
            shear: L::select(is_second, L::splat(b.shear), L::splat(a.shear)),
            near_row: to_corner.dot(across),
            start: to_corner.dot(axis),
            height,
        }
    }
}

impl<L: Lanes> EdgeFrameLanes<L> {
    /// The middle of the angle that the rows fill, the tangent of a quarter of the angle, and where
    /// there is a middle.
    #[inline(always)]
    fn fan(&self) -> ([L; 2], L, L::Mask) {
        let (one, half) = (L::splat(1.0), L::splat(0.5));
        let near = unit([self.near_row, self.height]).0;
        let far = unit([self.near_row + self.width, self.height]).0;
        let sum = [near[0] + far[0], near[1] + far[1]];
        let length = (sum[0] * sum[0] + sum[1] * sum[1]).sqrt();
        let cos = half * length;
        let wide = (one - cos * cos).sqrt();
        let narrow = half * near[1] * far[1] * (self.width / self.height) / cos;
        let sin = L::select(cos.lt(half), wide, narrow);
        let (middle, has_middle) = unit(sum);
        (middle, sin / (one + cos), has_middle)
    }

    #[inline(always)]
    fn row(&self, x: L) -> Row<L> {
        let first = self.start + (x - self.near_row) * self.shear;
        let (a, b) = (first, first + self.length);
        let radius2 = x * x + self.height * self.height;
        let (da, db) = ((radius2 + a * a).sqrt(), (radius2 + b * b).sqrt());
        let outer = b * da + a.neg() * db;
        let inner = radius2 * self.length * (a + b) / (b * da + a * db);
        let is_aside = (a * b).gt(L::splat(0.0));
        Row {
            radius2,
            ends: [a, b],
            distances: [da, db],
            sines: L::select(is_aside, inner, outer) / (da * db),
        }
    }
}

impl<L: Lanes> Row<L> {
    #[inline(always)]
    fn at(&self, t: L) -> L {
        let rest = L::splat(1.0) - t;
        let ([a, b], [da, db]) = (self.ends, self.distances);
        let sine = rest * (a / da) + t * (b / db);
        let (ca, cb) = (self.radius2 / (da * da), self.radius2 / (db * db));
        let cos2 = rest * ca + t * cb + t * rest * self.sines * self.sines;
        let y = sine * (self.radius2 / cos2).sqrt();
        b.min(a.max(y))
    }
}

/// As [`Vec2::normalize_or_zero`], and where it has a direction.
#[inline(always)]
fn unit<L: Lanes>([x, y]: [L; 2]) -> ([L; 2], L::Mask) {
    let zero = L::splat(Vec2::ZERO.x);
    let inverse = L::splat(1.0) / (x * x + y * y).sqrt();
    let works = inverse.lt(L::splat(f32::INFINITY)) & inverse.gt(zero);
    (
        [
            L::select(works, x * inverse, zero),
            L::select(works, y * inverse, zero),
        ],
        works,
    )
}
