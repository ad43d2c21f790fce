use glam::Vec3;

use super::super::path::{EmissionWeight, Path};
use super::super::reuse::Stage;
use crate::color::Rgb;
use crate::math::Ray;
use crate::sampling::PathSampler;

/// Paths on their way, all after the same number of bounces: the ray that each is to take next, and
/// what it carries.
#[derive(Debug, Default)]
pub(super) struct Paths {
    pub(super) rays: Vec<Ray>,
    pub(super) states: Vec<PathState>,
}

/// What a path carries.
#[derive(Clone, Copy, Debug)]
pub(super) struct PathState {
    pub(super) throughput: Rgb,
    /// Number of the path in its batch.
    pub(super) id: u32,
    /// Where its light is added up: at `id`, or, once it leaves a shared vertex, behind all paths.
    pub(super) tally: u32,
    /// Where the ray left, for [`EmissionWeight::Shared`].
    pub(super) from: Vec3,
    /// The side on which it did, likewise.
    pub(super) normal: Vec3,
    /// The density that [`EmissionWeight::Shared`] has, or [`FULL`] or [`NONE`].
    pub(super) scatter_pdf: f32,
}

/// [`EmissionWeight::Full`] in place of a density.
pub(super) const FULL: f32 = f32::INFINITY;
/// [`EmissionWeight::None`] in place of a density.
pub(super) const NONE: f32 = -1.0;

impl Paths {
    pub(super) fn clear(&mut self) {
        self.rays.clear();
        self.states.clear();
    }

    pub(super) fn len(&self) -> usize {
        self.rays.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.rays.is_empty()
    }

    /// Adds `path`, number `id` of the batch, whose light is added up at `tally`.
    pub(super) fn push(&mut self, (id, tally): (u32, u32), path: &Path) {
        let (from, normal, scatter_pdf) = match path.emission_weight {
            EmissionWeight::Full => (Vec3::ZERO, Vec3::ZERO, FULL),
            EmissionWeight::None => (Vec3::ZERO, Vec3::ZERO, NONE),
            EmissionWeight::Shared {
                from,
                normal,
                scatter_pdf,
            } => (from, normal, scatter_pdf),
        };
        self.rays.push(path.ray);
        self.states.push(PathState {
            throughput: path.throughput,
            id,
            tally,
            from,
            normal,
            scatter_pdf,
        });
    }

    /// Path `index` after `bounce` bounces in `stage`, with `radiance` gathered so far.
    pub(super) fn path(
        &self,
        index: usize,
        (bounce, stage): (u32, Stage),
        sampler: PathSampler,
        radiance: Rgb,
    ) -> Path {
        let state = &self.states[index];
        let emission_weight = if state.scatter_pdf == FULL {
            EmissionWeight::Full
        } else if state.scatter_pdf == NONE {
            EmissionWeight::None
        } else {
            EmissionWeight::Shared {
                from: state.from,
                normal: state.normal,
                scatter_pdf: state.scatter_pdf,
            }
        };
        Path {
            sampler,
            ray: self.rays[index],
            throughput: state.throughput,
            radiance,
            bounce,
            emission_weight,
            stage,
        }
    }
}
