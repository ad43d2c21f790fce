use glam::Vec3;

use super::parallelogram::Parallelogram;
use super::{AreaLight, Light};
use crate::math::{Lanes, Vec3Lanes};
use crate::sampling::BilinearLanes;

/// What [`super::LightSampleContext`] is for one surface point.
#[derive(Clone, Copy, Debug)]
pub struct ContextLanes<L> {
    /// The points that are lit.
    pub point: Vec3Lanes<L>,
    /// Unit normals on the sides that are lit.
    pub normal: Vec3Lanes<L>,
}

/// Points of a light for eight surface points, as [`super::LightSample`] has them.
#[derive(Clone, Copy, Debug)]
pub struct LightSampleLanes<L: Lanes> {
    /// Where there is a sample.
    pub is_there: L::Mask,
    /// Unit vectors to the points.
    pub wi: Vec3Lanes<L>,
    /// The points.
    pub point: Vec3Lanes<L>,
    /// Densities per steradian.
    pub pdf: L,
}

/// A light of one parallelogram, whose samples are taken as many at a time as there are lanes.
#[derive(Clone, Copy, Debug)]
pub struct ParallelogramLight<'a> {
    light: &'a AreaLight,
    shape: &'a Parallelogram,
}

impl Light {
    /// The light as such a one, if it is.
    pub fn as_parallelogram(&self) -> Option<ParallelogramLight<'_>> {
        match self {
            Self::Area(light) => {
                let shape = light.only_parallelogram()?;
                Some(ParallelogramLight { light, shape })
            }
            _ => None,
        }
    }
}

impl ParallelogramLight<'_> {
    /// The radiance of the light.
    pub fn radiance(&self) -> Vec3 {
        self.light.radiance()
    }

    /// The unit normal of its front.
    pub fn normal(&self) -> Vec3 {
        self.shape.normal
    }

    /// As [`Light::sample`], the same bits.
    #[inline(always)]
    pub fn sample<L: Lanes>(&self, from: &ContextLanes<L>, u: [L; 2]) -> LightSampleLanes<L> {
        let shape = self.shape;
        let is_near = self.is_near(from.point);
        let near = L::bits(is_near);
        let all_near = near == L::ALL;
        let (mut point, mut pdf, mut is_there) = if all_near {
            shape.sample_near(from, u)
        } else {
            sample_far(shape, from, u)
        };
        if near != 0 && !all_near {
            let (near_point, near_pdf, near_there) = shape.sample_near(from, u);
            point = Vec3Lanes::select(is_near, near_point, point);
            pdf = L::select(is_near, near_pdf, pdf);
            is_there = (near_there & is_near) | L::without(is_there, is_near);
        }
        let segment = point - from.point;
        let distance = segment.length();
        let wi = Vec3Lanes::new(
            segment.x / distance,
            segment.y / distance,
            segment.z / distance,
        );
        let zero = L::splat(0.0);
        let infinity = L::splat(f32::INFINITY);
        let cos = Vec3Lanes::splat(shape.normal).dot(wi).neg();
        let cos = if self.light.is_two_sided() {
            cos.abs()
        } else {
            cos
        };
        let reaches = distance.gt(zero) & distance.lt(infinity) & cos.gt(zero);
        let is_sane = pdf.gt(zero) & pdf.lt(infinity);
        LightSampleLanes {
            is_there: is_there & reaches & is_sane,
            wi,
            point,
            pdf,
        }
    }

    #[inline(always)]
    fn is_near<L: Lanes>(&self, from: Vec3Lanes<L>) -> L::Mask {
        let shape = self.shape;
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let [x, y] = place_of(shape, from);
        let nearest = at(shape, [x.max(zero).min(one), y.max(zero).min(one)]);
        (from - nearest).length_squared().lt(L::splat(shape.near2))
    }
}

/// Points and densities as [`super::corner_warp::CornerWarp::sample`] gives them, and where there are
/// any.
#[inline(always)]
fn sample_far<L: Lanes>(
    shape: &Parallelogram,
    from: &ContextLanes<L>,
    u: [L; 2],
) -> (Vec3Lanes<L>, L, L::Mask) {
    let corners = shape.corners();
    let (density, is_usable) = BilinearLanes::new([
        weight(from, corners[0]),
        weight(from, corners[1]),
        weight(from, corners[2]),
        weight(from, corners[3]),
    ]);
    let place = density.sample(u);
    let point = at(shape, place);
    let segment = point - from.point;
    let distance2 = segment.length_squared();
    let height = Vec3Lanes::splat(shape.normal).dot(segment).abs();
    let pdf = density.pdf(place) * distance2 * distance2.sqrt() / (L::splat(shape.area) * height);
    (point, pdf, is_usable)
}

/// As [`Parallelogram::place_of`].
#[inline(always)]
pub(super) fn place_of<L: Lanes>(shape: &Parallelogram, point: Vec3Lanes<L>) -> [L; 2] {
    let from_corner = point - Vec3Lanes::splat(shape.corner);
    let [dual_1, dual_2] = shape.duals();
    [
        from_corner.dot(Vec3Lanes::splat(dual_1)),
        from_corner.dot(Vec3Lanes::splat(dual_2)),
    ]
}

/// What a corner sends, both cosines counted, as [`super::corner_warp::CornerWarp`] weighs it.
#[inline(always)]
fn weight<L: Lanes>(from: &ContextLanes<L>, corner: Vec3) -> L {
    let segment = Vec3Lanes::splat(corner) - from.point;
    let distance2 = segment.length_squared();
    from.normal.dot(segment).max(L::splat(0.0)) / (distance2 * distance2)
}

#[inline(always)]
fn at<L: Lanes>(shape: &Parallelogram, [x, y]: [L; 2]) -> Vec3Lanes<L> {
    Vec3Lanes::splat(shape.corner)
        + Vec3Lanes::splat(shape.edge_1).scale(x)
        + Vec3Lanes::splat(shape.edge_2).scale(y)
}
