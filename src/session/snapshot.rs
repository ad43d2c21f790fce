use crate::camera::Camera;
use crate::color::Rgb;
use crate::settings::{RenderSettings, View};

/// Samples taken per pixel of a [`Snapshot`].
#[derive(Clone, Debug, PartialEq)]
pub enum SampleCounts {
    /// The same number everywhere.
    Uniform(u32),
    /// Row by row from the top.
    PerPixel(Vec<u32>),
}

impl SampleCounts {
    /// Samples of pixel number `index`.
    pub fn get(&self, index: usize) -> u32 {
        match self {
            Self::Uniform(n) => *n,
            Self::PerPixel(counts) => counts.get(index).copied().unwrap_or(0),
        }
    }
}

/// The picture so far; immutable, shared by `Arc`, never of an outdated job.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// Grows with every accepted change of the picture.
    pub generation: u64,
    /// Width of `pixels`.
    pub width: usize,
    /// Height of `pixels`.
    pub height: usize,
    /// Size of the whole picture; larger than `pixels` for a preview.
    pub image_size: [u32; 2],
    /// A coarse first look.
    pub is_preview: bool,
    /// What was asked for.
    pub view: View,
    /// Linear radiance, row by row from the top; for views of the first hit, see
    /// [`crate::integrator::first_hit`].
    pub pixels: Vec<Rgb>,
    /// Samples per pixel.
    pub samples: SampleCounts,
    /// Estimated relative error per pixel, pooled over 3×3 pixels, for [`View::Noise`] only.
    pub noise: Option<Vec<f32>>,
    /// Mean samples per pixel.
    pub samples_mean: f64,
    /// Most samples in one pixel.
    pub samples_max: u32,
    /// Seconds spent rendering.
    pub seconds: f64,
    /// Processor time that the workers spent on these samples.
    pub cpu_seconds: f64,
    /// Root of the relative squared error that the samples tell, see [`crate::film::Film::summary`].
    pub relative_error: Option<f64>,
    /// From where.
    pub camera: Camera,
    /// How.
    pub settings: RenderSettings,
}
