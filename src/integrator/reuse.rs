//! Path reuse: the paths of a cluster of pixels lend each other the light that they have found.
//!
//! The first diffuse surface that a path meets is its receiver. If the ray scattered there meets a
//! diffuse surface, that point is shared: it sends the same light to the receivers of all paths of
//! the cluster. Receiver j takes in
//!
//! βⱼ Σₖ Lₖ Vⱼₖ qⱼₖ / Σₘ Vₘₖ qₘₖ,
//!
//! with βⱼ its throughput times its reflectance, Lₖ the radiance that path k has found to leave its
//! shared vertex, Vⱼₖ visibility and qⱼₖ the density per area, times π, with which receiver j scatters
//! rays to the shared vertex of path k. This is multiple importance sampling by the balance heuristic:
//! every path of the cluster could have made every shared vertex that it sees, so the mean is that of
//! paths alone. Where part of the rays is aimed, q stays that of the material, and Lₖ is scaled by it
//! over the density of the ray that made the vertex. A point of an even sky is shared likewise, with
//! densities per solid angle.
//!
//! Bekaert, Sbert, Halton 2002, "Accelerating Path Tracing by Re-Using Paths"; Veach 1997, section
//! 9.2.2. Paths that have come to their receivers over mirrors share among those of as many bounces.

use glam::Vec3;

use super::furnace::PATHS_PER_PROBE;
use super::path::{Path, Vertex};
use super::{PathCounts, PathSettings, PathTracer};
use crate::bsdf::Bsdf;
use crate::color::Rgb;
use crate::math::{Ray, SHADOW_T_MAX, offset_origin};
use crate::sampling::PathSampler;
use crate::scene::PreparedScene;
use crate::settings::Mode;

/// Most paths of a cluster.
pub const MAX_CLUSTER: usize = 16;

/// With more parts of lights to choose from, much of the noise is that of the choice at the first
/// surface, which is not shared.
const FEW_LIGHTS: usize = 8;

/// Paths of a cluster then: with 256 lights 4 are 5 % more efficient than 1, and 16 20 % less.
const FOR_MANY_LIGHTS: usize = 4;

/// How far a path has come in sharing its light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Stage {
    /// It takes no part.
    Alone,
    /// It has met no receiver yet.
    Waiting,
    /// It has left its receiver; what it meets after so many bounces may be shared. `scale` is the
    /// density that the receiver's material has for the ray over that of the ray, part of which is aimed.
    Arriving { bounce: u32, scale: f32 },
    /// It carries the light that its shared vertex will send.
    Shared,
}

/// The first diffuse vertex of a path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Receiver {
    pub(super) point: Vec3,
    /// As of [`crate::scene::SurfaceInteraction`].
    pub(super) departure: Vec3,
    pub(super) error: Vec3,
    /// Both normals are on the lit side.
    pub(super) geometric_normal: Vec3,
    pub(super) shading_normal: Vec3,
    /// What light that is taken in is multiplied by: throughput times reflectance.
    pub(super) factor: Rgb,
    /// Bounces before it.
    pub(super) bounce: u32,
}

/// The vertex after a receiver, or the sky there.
#[derive(Clone, Copy, Debug)]
pub(super) struct SharedVertex {
    /// The point, or the direction of the sky.
    pub(super) place: Vec3,
    pub(super) error: Vec3,
    /// Both normals are on the side of the receiver.
    pub(super) geometric_normal: Vec3,
    pub(super) shading_normal: Vec3,
    pub(super) is_infinite: bool,
}

impl SharedVertex {
    pub(super) fn sky(direction: Vec3) -> Self {
        Self {
            place: direction,
            error: Vec3::ZERO,
            geometric_normal: Vec3::ZERO,
            shading_normal: Vec3::ZERO,
            is_infinite: true,
        }
    }

    pub(super) fn surface(vertex: &Vertex<'_>) -> Self {
        let surface = &vertex.surface;
        Self {
            place: surface.point,
            error: surface.error,
            geometric_normal: vertex.lit_side(surface.geometric_normal),
            shading_normal: vertex.lit_normal(),
            is_infinite: false,
        }
    }
}

impl Receiver {
    fn new(path: &Path, vertex: &Vertex<'_>, reflectance: Rgb) -> Self {
        let surface = &vertex.surface;
        Self {
            point: surface.point,
            departure: surface.departure,
            error: surface.error,
            geometric_normal: vertex.lit_side(surface.geometric_normal),
            shading_normal: vertex.lit_normal(),
            factor: path.throughput * reflectance,
            bounce: path.bounce,
        }
    }

    /// π times the density with which this receiver scatters rays to `shared`, visibility apart: per
    /// area, or per solid angle of the sky. 0 where it never does.
    fn reach(&self, shared: &SharedVertex) -> f32 {
        let way = if shared.is_infinite {
            shared.place
        } else {
            shared.place - self.point
        };
        let cosine = self.shading_normal.dot(way);
        if !(cosine > 0.0 && self.geometric_normal.dot(way) > 0.0) {
            return 0.0;
        }
        if shared.is_infinite {
            return cosine;
        }
        let there = -shared.shading_normal.dot(way);
        if !(there > 0.0 && -shared.geometric_normal.dot(way) > 0.0) {
            return 0.0;
        }
        let squared = way.length_squared();
        let reach = cosine * there / (squared * squared);
        if reach < f32::INFINITY { reach } else { 0.0 }
    }

    /// The ray that is free where this receiver sees `shared`.
    fn ray_to(&self, shared: &SharedVertex) -> Ray {
        let (normal, error) = (self.geometric_normal, self.error);
        if shared.is_infinite {
            let origin = offset_origin(self.departure, error, normal, shared.place);
            return Ray::new(origin, shared.place);
        }
        let way = shared.place - self.point;
        let origin = offset_origin(self.departure, error, normal, way);
        let target = offset_origin(shared.place, shared.error, shared.geometric_normal, -way);
        Ray::segment(origin, target - origin, SHADOW_T_MAX)
    }
}

/// A path that has been followed to its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Followed {
    pub(super) sampler: PathSampler,
    /// Radiance that came to the camera without the shared vertex.
    pub(super) radiance: Rgb,
    pub(super) receiver: Option<Receiver>,
    /// With the radiance that leaves it.
    pub(super) shared: Option<(SharedVertex, Rgb)>,
}

/// Paths in a cluster: 1 where none could share anything.
pub(super) fn cluster_size(scene: &PreparedScene, settings: &PathSettings) -> usize {
    let fewest_bounces = if shares_sky(scene) { 1 } else { 2 };
    if settings.mode != Mode::Best
        || scene.is_course_compatible()
        || settings.max_depth.0 < fewest_bounces
    {
        return 1;
    }
    match settings.reuse as usize {
        // Where the sky is free there is no noise to share away, and where it is blocked by what does not
        // share its light there is little to gain.
        0 if shares_sky(scene) && !scene.is_diffuse() => 1,
        0 if scene.light_sampler().choices() > FEW_LIGHTS => FOR_MANY_LIGHTS,
        0 => MAX_CLUSTER,
        reuse => reuse.min(MAX_CLUSTER),
    }
}

/// True when what scattered rays bring from the sky counts in full, whatever surface they left.
pub(super) fn shares_sky(scene: &PreparedScene) -> bool {
    scene.environment_light().is_some_and(|light| {
        scene.light(light).is_constant_sky() && scene.light_sampler().group_pmf(light) == 0.0
    })
}

impl PathTracer<'_> {
    /// Paths in a cluster, a power of two; 1 where paths do not share their light.
    pub fn cluster_size(&self) -> usize {
        self.cluster_size
    }

    /// True when the sky is shared by `path`, which has met nothing.
    pub(super) fn shares_sky(&self, path: &Path) -> bool {
        path.is_arriving() && self.counts_depth(path.bounce) && shares_sky(self.scene)
    }

    /// True when `vertex` is shared by `path`, which has just met it.
    pub(super) fn shares(&self, path: &Path, vertex: &Vertex<'_>) -> bool {
        path.is_arriving() && !vertex.is_mended && matches!(vertex.bsdf, Bsdf::Diffuse(_))
    }

    /// The receiver at `vertex`, if this is where `path` takes in shared light.
    pub(super) fn receive(&self, path: &mut Path, vertex: &Vertex<'_>) -> Option<Receiver> {
        let Bsdf::Diffuse(diffuse) = vertex.bsdf else {
            return None;
        };
        if path.stage != Stage::Waiting {
            return None;
        }
        path.stage = Stage::Arriving {
            bounce: path.bounce + 1,
            scale: 1.0,
        };
        Some(Receiver::new(path, vertex, diffuse.reflectance))
    }
}

impl Path {
    /// True when the path comes straight from its receiver.
    pub(super) fn is_arriving(&self) -> bool {
        matches!(self.stage, Stage::Arriving { bounce, .. } if bounce == self.bounce)
    }

    /// From here on the path gathers what leaves its shared vertex; returns what it has so far.
    pub(super) fn share(&mut self) -> Rgb {
        if let Stage::Arriving { scale, .. } = self.stage {
            self.throughput = Rgb::splat(scale);
        }
        self.stage = Stage::Shared;
        std::mem::take(&mut self.radiance)
    }
}

/// Adds what the receivers of a cluster take in to `radiance`, path by path, with the correction by
/// the sky of [`PathTracer::furnace`] if there is one. `occluded` traces.
pub(super) fn exchange(
    (paths, furnace): (&[Followed], Option<Rgb>),
    radiance: &mut [Rgb],
    counts: &mut PathCounts,
    mut occluded: impl FnMut(&Ray, &mut PathCounts) -> bool,
) {
    let mut weights = [0.0; MAX_CLUSTER];
    let mut reach = [0.0; MAX_CLUSTER];
    for path in paths {
        let (Some((shared, lent)), Some(own)) = (&path.shared, &path.receiver) else {
            continue;
        };
        if *lent == Rgb::ZERO && furnace.is_none() {
            continue;
        }
        reach.fill(0.0);
        let own_reach = own.reach(shared);
        let is_for_all = own_reach > 0.0;
        for (other, reach) in paths.iter().zip(&mut reach) {
            let Some(receiver) = &other.receiver else {
                continue;
            };
            if std::ptr::eq(other, path) {
                // What is not for all is for the lender alone.
                *reach = if is_for_all { own_reach } else { 1.0 };
            } else if is_for_all && receiver.bounce == own.bounce {
                *reach = receiver.reach(shared);
                if *reach > 0.0 && occluded(&receiver.ray_to(shared), counts) {
                    *reach = 0.0;
                }
            }
        }
        let share = 1.0 / reach.iter().sum::<f32>();
        for (i, other) in paths.iter().enumerate() {
            if let Some(receiver) = &other.receiver
                && reach[i] > 0.0
            {
                radiance[i] += receiver.factor * *lent * (reach[i] * share);
                weights[i] += reach[i] * share;
            }
        }
    }
    let Some(sky) = furnace else {
        return;
    };
    let openness = openness(paths, |ray| !occluded(ray, counts));
    for (path, (radiance, weights)) in paths.iter().zip(radiance.iter_mut().zip(weights)) {
        if let Some(receiver) = &path.receiver {
            let own = if path.shared.is_none() { 1.0 } else { 0.0 };
            *radiance += receiver.factor * sky * (openness * (1.0 - (weights + own)));
        }
    }
}

/// The part of the rays of a cluster that find the sky free; 0 without rays.
fn openness(paths: &[Followed], mut is_free: impl FnMut(&Ray) -> bool) -> f32 {
    let (mut free, mut probes) = (0.0, 0.0);
    for path in paths.iter().step_by(PATHS_PER_PROBE) {
        if let Some(receiver) = &path.receiver {
            probes += 1.0;
            if receiver
                .probe(&path.sampler)
                .is_some_and(|ray| is_free(&ray))
            {
                free += 1.0;
            }
        }
    }
    if probes > 0.0 { free / probes } else { 0.0 }
}
