//! One path from the camera on, in double precision.

use glam::DVec3;

use super::bsdf::{self, Scattered};
use super::direct::direct_light;
use super::frame::Frame;
use super::guided;
use super::surface::Surface;
use super::trace::{Ray, closest};
use super::{environment, light, light_choice, warp};
use crate::bsdf::Bsdf;
use crate::integrator::path::{
    MIN_SURVIVAL, SURVIVAL_OF_THROUGHPUT, TRAPPED_AFTER, TRAPPED_SURVIVAL,
};
use crate::integrator::{PathId, PathTracer};
use crate::light::Light;
use crate::sampling::{PathSampler, Slot};

/// How emission met by the next ray counts.
#[derive(Clone, Copy, Debug)]
enum Previous {
    /// In full: after the camera and after delta lobes.
    Blind,
    /// Not at all: the last vertex has sampled the lights.
    Counted,
    /// By multiple importance: the last vertex lies at `from`, is lit on the side of `normal`, and
    /// sent the ray with density `pdf`.
    Shared {
        from: DVec3,
        normal: DVec3,
        pdf: f64,
    },
}

/// A path on its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Path {
    pub(super) sampler: PathSampler,
    ray: Ray,
    pub(super) throughput: DVec3,
    radiance: DVec3,
    /// Surfaces that scattered the path so far.
    pub(super) bounce: u32,
    previous: Previous,
}

/// A surface point that scatters the path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex<'a> {
    pub(super) surface: Surface,
    pub(super) frame: Frame,
    /// Towards where the path came from, in `frame`.
    pub(super) wo: DVec3,
    pub(super) bsdf: &'a Bsdf,
}

impl<'a> Vertex<'a> {
    fn new(surface: Surface, wo: DVec3, bsdf: &'a Bsdf) -> Self {
        // Where interpolated and true normal disagree on the side, the true one is shaded.
        let agree = wo.dot(surface.geometric_normal) * wo.dot(surface.shading_normal) > 0.0;
        let frame = Frame::from_normal(if agree {
            surface.shading_normal
        } else {
            surface.geometric_normal
        });
        Self {
            surface,
            frame,
            wo: frame.to_local(wo),
            bsdf,
        }
    }

    /// The shading normal on the side from which light is reflected.
    pub(super) fn lit_normal(&self) -> DVec3 {
        self.frame.to_world(DVec3::Z) * 1.0_f64.copysign(self.wo.z)
    }

    /// `wi` in the frame; `None` where the normals disagree on its side (Veach 1997, section 5.3).
    pub(super) fn local(&self, wi: DVec3) -> Option<DVec3> {
        let local = self.frame.to_local(wi);
        (local.z * wi.dot(self.surface.geometric_normal) > 0.0).then_some(local)
    }
}

/// The radiance of path `id` of `tracer` in double precision, from the same random numbers as
/// [`super::super::reference()`].
///
/// Kajiya 1986, "The Rendering Equation"; Veach 1997, "Robust Monte Carlo Methods for Light
/// Transport Simulation", chapter 9. Values that are not finite are returned as they are.
pub fn reference_f64(tracer: &PathTracer<'_>, id: PathId) -> DVec3 {
    let scene = tracer.scene;
    let mut path = start(tracer, id);
    loop {
        let Some(hit) = closest(scene, &path.ray) else {
            meet_environment(tracer, &mut path);
            break;
        };
        let surface = Surface::new(scene, &path.ray, &hit);
        meet_light(tracer, &mut path, &surface);
        if path.bounce >= tracer.settings.max_depth.0 {
            break;
        }
        let vertex = Vertex::new(surface, -path.ray.direction, scene.bsdf(hit.primitive));
        if tracer.counts_depth(path.bounce + 1) {
            path.radiance += direct_light(tracer, &path, &vertex);
        }
        if !scatter(tracer, &mut path, &vertex) {
            break;
        }
    }
    path.radiance
}

fn start(tracer: &PathTracer<'_>, id: PathId) -> Path {
    let sampler = tracer.sampler(id, (id.pixel, 0));
    let pixel = glam::UVec2::from_array(id.pixel).as_dvec2();
    let position = pixel + sampler.get_2d(0, Slot::Pixel).as_dvec2();
    let lens = || warp::disk(sampler.get_2d(0, Slot::Lens).as_dvec2());
    let (origin, direction) = tracer.camera.generate_ray_f64(position, lens);
    Path {
        sampler,
        ray: Ray {
            origin,
            direction,
            t_max: f64::INFINITY,
        },
        throughput: DVec3::ONE,
        radiance: DVec3::ZERO,
        bounce: 0,
        previous: Previous::Blind,
    }
}

fn meet_environment(tracer: &PathTracer<'_>, path: &mut Path) {
    let scene = tracer.scene;
    let Some(index) = scene.environment_light() else {
        return;
    };
    if let Light::Environment(sky) = scene.light(index) {
        let direction = path.ray.direction;
        let emitted = environment::radiance(sky, direction, path.bounce == 0);
        add_emission(tracer, path, emitted, |_| {
            f64::from(scene.light_sampler().group_pmf(index)) * environment::pdf(sky, direction)
        });
    }
}

fn meet_light(tracer: &PathTracer<'_>, path: &mut Path, surface: &Surface) {
    let scene = tracer.scene;
    let Some(index) = scene.light_of(surface.primitive) else {
        return;
    };
    let met = scene.light(index);
    let emitted = light::emitted(met, surface.geometric_normal, path.ray.direction);
    let part = met.part_of(surface.primitive);
    add_emission(tracer, path, emitted, |from| {
        part.map_or(0.0, |part| {
            light_choice::pmf(scene.light_sampler(), from, index, part)
                * light::pdf_part(met, scene.shapes(), part, from, surface)
        })
    });
}

fn add_emission(
    tracer: &PathTracer<'_>,
    path: &mut Path,
    emitted: DVec3,
    pdf_from: impl FnOnce((DVec3, DVec3)) -> f64,
) {
    if !tracer.counts_depth(path.bounce) {
        return;
    }
    let weight = match path.previous {
        Previous::Blind => 1.0,
        Previous::Counted => 0.0,
        Previous::Shared { from, normal, pdf } => {
            let n = f64::from(tracer.settings.light_samples);
            warp::power_heuristic(pdf, n * pdf_from((from, normal)))
        }
    };
    path.radiance += path.throughput * emitted * weight;
}

/// Sends `path` on from `vertex`; false when it ends there.
fn scatter(tracer: &PathTracer<'_>, path: &mut Path, vertex: &Vertex<'_>) -> bool {
    let (sampler, bounce) = (path.sampler, path.bounce);
    let u_lobe = f64::from(sampler.get_1d(bounce, Slot::Lobe));
    let u = sampler.get_2d(bounce, Slot::Scatter).as_dvec2();
    let lobes = guided::lobes_at(tracer, bounce, vertex);
    let sample = match lobes {
        Some(lobes) => guided::sample(lobes, vertex, u_lobe, u),
        None => bsdf::sample(vertex.bsdf, vertex.wo, u_lobe, u),
    };
    let Some(sample) = sample else {
        return false;
    };
    let (wi, weight) = match sample {
        Scattered::Delta { wi, weight } => {
            path.previous = Previous::Blind;
            (wi, weight)
        }
        Scattered::Smooth { wi, value, pdf } => {
            path.previous = if tracer.shares_emission(vertex.bsdf) {
                Previous::Shared {
                    from: vertex.surface.point,
                    normal: vertex.lit_normal(),
                    pdf,
                }
            } else {
                Previous::Counted
            };
            (wi, value * wi.z.abs() / pdf)
        }
    };
    let direction = vertex.frame.to_world(wi).normalize();
    if vertex.local(direction).is_none() {
        return false;
    }
    path.ray = Ray {
        origin: vertex.surface.leave(direction),
        direction,
        t_max: f64::INFINITY,
    };
    let kept = match lobes {
        _ if tracer.guide.is_some() && vertex.bsdf.is_delta() => f64::INFINITY,
        // Without the aim: value · cos / pdf is the reflectance.
        Some(_) => (path.throughput * vertex.bsdf.albedo().as_dvec3()).max_element(),
        None => (path.throughput * weight).max_element(),
    };
    path.throughput *= weight;
    path.bounce += 1;
    // The first continuation is always taken.
    path.bounce < 2
        || survives(
            path,
            kept,
            f64::from(sampler.get_1d(bounce, Slot::Roulette)),
        )
}

/// Russian roulette by `kept`, the throughput but for the aim of guided rays (Arvo and Kirk 1990, "Particle Transport and Image Synthesis").
fn survives(path: &mut Path, kept: f64, u: f64) -> bool {
    let most = if path.bounce < TRAPPED_AFTER {
        1.0
    } else {
        f64::from(TRAPPED_SURVIVAL)
    };
    let wanted = f64::from(SURVIVAL_OF_THROUGHPUT) * kept;
    let survival = wanted.clamp(f64::from(MIN_SURVIVAL), most);
    path.throughput /= survival;
    u < survival && path.throughput != DVec3::ZERO
}
