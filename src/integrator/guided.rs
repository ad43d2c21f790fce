//! Scattering at diffuse vertices, part of which is aimed at mirrors and glass through which lights are
//! seen. Everything else scatters as its material says.

use glam::Vec3;

use super::PathTracer;
use super::path::Vertex;
use crate::bsdf::{Bsdf, BsdfSample, Lobe};
use crate::color::Rgb;
use crate::guide::{Guide, Lobes};
use crate::sampling::{PathSampler, Slot};

/// A scattered direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scattered {
    /// In the frame of the vertex; its density counts the aim.
    pub(super) sample: BsdfSample,
    /// In the world, unit or zero.
    pub(super) direction: Vec3,
    /// The density that the material alone has.
    pub(super) material_pdf: f32,
}

impl<'a> PathTracer<'a> {
    /// The guide for vertices after `bounce` bounces; a light seen in a mirror is two bounces away.
    pub(super) fn guide_after(&self, bounce: u32) -> Option<&'a Guide> {
        (self.guide).filter(|_| bounce + 2 <= self.settings.max_depth.0)
    }

    /// Where a vertex after `bounce` bounces, of material `bsdf` and lit on the side of `normal`, aims
    /// some of its rays.
    pub(super) fn lobes_at(
        &self,
        bounce: u32,
        bsdf: &Bsdf,
        (point, normal): (Vec3, Vec3),
    ) -> Option<&'a Lobes> {
        match bsdf {
            Bsdf::Diffuse(_) => self.guide_after(bounce)?.at(point, normal),
            _ => None,
        }
    }

    fn lobes_of(&self, bounce: u32, vertex: &Vertex<'_>) -> Option<&'a Lobes> {
        let place = (vertex.surface.point, vertex.lit_normal());
        self.lobes_at(bounce, vertex.bsdf, place)
    }

    /// The direction in which a path with these numbers, after so many bounces, leaves `vertex`; `None`
    /// where nothing is scattered.
    pub(super) fn scattered(
        &self,
        (sampler, bounce): (PathSampler, u32),
        vertex: &Vertex<'_>,
    ) -> Option<Scattered> {
        let u_lobe = sampler.get_1d(bounce, Slot::Lobe);
        let u = sampler.get_2d(bounce, Slot::Scatter);
        let Some(lobes) = self.lobes_of(bounce, vertex) else {
            let sample = vertex.bsdf.sample(vertex.wo, u_lobe, u)?;
            return Some(Scattered {
                direction: vertex.frame.to_world(sample.wi).normalize_or_zero(),
                material_pdf: sample.pdf,
                sample,
            });
        };
        let from = vertex.surface.point;
        let (wi, towards) = if u_lobe < lobes.share() {
            let towards = lobes.sample(from, u_lobe / lobes.share(), u);
            (vertex.frame.to_local(towards), towards)
        } else {
            let wi = vertex.bsdf.sample(vertex.wo, u_lobe, u)?.wi;
            (wi, vertex.frame.to_world(wi))
        };
        let direction = towards.normalize_or_zero();
        let material_pdf = vertex.bsdf.pdf(vertex.wo, wi);
        (material_pdf > 0.0).then(|| Scattered {
            sample: BsdfSample {
                wi,
                value: vertex.bsdf.eval(vertex.wo, wi),
                pdf: mixture(lobes, material_pdf, (from, direction)),
                lobe: Lobe::Diffuse,
            },
            direction,
            material_pdf,
        })
    }

    /// The density per steradian with which `vertex`, not of delta lobes, scatters after `bounce` bounces
    /// into the unit direction `wi`, given in the world and in the frame.
    pub(super) fn scatter_pdf(
        &self,
        bounce: u32,
        vertex: &Vertex<'_>,
        (wi, local): (Vec3, Vec3),
    ) -> f32 {
        let material_pdf = vertex.bsdf.pdf(vertex.wo, local);
        match self.lobes_of(bounce, vertex) {
            Some(lobes) => mixture(lobes, material_pdf, (vertex.surface.point, wi)),
            None => material_pdf,
        }
    }

    /// What Russian roulette goes by for a path of `throughput` that is `scattered`: its throughput if
    /// rays were not aimed. Those that are carry little because they are many, not because they bring
    /// little; and on mirrors and glass nobody knows which is which.
    pub(super) fn kept(&self, throughput: Rgb, scattered: &Scattered) -> f32 {
        let sample = BsdfSample {
            pdf: scattered.material_pdf,
            ..scattered.sample
        };
        match sample.lobe {
            Lobe::Delta if self.guide.is_some() => f32::INFINITY,
            _ => (throughput * sample.weight()).max_element(),
        }
    }
}

/// The density of rays of which a share is aimed and the others go as the material, with density
/// `material_pdf`, has them.
fn mixture(lobes: &Lobes, material_pdf: f32, (from, direction): (Vec3, Vec3)) -> f32 {
    (1.0 - lobes.share()) * material_pdf + lobes.share() * lobes.pdf(from, direction)
}
