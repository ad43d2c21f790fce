//! Floor 3: how a surface scatters light at a point. Directions are unit vectors in the frame of the
//! shading normal (z), pointing away from the surface.

mod beckmann;
mod diffuse;
mod erf;
mod fresnel;
mod glass;
mod microfacet;
mod mirror;
mod refraction;
#[cfg(test)]
mod tests;

use glam::{Vec2, Vec3};

use crate::color::Rgb;

pub use diffuse::Diffuse;
pub use glass::Glass;
pub use microfacet::Microfacet;
pub use mirror::Mirror;
pub use refraction::Refraction;

/// A scattering model with its parameters at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bsdf {
    /// Lambertian.
    Diffuse(Diffuse),
    /// Perfect mirror.
    Mirror(Mirror),
    /// Smooth dielectric that transmits only.
    Refraction(Refraction),
    /// Smooth dielectric that reflects and transmits.
    Glass(Glass),
    /// Rough conductor.
    Microfacet(Microfacet),
}

/// How wide a lobe is, which decides who may sample it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lobe {
    /// The whole hemisphere.
    Diffuse,
    /// A peak of finite width.
    Glossy,
    /// One direction; light sampling cannot find it.
    Delta,
}

/// A scattered direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// The new direction.
    pub wi: Vec3,
    /// The BSDF without the cosine; for a delta lobe the whole weight f·|cos|/probability.
    pub value: Rgb,
    /// Density per steradian, above 0; for a delta lobe the probability with which it was chosen.
    pub pdf: f32,
    /// The kind of lobe that was sampled.
    pub lobe: Lobe,
}

impl BsdfSample {
    /// What the throughput of the path is multiplied with.
    pub fn weight(&self) -> Rgb {
        match self.lobe {
            Lobe::Delta => self.value,
            Lobe::Diffuse | Lobe::Glossy => self.value * (self.wi.z.abs() / self.pdf),
        }
    }
}

impl Bsdf {
    /// The BSDF without the cosine, per steradian; black for delta lobes.
    ///
    /// Light travels from `wi` to `wo`; dielectrics are not symmetric in the two.
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        match self {
            Self::Diffuse(diffuse) => diffuse.eval(wo, wi),
            Self::Microfacet(microfacet) => microfacet.eval(wo, wi),
            Self::Mirror(_) | Self::Refraction(_) | Self::Glass(_) => Rgb::ZERO,
        }
    }

    /// The density per steradian with which [`Self::sample`] makes `wi`; 0 for delta lobes.
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        match self {
            Self::Diffuse(_) => Diffuse::pdf(wo, wi),
            Self::Microfacet(microfacet) => microfacet.pdf(wo, wi),
            Self::Mirror(_) | Self::Refraction(_) | Self::Glass(_) => 0.0,
        }
    }

    /// A direction distributed like the reflected light, as far as the model knows it.
    ///
    /// `u_lobe` chooses between lobes, `u` the direction, all in [0, 1). `None` when nothing is
    /// scattered there; such a sample counts as black.
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        match self {
            Self::Diffuse(diffuse) => diffuse.sample(wo, u),
            Self::Mirror(mirror) => mirror.sample(wo),
            Self::Refraction(refraction) => refraction.sample(wo),
            Self::Glass(glass) => glass.sample(wo, u_lobe),
            Self::Microfacet(microfacet) => microfacet.sample(wo, u),
        }
    }

    /// True when there are only delta lobes, so that [`Self::eval`] is black everywhere.
    pub fn is_delta(&self) -> bool {
        matches!(self, Self::Mirror(_) | Self::Refraction(_) | Self::Glass(_))
    }

    /// True when nothing is scattered, whatever the directions.
    pub fn is_black(&self) -> bool {
        match self {
            Self::Diffuse(diffuse) => diffuse.reflectance == Rgb::ZERO,
            Self::Mirror(mirror) => mirror.reflectance == Rgb::ZERO,
            // Total reflection remains.
            Self::Refraction(_) => false,
            Self::Glass(glass) => {
                glass.reflectance == Rgb::ZERO && glass.transmittance == Rgb::ZERO
            }
            Self::Microfacet(microfacet) => microfacet.is_black(),
        }
    }

    /// The colour that the albedo view shows: reflectance, or the tint at normal incidence, 0..1.
    pub fn albedo(&self) -> Rgb {
        match self {
            Self::Diffuse(diffuse) => diffuse.reflectance,
            Self::Mirror(mirror) => mirror.reflectance,
            Self::Refraction(refraction) => refraction.transmittance,
            Self::Glass(glass) => glass.albedo(),
            Self::Microfacet(microfacet) => microfacet.albedo(),
        }
    }
}

/// True when both directions lie strictly on one side of the surface.
fn same_side(a: Vec3, b: Vec3) -> bool {
    (a.z > 0.0 && b.z > 0.0) || (a.z < 0.0 && b.z < 0.0)
}
