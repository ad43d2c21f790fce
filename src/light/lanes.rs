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
    /// Where the light is near; there is no sample there then, and a single one must be taken.
    pub is_near: L::Mask,
    /// Unit vectors to the points.
    pub wi: Vec3Lanes<L>,
    /// The points.
    pub point: Vec3Lanes<L>,
    /// Densities per steradian.
    pub pdf: L,
}

/// A light of one parallelogram, whose samples are taken eight at a time where it is not near.
#[derive(Clone, Copy, Debug)]
pub struct ParallelogramLight<'a> {
    light: &'a AreaLight,
    shape: &'a Parallelogram,
}

impl Light {
    /// The light as such a one, if it is.
    pub fn as_parallelogram(&self) -> Option<ParallelogramLight<'_>> {
        match self {
            Self::Area(light) => Some(ParallelogramLight {
                light,
                shape: light.only_parallelogram()?,
            }),
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
        let normal = Vec3Lanes::splat(shape.normal);
        let height = normal.dot(segment).abs();
        let distance = distance2.sqrt();
        let pdf = density.pdf(place) * distance2 * distance / (L::splat(shape.area) * height);
        let wi = Vec3Lanes::new(
            segment.x / distance,
            segment.y / distance,
            segment.z / distance,
        );
        let zero = L::splat(0.0);
        let infinity = L::splat(f32::INFINITY);
        let cos = normal.dot(wi).neg();
        let cos = if self.light.is_two_sided() {
            cos.abs()
        } else {
            cos
        };
        let reaches = distance.gt(zero) & distance.lt(infinity) & cos.gt(zero);
        let is_sane = pdf.gt(zero) & pdf.lt(infinity);
        let is_near = self.is_near(from.point);
        LightSampleLanes {
            is_there: L::without(is_usable & reaches & is_sane, is_near),
            is_near,
            wi,
            point,
            pdf,
        }
    }

    #[inline(always)]
    fn is_near<L: Lanes>(&self, from: Vec3Lanes<L>) -> L::Mask {
        let shape = self.shape;
        let from_corner = from - Vec3Lanes::splat(shape.corner);
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let [dual_1, dual_2] = shape.duals();
        let x = from_corner.dot(Vec3Lanes::splat(dual_1)).max(zero).min(one);
        let y = from_corner.dot(Vec3Lanes::splat(dual_2)).max(zero).min(one);
        let away = from - at(shape, [x, y]);
        away.length_squared().lt(L::splat(shape.near2))
    }
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
