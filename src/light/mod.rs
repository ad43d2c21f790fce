//! Floor 4: what shines. Lights are sampled by solid angle from a point; all positions are in the
//! normalised space of the prepared scene, all directions are unit vectors. Two triangles that make a
//! parallelogram are one part of a light, sampled as a whole.

mod area;
mod bounds;
mod context;
mod corner_warp;
mod cylinder_warp;
mod directional;
mod emission;
mod environment;
mod lanes;
mod merge;
mod near_lanes;
mod parallelogram;
mod part;
mod point;
mod sampler;
mod sphere;
mod spot;
#[cfg(test)]
mod tests;
mod tree;
mod triangle;
mod triangle_warp;

use glam::{Vec2, Vec3};

use crate::color::Rgb;
use crate::geometry::Shapes;

pub use area::{AreaDensity, AreaLight, AreaShape};
pub use context::LightSampleContext;
pub(crate) use cylinder_warp::LEVEL;
pub use directional::DirectionalLight;
pub use emission::EmissionPoint;
pub use environment::{EnvironmentLight, EnvironmentPart};
pub use lanes::{ContextLanes, LightSampleLanes, ParallelogramLight};
pub(crate) use parallelogram::NEAR;
pub use part::AreaPart;
pub use point::{PointFalloff, PointLight};
pub use sampler::{LightChoice, LightGroup, LightSampler};
pub use sphere::SphereLight;
pub use spot::SpotLight;
pub use tree::{LightCluster, LightTree, Link};

use bounds::EmissionBounds;

/// An emitter of light.
#[derive(Clone, Debug, PartialEq)]
pub enum Light {
    /// Triangles or a rectangle.
    Area(AreaLight),
    /// A sphere of the scene.
    Sphere(SphereLight),
    /// A point that shines in all directions.
    Point(PointLight),
    /// A point that shines into a cone.
    Spot(SpotLight),
    /// Parallel light.
    Directional(DirectionalLight),
    /// Light from infinity, all directions.
    Environment(EnvironmentLight),
}

/// A direction in which a light is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Unit vector from the reference point to the light.
    pub wi: Vec3,
    /// Distance to the point on the light; infinite for light from infinity.
    pub distance: f32,
    /// Radiance that arrives along `wi` when nothing is in the way. For delta lights the irradiance
    /// on a surface that faces the light.
    pub radiance: Rgb,
    /// Density per steradian, finite and above 0; 1 for delta lights.
    pub pdf: f32,
    /// True when no other strategy can find this direction.
    pub is_delta: bool,
    /// The point on the light, the end of the shadow ray; unused for light from infinity.
    pub point: Vec3,
    /// The unit geometric normal at `point`; zero where there is none.
    pub normal: Vec3,
}

/// Where a ray met a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightHit {
    /// The point on the light.
    pub point: Vec3,
    /// The unit geometric normal there, on the front side.
    pub normal: Vec3,
    /// Distance from the reference point.
    pub distance: f32,
    /// The primitive that was hit, `u32::MAX` when there is none.
    pub primitive: u32,
}

impl LightHit {
    /// The ray left the scene: what it meets is the environment.
    pub const INFINITE: Self = Self {
        point: Vec3::ZERO,
        normal: Vec3::ZERO,
        distance: f32::INFINITY,
        primitive: u32::MAX,
    };
}

impl Light {
    /// A direction from `from` to the light, distributed so that bright parts are found often, and, where
    /// `from` has a normal, those that are bright on its side.
    ///
    /// `u_choice` picks a part of the light, `u` the place, all in [0, 1). `None` when the chosen
    /// place sends no light to `from` or the density is not finite and above 0; such a sample counts
    /// as black.
    pub fn sample(
        &self,
        shapes: &Shapes,
        from: &LightSampleContext,
        u_choice: f32,
        u: Vec2,
    ) -> Option<LightSample> {
        match self {
            Self::Area(area) => area.sample(from, u_choice, u),
            Self::Sphere(sphere) => sphere.sample(shapes, from.point, u),
            Self::Point(point) => point.sample(from.point),
            Self::Spot(spot) => spot.sample(from.point),
            Self::Directional(directional) => Some(directional.sample()),
            Self::Environment(environment) => environment.sample(u_choice, u),
        }
    }

    /// The density per steradian with which [`Self::sample`] makes `wi` from `from`, the same normal
    /// given; 0 for delta lights.
    ///
    /// `hit` is where the ray along `wi` meets this light, [`LightHit::INFINITE`] for the
    /// environment.
    pub fn pdf(&self, shapes: &Shapes, from: &LightSampleContext, wi: Vec3, hit: LightHit) -> f32 {
        match self {
            Self::Area(area) => area.pdf(from, wi, hit),
            Self::Sphere(sphere) => sphere.pdf(shapes, from.point, wi, hit),
            Self::Environment(environment) => environment.pdf(wi),
            Self::Point(_) | Self::Spot(_) | Self::Directional(_) => 0.0,
        }
    }

    /// The number of parts that are chosen one by one: the triangles or rectangles of an area
    /// light, 1 for all others.
    pub fn part_count(&self) -> usize {
        match self {
            Self::Area(area) => area.part_count(),
            _ => 1,
        }
    }

    /// The part that `primitive` of the scene belongs to; `None` when it is not of this light.
    pub fn part_of(&self, primitive: u32) -> Option<usize> {
        match self {
            Self::Area(area) => area.part_of(primitive),
            Self::Sphere(sphere) => (sphere.primitive == primitive).then_some(0),
            _ => None,
        }
    }

    /// As [`Self::sample`], from part `part` alone; `u_choice` is for lights of one part.
    pub fn sample_part(
        &self,
        shapes: &Shapes,
        part: usize,
        from: &LightSampleContext,
        (u_choice, u): (f32, Vec2),
    ) -> Option<LightSample> {
        match self {
            Self::Area(area) => area.sample_part(part, from, u),
            _ => self.sample(shapes, from, u_choice, u),
        }
    }

    /// The density of [`Self::sample_part`], as [`Self::pdf`].
    pub fn pdf_part(
        &self,
        shapes: &Shapes,
        part: usize,
        from: &LightSampleContext,
        (wi, hit): (Vec3, LightHit),
    ) -> f32 {
        match self {
            Self::Area(area) => area.pdf_part(part, from, wi, hit),
            _ => self.pdf(shapes, from, wi, hit),
        }
    }

    /// Where part `part` is and where it shines; `None` for what is dark, without extent, or from
    /// infinity.
    fn part_bounds(&self, shapes: &Shapes, part: usize) -> Option<EmissionBounds> {
        match self {
            Self::Area(area) => area.part_bounds(part),
            Self::Sphere(sphere) => sphere.bounds(shapes),
            Self::Point(point) => point.bounds(),
            Self::Spot(spot) => spot.bounds(),
            Self::Directional(_) | Self::Environment(_) => None,
        }
    }

    /// The radiance that the surface met at `hit` by a ray along `wi` sends back along it; black
    /// from the side that does not emit and for lights that are no surface.
    pub fn radiance_at(&self, hit: LightHit, wi: Vec3) -> Rgb {
        match self {
            Self::Area(area) => area.radiance_at(hit.normal, wi),
            Self::Sphere(sphere) => sphere.radiance_at(hit.normal, wi),
            Self::Point(_) | Self::Spot(_) | Self::Directional(_) | Self::Environment(_) => {
                Rgb::ZERO
            }
        }
    }

    /// The radiance that arrives from infinity along a ray in `direction` that leaves the scene;
    /// black for all but the environment. Camera rays do not see the ambient part.
    pub fn radiance_from_infinity(&self, direction: Vec3, is_camera_ray: bool) -> Rgb {
        match self {
            Self::Environment(environment) => environment.radiance(direction, is_camera_ray),
            _ => Rgb::ZERO,
        }
    }

    /// The luminance of the light's power, for choosing among lights; not negative.
    ///
    /// For light from infinity what passes a disk of `scene_radius`.
    pub fn power(&self, shapes: &Shapes, scene_radius: f32) -> f32 {
        match self {
            Self::Area(area) => area.power(),
            Self::Sphere(sphere) => sphere.power(shapes),
            Self::Point(point) => point.power(),
            Self::Spot(spot) => spot.power(),
            Self::Directional(directional) => directional.power(scene_radius),
            Self::Environment(environment) => environment.power(scene_radius),
        }
    }

    /// True when no sample counts for more than a few times the radiance, however near the light is and
    /// however it lies, so that a diffuse surface needs no other strategy to find it.
    pub fn is_bounded(&self) -> bool {
        match self {
            Self::Area(area) => area.is_bounded(),
            _ => false,
        }
    }

    /// True when rays cannot meet the light, so that only sampling finds it.
    pub fn is_delta(&self) -> bool {
        matches!(self, Self::Point(_) | Self::Spot(_) | Self::Directional(_))
    }

    /// True for an environment without a picture: no direction is much brighter than others.
    pub fn is_constant_sky(&self) -> bool {
        matches!(self, Self::Environment(environment) if environment.map().is_none())
    }

    /// True when the light has no place in the scene.
    pub fn is_infinite(&self) -> bool {
        matches!(self, Self::Directional(_) | Self::Environment(_))
    }
}

/// The density as it is when it can be divided by, else nothing.
fn usable_pdf(pdf: f32) -> Option<f32> {
    (pdf.is_finite() && pdf > 0.0).then_some(pdf)
}

/// Unit direction and distance from `from` to `to`; `None` when they coincide.
fn direction_to(from: Vec3, to: Vec3) -> Option<(Vec3, f32)> {
    let segment = to - from;
    let distance = segment.length();
    (distance > 0.0 && distance.is_finite()).then(|| (segment / distance, distance))
}
