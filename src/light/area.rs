use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::{LightHit, LightSample, direction_to, usable_pdf};
use crate::color::{Rgb, luminance};
use crate::geometry::Shapes;
use crate::sampling::{Distribution1d, uniform_triangle};

/// Where an area light is.
#[derive(Clone, Debug, PartialEq)]
pub enum AreaShape {
    /// Triangles of the scene; the front is the side from which they are counter-clockwise.
    Triangles {
        /// Primitive ids.
        primitives: Vec<u32>,
    },
    /// A parallelogram that rays do not meet; the front is the side of `edge_u` × `edge_v`.
    Rectangle {
        /// One corner.
        corner: Vec3,
        /// From the corner to the next.
        edge_u: Vec3,
        /// From the corner to the one before.
        edge_v: Vec3,
    },
}

/// How the density over the area becomes one over directions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AreaDensity {
    /// r² / (A cos θ).
    #[default]
    Correct,
    /// r / (A cos θ), wrong, as in the course's program: its light falls off as 1/r. Only for
    /// reproducing its pictures.
    Course,
}

/// A flat emitter of constant radiance.
#[derive(Clone, Debug, PartialEq)]
pub struct AreaLight {
    shape: AreaShape,
    radiance: Rgb,
    two_sided: bool,
    density: AreaDensity,
    area: f32,
    /// Chooses among `parts` by area; nothing when the whole area is zero.
    by_area: Option<Distribution1d>,
    /// The triangles or the rectangle, at hand for sampling.
    parts: Vec<Part>,
}

/// A triangle or parallelogram of an area light.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Part {
    corner: Vec3,
    edge_1: Vec3,
    edge_2: Vec3,
    /// Unit; nothing for a part without area.
    normal: Option<Vec3>,
    primitive: u32,
}

impl Part {
    fn new(corner: Vec3, edge_1: Vec3, edge_2: Vec3, primitive: u32) -> Self {
        Self {
            corner,
            edge_1,
            edge_2,
            normal: edge_1.cross(edge_2).try_normalize(),
            primitive,
        }
    }
}

impl AreaLight {
    /// A light of the given shape that emits `radiance` from its front, or from both sides.
    ///
    /// The ids of [`AreaShape::Triangles`] must be of triangles of `shapes`. Degenerate triangles
    /// emit nothing.
    pub fn new(shapes: &Shapes, shape: AreaShape, radiance: Rgb, two_sided: bool) -> Self {
        let (parts, share): (Vec<_>, f32) = match &shape {
            AreaShape::Triangles { primitives } => {
                let parts = primitives.iter().map(|&id| {
                    let [p0, p1, p2] = shapes.vertices(id as usize);
                    Part::new(p0, p1 - p0, p2 - p0, id)
                });
                (parts.collect(), 0.5)
            }
            &AreaShape::Rectangle {
                corner,
                edge_u,
                edge_v,
            } => (vec![Part::new(corner, edge_u, edge_v, u32::MAX)], 1.0),
        };
        let area = |part: &Part| share * part.edge_1.cross(part.edge_2).length();
        let areas: Vec<f32> = parts.iter().map(area).collect();
        let usable = areas.iter().filter(|area| area.is_finite());
        Self {
            shape,
            radiance,
            two_sided,
            density: AreaDensity::Correct,
            area: usable.map(|&area| f64::from(area)).sum::<f64>() as f32,
            by_area: Distribution1d::new(&areas),
            parts,
        }
    }

    /// The same light with another rule for its density.
    #[must_use]
    pub fn with_density(self, density: AreaDensity) -> Self {
        Self { density, ..self }
    }

    /// Where the light is.
    pub fn shape(&self) -> &AreaShape {
        &self.shape
    }

    /// The radiance that the light emits.
    pub fn radiance(&self) -> Rgb {
        self.radiance
    }

    /// True when both sides emit.
    pub fn is_two_sided(&self) -> bool {
        self.two_sided
    }

    /// The rule for the density.
    pub fn density(&self) -> AreaDensity {
        self.density
    }

    /// The triangle that `u` in [0, 1) picks in proportion to area, counted from 0; 0 for a
    /// rectangle, `None` for a light without area.
    pub fn choose_part(&self, u: f32) -> Option<usize> {
        self.by_area.as_ref().map(|parts| parts.sample(u).0)
    }

    /// Total area of one side, in scene units squared.
    pub fn area(&self) -> f32 {
        self.area
    }

    /// A point evenly spread over the area.
    pub(super) fn sample(&self, from: Vec3, u_choice: f32, u: Vec2) -> Option<LightSample> {
        let (point, normal, primitive) = self.point_on(u_choice, u)?;
        let (wi, distance) = direction_to(from, point)?;
        let hit = LightHit {
            point,
            normal,
            distance,
            primitive,
        };
        Some(LightSample {
            wi,
            distance,
            radiance: self.radiance,
            pdf: usable_pdf(self.pdf(wi, hit))?,
            is_delta: false,
            point,
            normal,
        })
    }

    pub(super) fn pdf(&self, wi: Vec3, hit: LightHit) -> f32 {
        let cos = self.emission_cosine(hit.normal, wi);
        if !(cos > 0.0 && self.area > 0.0) {
            return 0.0;
        }
        // One factor at a time: the square of a tiny distance would vanish.
        let per_distance = hit.distance / (self.area * cos);
        match self.density {
            AreaDensity::Correct => per_distance * hit.distance,
            AreaDensity::Course => per_distance,
        }
    }

    pub(super) fn radiance_at(&self, normal: Vec3, wi: Vec3) -> Rgb {
        if self.emission_cosine(normal, wi) > 0.0 {
            self.radiance
        } else {
            Rgb::ZERO
        }
    }

    pub(super) fn power(&self) -> f32 {
        let sides = if self.two_sided { 2.0 } else { 1.0 };
        PI * sides * self.area * luminance(self.radiance)
    }

    /// Cosine at the light towards the viewer; not positive where nothing is emitted.
    fn emission_cosine(&self, normal: Vec3, wi: Vec3) -> f32 {
        let cos = -normal.dot(wi);
        if self.two_sided { cos.abs() } else { cos }
    }

    /// Point, unit normal and primitive.
    fn point_on(&self, u_choice: f32, u: Vec2) -> Option<(Vec3, Vec3, u32)> {
        let part = &self.parts[self.choose_part(u_choice)?];
        let (b1, b2) = match self.shape {
            AreaShape::Triangles { .. } => uniform_triangle(u),
            AreaShape::Rectangle { .. } => (u.x, u.y),
        };
        let point = part.corner + b1 * part.edge_1 + b2 * part.edge_2;
        Some((point, part.normal?, part.primitive))
    }
}
