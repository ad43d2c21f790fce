use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::{EmissionBounds, LightHit, LightSample, direction_to, usable_pdf};
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
    /// Primitive and part, by primitive.
    by_primitive: Vec<(u32, u32)>,
}

/// A triangle or parallelogram of an area light.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Part {
    corner: Vec3,
    edge_1: Vec3,
    edge_2: Vec3,
    /// Unit; nothing for a part without area.
    normal: Option<Vec3>,
    /// Of one side.
    area: f32,
    primitive: u32,
}

impl Part {
    /// `share` is that of the parallelogram over the edges: a half for a triangle.
    fn new([corner, edge_1, edge_2]: [Vec3; 3], share: f32, primitive: u32) -> Self {
        let across = edge_1.cross(edge_2);
        Self {
            corner,
            edge_1,
            edge_2,
            normal: across.try_normalize(),
            area: share * across.length(),
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
        let parts: Vec<_> = match &shape {
            AreaShape::Triangles { primitives } => {
                let part = |&id: &u32| {
                    let [p0, p1, p2] = shapes.vertices(id as usize);
                    Part::new([p0, p1 - p0, p2 - p0], 0.5, id)
                };
                primitives.iter().map(part).collect()
            }
            &AreaShape::Rectangle {
                corner,
                edge_u,
                edge_v,
            } => vec![Part::new([corner, edge_u, edge_v], 1.0, u32::MAX)],
        };
        let areas: Vec<f32> = parts.iter().map(|part| part.area).collect();
        let usable = areas.iter().filter(|area| area.is_finite());
        let mut by_primitive: Vec<_> = parts.iter().map(|part| part.primitive).zip(0..).collect();
        by_primitive.sort_unstable();
        Self {
            shape,
            radiance,
            two_sided,
            density: AreaDensity::Correct,
            area: usable.map(|&area| f64::from(area)).sum::<f64>() as f32,
            by_area: Distribution1d::new(&areas),
            parts,
            by_primitive,
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

    /// The number of triangles, or 1 for a rectangle.
    pub fn part_count(&self) -> usize {
        self.parts.len()
    }

    /// The part that `primitive` belongs to, as [`Self::choose_part`] counts them; `None` when it
    /// is not of this light.
    pub(super) fn part_of(&self, primitive: u32) -> Option<usize> {
        if let AreaShape::Rectangle { .. } = self.shape {
            return Some(0);
        }
        let place = (self.by_primitive).binary_search_by_key(&primitive, |entry| entry.0);
        place.ok().map(|i| self.by_primitive[i].1 as usize)
    }

    /// Area of one side of part `part`, in scene units squared.
    pub fn part_area(&self, part: usize) -> f32 {
        self.parts[part].area
    }

    /// Where part `part` is and where it shines; `None` when it has no area.
    pub(super) fn part_bounds(&self, part: usize) -> Option<EmissionBounds> {
        let part = &self.parts[part];
        let (a, b, c) = (part.corner, part.edge_1, part.edge_2);
        let far = match self.shape {
            AreaShape::Triangles { .. } => a,
            AreaShape::Rectangle { .. } => a + b + c,
        };
        let intensity = part.area * luminance(self.radiance);
        EmissionBounds::flat(
            &[a, a + b, a + c, far],
            part.normal?,
            intensity,
            self.two_sided,
        )
    }

    /// A point of a part that is chosen by area.
    pub(super) fn sample(&self, from: Vec3, u_choice: f32, u: Vec2) -> Option<LightSample> {
        let (part, pmf, _) = self.by_area.as_ref()?.sample(u_choice);
        let sample = self.sample_part(part, from, u)?;
        Some(LightSample {
            pdf: usable_pdf(pmf * sample.pdf)?,
            ..sample
        })
    }

    /// The density of [`Self::sample`].
    pub(super) fn pdf(&self, wi: Vec3, hit: LightHit) -> f32 {
        let (Some(part), Some(by_area)) = (self.part_of(hit.primitive), &self.by_area) else {
            return 0.0;
        };
        by_area.pmf(part) * self.pdf_part(part, wi, hit)
    }

    /// A point evenly spread over part `part`.
    pub(super) fn sample_part(&self, part: usize, from: Vec3, u: Vec2) -> Option<LightSample> {
        let (point, normal) = self.point_on(part, u)?;
        let (wi, distance) = direction_to(from, point)?;
        let hit = LightHit {
            point,
            normal,
            distance,
            primitive: self.parts[part].primitive,
        };
        Some(LightSample {
            wi,
            distance,
            radiance: self.radiance,
            pdf: usable_pdf(self.pdf_part(part, wi, hit))?,
            is_delta: false,
            point,
            normal,
        })
    }

    /// The density of [`Self::sample_part`] for the direction `wi`, which meets the part at
    /// `hit`.
    pub(super) fn pdf_part(&self, part: usize, wi: Vec3, hit: LightHit) -> f32 {
        let (cos, area) = (self.emission_cosine(hit.normal, wi), self.parts[part].area);
        if !(cos > 0.0 && area > 0.0) {
            return 0.0;
        }
        // One factor at a time: the square of a tiny distance would vanish.
        let per_distance = hit.distance / (area * cos);
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

    /// Point and unit normal.
    fn point_on(&self, part: usize, u: Vec2) -> Option<(Vec3, Vec3)> {
        let part = &self.parts[part];
        let (b1, b2) = match self.shape {
            AreaShape::Triangles { .. } => uniform_triangle(u),
            AreaShape::Rectangle { .. } => (u.x, u.y),
        };
        let point = part.corner + b1 * part.edge_1 + b2 * part.edge_2;
        Some((point, part.normal?))
    }
}
