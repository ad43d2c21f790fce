//! What the command line decides for the viewer.

use std::path::PathBuf;
use std::time::Duration;

use softbox::camera::Camera;
use softbox::display::DisplaySettings;
use softbox::settings::{CameraRule, RenderSettings};

use super::command::KeyPreset;

/// Which drawing interface the window uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Backend {
    /// OpenGL: starts nearly everywhere, and is the fast one without a graphics card.
    #[default]
    Glow,
    /// Vulkan, Metal or Direct3D.
    Wgpu,
}

impl Backend {
    /// The backend of a name on the command line.
    pub(crate) fn from_name(name: &str) -> Option<Self> {
        match name {
            "glow" => Some(Self::Glow),
            "wgpu" => Some(Self::Wgpu),
            _ => None,
        }
    }
}

/// The viewer's part of the command line. What is not given comes from the last run.
#[derive(Clone, Debug, Default)]
pub(crate) struct ViewerOptions {
    /// The file to open; the built-in scene without one.
    pub(crate) scene: Option<PathBuf>,
    /// Settings of the render.
    pub(crate) settings: Option<RenderSettings>,
    /// True when the size is given and shall not follow the window.
    pub(crate) has_fixed_size: bool,
    /// Settings of the display.
    pub(crate) display: Option<DisplaySettings>,
    /// Where the camera comes from.
    pub(crate) camera_rule: Option<CameraRule>,
    /// A camera given outright.
    pub(crate) camera: Option<Camera>,
    /// The preferred drawing interface.
    pub(crate) backend: Backend,
    /// The meaning of Space.
    pub(crate) keys: Option<KeyPreset>,
    /// Closes the window after this time.
    pub(crate) exit_after: Option<Duration>,
    /// Writes a line of state to standard error whenever something changes.
    pub(crate) logs_events: bool,
}
