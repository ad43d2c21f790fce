use serde::Serialize;
use softbox::geometry::Hit;
use softbox::math::Isa;

use super::Kind;

/// Relative difference of `t` from which on a hit counts as another.
const TOLERANCE: f32 = 1e-4;

/// Everything measured on one scene.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct SceneResult {
    pub(crate) scene: String,
    pub(crate) triangles: usize,
    /// The instruction set of our tracer.
    pub(crate) isa: Isa,
    /// Rays of each kind.
    pub(crate) rays: Vec<(Kind, usize)>,
    pub(crate) builds: Vec<BuildResult>,
    pub(crate) traced: Vec<RaysResult>,
}

/// Building: medians.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct BuildResult {
    pub(crate) system: String,
    pub(crate) threads: usize,
    pub(crate) processor_seconds: f64,
    pub(crate) wall_seconds: f64,
    /// Speed by processor time, times that of the anchor in the same round; `None` without one.
    pub(crate) ratio: Option<f64>,
    pub(crate) bytes: usize,
    pub(crate) sah_cost: Option<f64>,
}

/// Tracing one kind of rays: medians.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct RaysResult {
    pub(crate) system: String,
    pub(crate) kind: Kind,
    pub(crate) threads: usize,
    /// Of processor time, times the threads: what so many free cores would do.
    pub(crate) rays_per_second: f64,
    pub(crate) rays_per_wall_second: f64,
    /// Times the anchor in the same round; `None` without an anchor.
    pub(crate) ratio: Option<f64>,
    pub(crate) mismatches: Mismatches,
}

/// Rays whose hit is not that of double precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(crate) struct Mismatches {
    /// Hits where there is none, or the other way round.
    pub(crate) hit_or_miss: usize,
    /// Hits at another distance.
    pub(crate) distance: usize,
}

impl Mismatches {
    /// Compares closest hits.
    pub(crate) fn of_closest(expected: &[Hit], found: &[Hit]) -> Self {
        let mut mismatches = Self::default();
        for (a, b) in expected.iter().zip(found) {
            if a.is_miss() != b.is_miss() {
                mismatches.hit_or_miss += 1;
            } else if !a.is_miss() && !is_close(a.t, b.t) {
                mismatches.distance += 1;
            }
        }
        mismatches
    }

    /// Compares the answers of shadow rays with closest hits.
    pub(crate) fn of_any(expected: &[Hit], found: &[bool]) -> Self {
        let differs = |(hit, occluded): &(&Hit, &bool)| hit.is_miss() == **occluded;
        Self {
            hit_or_miss: expected.iter().zip(found).filter(differs).count(),
            distance: 0,
        }
    }
}

/// False for NaN too.
fn is_close(expected: f32, found: f32) -> bool {
    (expected - found).abs() <= TOLERANCE * expected.abs()
}
