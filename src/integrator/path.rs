use glam::{Vec2, Vec3};

use super::DirectPlan;
use super::guided::Scattered;
use super::reuse::{self, Stage};
use crate::bsdf::{Bsdf, Lobe};
use crate::camera::RayCamera;
use crate::color::Rgb;
use crate::geometry::Hit;
use crate::guide::Guide;
use crate::light::ParallelogramLight;
use crate::math::{Frame, Ray, offset_origin};
use crate::sampling::{Member, PathSampler, Slot, power_heuristic, uniform_disk};
use crate::scene::{PreparedScene, SurfaceInteraction};
use crate::settings::{MaxDepth, Mode, RenderSettings};

/// Russian roulette lets paths of at least a quarter of the full throughput live: with shorter ones
/// the noise rises by more than the rays fall (measured for 1, 2, 3, 4, 6 and none).
pub(super) const SURVIVAL_OF_THROUGHPUT: f32 = 4.0;
/// Smallest probability with which Russian roulette lets a path live.
pub(super) const MIN_SURVIVAL: f32 = 0.05;
/// From this bounce on no path is sure to live: light trapped between perfect mirrors or by total
/// reflection would go on for ever.
pub(super) const TRAPPED_AFTER: u32 = 32;
/// The largest probability from then on.
pub(super) const TRAPPED_SURVIVAL: f32 = 0.95;

/// The settings that a path depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSettings {
    /// Estimator of direct light.
    pub mode: Mode,
    /// Light samples per light and vertex, at least 1.
    pub light_samples: u32,
    /// Largest number of bounces.
    pub max_depth: MaxDepth,
    /// Keep only the light of bounce `max_depth`.
    pub only_last_bounce: bool,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Independent sequences that the samples of a pixel are dealt out to, at least 1
    /// ([`PathSampler::replicated`]).
    pub replicates: u32,
    /// Paths that share their light, a power of two up to [`super::MAX_CLUSTER`]; 1 for none, 0 for as
    /// many as suit the scene ([`PathTracer::cluster_size`]).
    pub reuse: u32,
}

impl From<&RenderSettings> for PathSettings {
    fn from(settings: &RenderSettings) -> Self {
        Self {
            mode: settings.mode,
            light_samples: settings.light_samples.max(1),
            max_depth: settings.max_depth,
            only_last_bounce: settings.only_last_bounce,
            seed: settings.seed,
            replicates: settings.replicates(),
            reuse: settings.reuse.pixels(),
        }
    }
}

/// One path: pixel (x right, y down, in the whole picture) and sample number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathId {
    /// Pixel.
    pub pixel: [u32; 2],
    /// Sample number, from 0.
    pub sample: u32,
}

/// How emission met by the next ray counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum EmissionWeight {
    /// Nothing else can find it: camera rays and delta lobes.
    Full,
    /// The direct light estimator of the last vertex has counted it.
    None,
    /// Shared with the light samples of the last vertex, from where the ray left with this
    /// solid-angle density, on the side of `normal`.
    Shared {
        from: Vec3,
        normal: Vec3,
        scatter_pdf: f32,
    },
}

/// A path on its way.
#[derive(Clone, Copy, Debug)]
pub struct Path {
    /// Its random numbers.
    pub(super) sampler: PathSampler,
    /// The ray to be traced next.
    pub ray: Ray,
    /// Product of bsdf · cos / pdf so far.
    pub throughput: Rgb,
    /// Radiance gathered so far.
    pub radiance: Rgb,
    /// Surfaces that scattered the path so far.
    pub bounce: u32,
    pub(super) emission_weight: EmissionWeight,
    /// How far it has come in sharing its light.
    pub(super) stage: Stage,
}

/// A surface point of a path, ready to scatter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex<'a> {
    pub(super) surface: SurfaceInteraction,
    pub(super) frame: Frame,
    pub(super) wo: Vec3,
    pub(super) bsdf: &'a Bsdf,
    /// The geometric normal has taken the place of the shading normal, which faces away.
    pub(super) is_mended: bool,
}

impl Vertex<'_> {
    /// The world direction `wi` in the shading frame; `None` where geometric and shading normal
    /// disagree about its side, so that no light leaks through the true surface (Veach 1997, 5.3).
    pub(super) fn local(&self, wi: Vec3) -> Option<Vec3> {
        let local = self.frame.to_local(wi);
        (local.z * wi.dot(self.surface.geometric_normal) > 0.0).then_some(local)
    }

    /// The shading normal on the side of `wo`, from where alone light is scattered.
    pub(super) fn lit_normal(&self) -> Vec3 {
        self.lit_side(self.surface.shading_normal)
    }

    /// A `normal` of the surface on the side of `wo`.
    pub(super) fn lit_side(&self, normal: Vec3) -> Vec3 {
        if self.wo.z < 0.0 { -normal } else { normal }
    }

    /// Where a ray towards `direction` starts.
    pub(super) fn origin(&self, direction: Vec3) -> Vec3 {
        offset_origin(
            self.surface.departure,
            self.surface.error,
            self.surface.geometric_normal,
            direction,
        )
    }
}

/// The steps of a path through one scene, camera and choice of settings.
#[derive(Debug)]
pub struct PathTracer<'a> {
    /// The scene.
    pub scene: &'a PreparedScene,
    /// The camera.
    pub camera: &'a RayCamera,
    /// The settings.
    pub settings: PathSettings,
    /// The direct light samples of each vertex.
    pub(super) plan: DirectPlan,
    /// Diffuse vertices leave direct light to the light samples.
    light_samples_suffice: bool,
    /// Paths in a cluster.
    pub(super) cluster_size: usize,
    /// The sky, if the sums of shared light are corrected by it ([`super::furnace`]). Not with aimed rays,
    /// of which some are lost where material and true surface disagree.
    pub(super) furnace: Option<Rgb>,
    /// Where diffuse vertices aim some of their rays.
    pub(super) guide: Option<&'a Guide>,
    /// The light that all light samples go to, if that is a parallelogram, and their weight.
    pub(super) only_parallelogram: Option<(ParallelogramLight<'a>, f32)>,
}

impl<'a> PathTracer<'a> {
    /// The path tracer of `scene` seen by `camera`.
    pub fn new(scene: &'a PreparedScene, camera: &'a RayCamera, settings: PathSettings) -> Self {
        let plan = DirectPlan::new(scene, &settings);
        let only_parallelogram = plan
            .only_light(scene)
            .and_then(|(light, weight)| Some((scene.light(light).as_parallelogram()?, weight)));
        let tracer = Self {
            scene,
            camera,
            settings,
            plan,
            only_parallelogram,
            guide: scene.guide().filter(|_| settings.mode == Mode::Best),
            light_samples_suffice: scene.light_samples_suffice(),
            cluster_size: reuse::cluster_size(scene, &settings),
            furnace: None,
        };
        Self {
            furnace: tracer.find_furnace(),
            ..tracer
        }
    }

    /// The random numbers of path number `number` of the cluster that begins with pixel `first`.
    pub(super) fn sampler(&self, id: PathId, (first, number): ([u32; 2], u32)) -> PathSampler {
        let PathSettings {
            seed, replicates, ..
        } = self.settings;
        let member = Member {
            first,
            number,
            size: self.cluster_size as u32,
        };
        PathSampler::in_cluster(seed, (id.pixel, id.sample), replicates, member)
    }

    /// The start of a path with the numbers of `sampler`: its camera ray through a uniform point of the
    /// pixel (box filter).
    pub(super) fn start(&self, id: PathId, sampler: PathSampler) -> Path {
        let pixel = Vec2::new(id.pixel[0] as f32, id.pixel[1] as f32);
        let position = pixel + sampler.get_2d(0, Slot::Pixel);
        let ray = self
            .camera
            .generate_ray(position, || uniform_disk(sampler.get_2d(0, Slot::Lens)));
        Path {
            sampler,
            ray,
            throughput: Rgb::ONE,
            radiance: Rgb::ZERO,
            bounce: 0,
            emission_weight: EmissionWeight::Full,
            stage: if self.cluster_size > 1 {
                Stage::Waiting
            } else {
                Stage::Alone
            },
        }
    }

    /// Takes what `path` met: adds emission; `None` when the path ends there.
    pub(super) fn arrive(&self, path: &mut Path, hit: &Hit) -> Option<Vertex<'a>> {
        let direction = path.ray.direction;
        if hit.is_miss() {
            let radiance = self.scene.environment_radiance(direction, path.bounce == 0);
            self.add_emission(path, radiance, |(from, _)| {
                self.scene.environment_pdf(from, direction)
            });
            return None;
        }
        let surface = self.scene.interaction(&path.ray, hit);
        let emitted = self.scene.emitted(&surface, -direction);
        self.add_emission(path, emitted, |place| {
            self.scene.light_pdf(place, direction, &surface, hit.t)
        });
        let bsdf = self.scene.bsdf(hit.primitive);
        if path.bounce >= self.settings.max_depth.0 || bsdf.is_black() {
            return None;
        }
        Some(vertex(surface, -direction, bsdf))
    }

    /// `light_pdf` takes the point that the ray left, and the normal on that side.
    fn add_emission(
        &self,
        path: &mut Path,
        emitted: Rgb,
        light_pdf: impl FnOnce((Vec3, Vec3)) -> f32,
    ) {
        if emitted == Rgb::ZERO || !self.counts_depth(path.bounce) {
            return;
        }
        let weight = match path.emission_weight {
            EmissionWeight::None => return,
            EmissionWeight::Full => 1.0,
            EmissionWeight::Shared {
                from,
                normal,
                scatter_pdf,
            } => power_heuristic(
                scatter_pdf,
                self.settings.light_samples as f32 * light_pdf((from, normal)),
            ),
        };
        path.radiance += path.throughput * emitted * weight;
    }

    /// True when light after `depth` bounces is part of the picture.
    pub(super) fn counts_depth(&self, depth: u32) -> bool {
        !self.settings.only_last_bounce || depth == self.settings.max_depth.0
    }

    /// True when light samples and scattered rays of a vertex of material `bsdf` share emission by
    /// multiple importance. Otherwise light samples count it all.
    pub(super) fn shares_emission(&self, bsdf: &Bsdf) -> bool {
        match bsdf {
            Bsdf::Diffuse(_) => self.shares_diffuse_emission(),
            _ => self.settings.mode == Mode::Best && !self.scene.is_course_compatible(),
        }
    }

    /// [`Self::shares_emission`] of diffuse surfaces.
    pub(super) fn shares_diffuse_emission(&self) -> bool {
        let is_best = self.settings.mode == Mode::Best && !self.scene.is_course_compatible();
        is_best && !self.light_samples_suffice
    }

    /// Sends `path` on from `vertex`; false when it ends there.
    pub(super) fn scatter(&self, path: &mut Path, vertex: &Vertex<'_>) -> bool {
        let (bounce, sampler) = (path.bounce, path.sampler);
        let is_last = bounce + 1 >= self.settings.max_depth.0;
        // After the last bounce only emission that no light sample finds is still of use.
        if is_last && !vertex.bsdf.is_delta() && !self.shares_emission(vertex.bsdf) {
            return false;
        }
        let Some(scattered) = self.scattered((sampler, bounce), vertex) else {
            return false;
        };
        let Scattered {
            sample, direction, ..
        } = scattered;
        if direction.dot(vertex.surface.geometric_normal) * sample.wi.z <= 0.0 {
            return false;
        }
        let kept = self.kept(path.throughput, &scattered);
        path.throughput *= sample.weight();
        path.emission_weight = match sample.lobe {
            Lobe::Delta => EmissionWeight::Full,
            _ if self.shares_emission(vertex.bsdf) => EmissionWeight::Shared {
                from: vertex.surface.point,
                normal: vertex.lit_normal(),
                scatter_pdf: sample.pdf,
            },
            _ => EmissionWeight::None,
        };
        path.ray = Ray::new(vertex.origin(direction), direction);
        path.bounce += 1;
        let is_arriving = path.is_arriving();
        if let Stage::Arriving { scale, .. } = &mut path.stage
            && is_arriving
        {
            *scale = scattered.material_pdf / sample.pdf;
        }
        // The first continuation is always taken, as in the course, and that from a receiver.
        let is_sure = path.bounce < 2 || is_arriving;
        path.throughput.max_element() > 0.0
            && (is_sure || survives(path, kept, sampler.get_1d(bounce, Slot::Roulette)))
    }
}

fn vertex(mut surface: SurfaceInteraction, wo: Vec3, bsdf: &Bsdf) -> Vertex<'_> {
    // Seen from the front of the true surface but the back of the interpolated one (or the
    // reverse), near silhouettes of coarse meshes: shade the true surface.
    let is_mended = wo.dot(surface.geometric_normal) * wo.dot(surface.shading_normal) <= 0.0;
    if is_mended {
        surface.shading_normal = surface.geometric_normal;
    }
    let frame = Frame::from_normal(surface.shading_normal);
    Vertex {
        surface,
        frame,
        wo: frame.to_local(wo),
        bsdf,
        is_mended,
    }
}

/// Russian roulette by `kept`, the throughput but for the aim of guided rays; survivors are divided by
/// their probability, so the mean stays.
fn survives(path: &mut Path, kept: f32, u: f32) -> bool {
    let most = if path.bounce < TRAPPED_AFTER {
        1.0
    } else {
        TRAPPED_SURVIVAL
    };
    let wanted = SURVIVAL_OF_THROUGHPUT * kept;
    let survival = wanted.clamp(MIN_SURVIVAL, most);
    if u >= survival {
        return false;
    }
    path.throughput /= survival;
    true
}
