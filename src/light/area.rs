use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::parallelogram::Parallelogram;
use super::part::{AreaPart, Part, parts_of};
use super::{EmissionBounds, LightHit, LightSample, LightSampleContext, direction_to, usable_pdf};
use crate::color::{Rgb, luminance};
use crate::geometry::Shapes;
use crate::sampling::Distribution1d;

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
    /// What is sampled.
    parts: Vec<Part>,
    /// Each primitive with its part, by primitive.
    part_of: Vec<(u32, u32)>,
}

impl AreaLight {
    /// A light of the given shape that emits `radiance` from its front, or from both sides.
    ///
    /// The ids of [`AreaShape::Triangles`] must be of triangles of `shapes`, each at most once.
    /// Degenerate triangles emit nothing.
    pub fn new(shapes: &Shapes, shape: AreaShape, radiance: Rgb, two_sided: bool) -> Self {
        let (parts, part_of) = match &shape {
            AreaShape::Triangles { primitives } => parts_of(shapes, primitives),
            &AreaShape::Rectangle {
                corner,
                edge_u,
                edge_v,
            } => {
                let whole = Parallelogram::new(corner, edge_u, edge_v);
                (whole.map(Part::Parallelogram).into_iter().collect(), vec![])
            }
        };
        let areas: Vec<f32> = parts.iter().map(Part::area).collect();
        let usable = areas.iter().filter(|area| area.is_finite());
        Self {
            shape,
            radiance,
            two_sided,
            density: AreaDensity::Correct,
            area: usable.map(|&area| f64::from(area)).sum::<f64>() as f32,
            by_area: Distribution1d::new(&areas),
            parts,
            part_of,
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

    /// Number of parts that are sampled, those without area included.
    pub fn part_count(&self) -> usize {
        self.parts.len()
    }

    /// Part `index`, below [`Self::part_count`].
    pub fn part(&self, index: usize) -> AreaPart {
        self.parts[index].outline()
    }

    /// The part that `u` in [0, 1) picks in proportion to area; `None` for a light without area.
    pub fn choose_part(&self, u: f32) -> Option<usize> {
        self.by_area.as_ref().map(|parts| parts.sample(u).0)
    }

    /// The part that `primitive` belongs to, `u32::MAX` being the rectangle that rays do not meet;
    /// `None` when it is not of this light.
    pub fn part_of(&self, primitive: u32) -> Option<usize> {
        if primitive == u32::MAX {
            return (!self.parts.is_empty()).then_some(0);
        }
        let found = self.part_of.binary_search_by_key(&primitive, |pair| pair.0);
        found.ok().map(|place| self.part_of[place].1 as usize)
    }

    /// Total area of one side, in scene units squared.
    pub fn area(&self) -> f32 {
        self.area
    }

    /// Area of one side of part `index`, in scene units squared.
    pub fn part_area(&self, index: usize) -> f32 {
        self.parts[index].area()
    }

    /// Where part `index` is and where it shines; `None` when it has no area.
    pub(super) fn part_bounds(&self, index: usize) -> Option<EmissionBounds> {
        let part = &self.parts[index];
        let intensity = part.area() * luminance(self.radiance);
        let normal = part.normal()?;
        match part {
            Part::Triangle(triangle) => {
                EmissionBounds::flat(&triangle.corners, normal, intensity, self.two_sided)
            }
            Part::Parallelogram(whole) => {
                EmissionBounds::flat(&whole.corners(), normal, intensity, self.two_sided)
            }
        }
    }

    /// A point evenly spread over the area, of the part that `u_part` picks, and the unit normal there.
    pub(super) fn even_point(&self, u_part: f32, u: Vec2) -> Option<(Vec3, Vec3)> {
        let part = &self.parts[self.choose_part(u_part)?];
        Some((part.even_point(u), part.normal()?))
    }

    /// As [`Self::sample_part`], of a part chosen by area.
    pub(super) fn sample(
        &self,
        from: &LightSampleContext,
        u_choice: f32,
        u: Vec2,
    ) -> Option<LightSample> {
        let (part, pmf, _) = self.by_area.as_ref()?.sample(u_choice);
        let sample = self.sample_part(part, from, u)?;
        Some(LightSample {
            pdf: usable_pdf(pmf * sample.pdf)?,
            ..sample
        })
    }

    /// The density of [`Self::sample`].
    pub(super) fn pdf(&self, from: &LightSampleContext, wi: Vec3, hit: LightHit) -> f32 {
        let (Some(part), Some(by_area)) = (self.part_of(hit.primitive), &self.by_area) else {
            return 0.0;
        };
        by_area.pmf(part) * self.pdf_part(part, from, wi, hit)
    }

    /// A point of part `index`: by [`Part::sample`], evenly by area with [`AreaDensity::Course`].
    pub(super) fn sample_part(
        &self,
        index: usize,
        from: &LightSampleContext,
        u: Vec2,
    ) -> Option<LightSample> {
        let part = &self.parts[index];
        let normal = part.normal()?;
        let (point, pdf) = match self.density {
            AreaDensity::Correct => {
                let (point, pdf) = part.sample(from, u)?;
                (point, Some(pdf))
            }
            AreaDensity::Course => (part.even_point(u), None),
        };
        let (wi, distance) = direction_to(from.point, point)?;
        let cos = self.emission_cosine(normal, wi);
        if cos.is_nan() || cos <= 0.0 {
            return None;
        }
        let pdf = pdf.unwrap_or_else(|| course_pdf(part, distance, cos));
        Some(LightSample {
            wi,
            distance,
            radiance: self.radiance,
            pdf: usable_pdf(pdf)?,
            is_delta: false,
            point,
            normal,
        })
    }

    /// The density of [`Self::sample_part`] for the direction `wi`, which meets the part at `hit`.
    pub(super) fn pdf_part(
        &self,
        index: usize,
        from: &LightSampleContext,
        wi: Vec3,
        hit: LightHit,
    ) -> f32 {
        let part = &self.parts[index];
        let cos = self.emission_cosine(hit.normal, wi);
        if cos.is_nan() || cos <= 0.0 || part.area() <= 0.0 {
            return 0.0;
        }
        match self.density {
            AreaDensity::Correct => part.pdf(from, hit.point),
            AreaDensity::Course => course_pdf(part, hit.distance, cos),
        }
    }

    /// True for a single part: of several one that is near may be chosen rarely.
    pub(super) fn is_bounded(&self) -> bool {
        self.density == AreaDensity::Correct && self.parts.len() == 1
    }

    /// The parallelogram that is all of the light and is not sampled evenly by area.
    pub(super) fn only_parallelogram(&self) -> Option<&Parallelogram> {
        match (&self.parts[..], self.density) {
            ([Part::Parallelogram(only)], AreaDensity::Correct) => Some(only),
            _ => None,
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
}

/// Per steradian, for points evenly spread over the area of `part`, as the course's program has it.
fn course_pdf(part: &Part, distance: f32, cos: f32) -> f32 {
    distance / (part.area() * cos)
}
