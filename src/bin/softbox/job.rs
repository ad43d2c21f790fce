use std::path::PathBuf;

use glam::DVec3;
use softbox::display::DisplaySettings;
use softbox::settings::{CameraRule, RenderSettings};

/// Everything that one picture needs, however it was asked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Job {
    /// The file; the built-in scene when `None`.
    pub(crate) scene: Option<PathBuf>,
    /// Files to write; none in the viewer.
    pub(crate) outputs: Vec<PathBuf>,
    /// Also write the picture of the sampling rate here.
    pub(crate) rate_picture: Option<PathBuf>,
    /// What is rendered.
    pub(crate) settings: RenderSettings,
    /// From where.
    pub(crate) camera: CameraChoice,
    /// How it is displayed.
    pub(crate) display: DisplaySettings,
    /// A picture of the surroundings in place of the scene's own.
    pub(crate) environment: Option<PathBuf>,
}

/// What was said about the camera; the scene answers the rest. Later fields win over earlier ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct CameraChoice {
    /// Where the camera comes from when nothing else is said.
    pub(crate) rule: CameraRule,
    /// A camera file of the course's program.
    pub(crate) file: Option<PathBuf>,
    /// Where it stands, in the file's coordinates, y up.
    pub(crate) eye: Option<DVec3>,
    /// Where it looks.
    pub(crate) target: Option<DVec3>,
    /// Which way is up.
    pub(crate) up: Option<DVec3>,
    /// Opening angle.
    pub(crate) fov: Option<FieldOfView>,
    /// The picture is cut out of the middle of the 800 × 600 view, as the course's program does,
    /// instead of keeping the horizontal opening angle.
    pub(crate) crops: bool,
    /// Radius of the lens in scene units; a pinhole when `None` or 0.
    pub(crate) lens_radius: Option<f64>,
    /// Distance of the plane in focus in scene units.
    pub(crate) focal_distance: Option<f64>,
}

/// A full opening angle in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum FieldOfView {
    /// Across.
    X(f64),
    /// Upright.
    Y(f64),
}
