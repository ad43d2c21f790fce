use glam::{Vec2, Vec3};

use super::LightSampleContext;
use super::merge::{Partner, parallelograms};
use super::parallelogram::Parallelogram;
use super::triangle::Triangle;
use crate::geometry::Shapes;

/// A flat part of an area light, counter-clockwise seen from its front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AreaPart {
    /// A triangle that makes no parallelogram with another.
    Triangle([Vec3; 3]),
    /// Two triangles that make a parallelogram, or the rectangle that rays do not meet.
    Parallelogram {
        /// One corner.
        corner: Vec3,
        /// From the corner to the next.
        edge_1: Vec3,
        /// From the corner to the one before.
        edge_2: Vec3,
    },
}

/// A part as it is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Part {
    Triangle(Triangle),
    Parallelogram(Parallelogram),
}

impl Part {
    /// Of one side.
    pub(super) fn area(&self) -> f32 {
        match self {
            Self::Triangle(triangle) => triangle.area,
            Self::Parallelogram(whole) => whole.area,
        }
    }

    /// Unit; nothing for a triangle without area.
    pub(super) fn normal(&self) -> Option<Vec3> {
        match self {
            Self::Triangle(triangle) => triangle.normal,
            Self::Parallelogram(whole) => Some(whole.normal),
        }
    }

    /// A point evenly spread over the area.
    pub(super) fn even_point(&self, u: Vec2) -> Vec3 {
        match self {
            Self::Triangle(triangle) => triangle.even_point(u),
            Self::Parallelogram(whole) => whole.at(u),
        }
    }

    /// A point for `u` in [0, 1)², distributed so that what it sends counts, and its density per steradian;
    /// `None` where nothing of the part counts.
    pub(super) fn sample(&self, from: &LightSampleContext, u: Vec2) -> Option<(Vec3, f32)> {
        match self {
            Self::Triangle(triangle) => triangle.sample(from, u),
            Self::Parallelogram(whole) => whole.sample(from, u),
        }
    }

    /// The density per steradian with which [`Self::sample`] makes `point`; 0 where it never does.
    pub(super) fn pdf(&self, from: &LightSampleContext, point: Vec3) -> f32 {
        match self {
            Self::Triangle(triangle) => triangle.pdf(from, point),
            Self::Parallelogram(whole) => whole.pdf(from, point),
        }
    }

    /// What others see of it.
    pub(super) fn outline(&self) -> AreaPart {
        match *self {
            Self::Triangle(triangle) => AreaPart::Triangle(triangle.corners),
            Self::Parallelogram(whole) => AreaPart::Parallelogram {
                corner: whole.corner,
                edge_1: whole.edge_1,
                edge_2: whole.edge_2,
            },
        }
    }
}

/// The parts of a light of triangles, and each primitive with its part, by primitive.
pub(super) fn parts_of(shapes: &Shapes, primitives: &[u32]) -> (Vec<Part>, Vec<(u32, u32)>) {
    let vertices = |&id: &u32| shapes.vertices(id as usize);
    let triangles: Vec<[Vec3; 3]> = primitives.iter().map(vertices).collect();
    let partners = parallelograms(&triangles);
    let mut parts = Vec::new();
    let mut part_of: Vec<(u32, u32)> = Vec::with_capacity(primitives.len());
    for (index, &primitive) in primitives.iter().enumerate() {
        let part = match partners[index] {
            Partner::Earlier(partner) => part_of[partner].1,
            Partner::Later(whole) => {
                parts.push(Part::Parallelogram(whole));
                parts.len() as u32 - 1
            }
            Partner::None => {
                parts.push(Part::Triangle(Triangle::new(triangles[index])));
                parts.len() as u32 - 1
            }
        };
        part_of.push((primitive, part));
    }
    part_of.sort_unstable();
    (parts, part_of)
}
