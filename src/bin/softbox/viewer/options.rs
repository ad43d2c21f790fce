//! What the command line decides for the viewer.

use std::path::PathBuf;
use std::time::Duration;

use softbox::display::DisplaySettings;
use softbox::math::Isa;
use softbox::settings::RenderSettings;

use super::command::KeyPreset;
use crate::args::WindowArgs;
use crate::job::{CameraChoice, Job};

/// Which drawing interface the window uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Backend {
    /// OpenGL: starts nearly everywhere, and is the fast one without a graphics card.
    #[default]
    Glow,
    /// Vulkan, Metal or Direct3D.
    Wgpu,
}

/// The viewer's part of the command line. What is not given comes from the last run.
#[derive(Clone, Debug, Default)]
pub(super) struct ViewerOptions {
    /// The file to open; the built-in scene without one.
    pub(super) scene: Option<PathBuf>,
    /// Settings of the render.
    pub(super) settings: Option<RenderSettings>,
    /// Forced instruction set, whatever the settings.
    pub(super) isa: Option<Isa>,
    /// True when the size is given and shall not follow the window.
    pub(super) has_fixed_size: bool,
    /// Settings of the display.
    pub(super) display: Option<DisplaySettings>,
    /// What was said about the camera.
    pub(super) camera: CameraChoice,
    /// A picture of the surroundings in place of the scenes' own.
    pub(super) environment: Option<PathBuf>,
    /// The preferred drawing interface.
    pub(super) backend: Backend,
    /// The meaning of Space.
    pub(super) keys: Option<KeyPreset>,
    /// Closes the window after this time.
    pub(super) exit_after: Option<Duration>,
    /// Writes a line of state to standard error whenever something changes.
    pub(super) logs_events: bool,
    /// Measures how fluent the window is, then closes it.
    pub(super) measures_fluency: bool,
}

impl ViewerOptions {
    /// The options of a command line. Settings that are the defaults count as not given.
    pub(super) fn new(job: &Job, window: &WindowArgs) -> Self {
        let settings = &job.settings;
        let plain = RenderSettings {
            isa: settings.isa,
            ..RenderSettings::default()
        };
        Self {
            scene: job.scene.clone(),
            settings: (*settings != plain).then(|| settings.clone()),
            isa: settings.isa,
            has_fixed_size: (settings.width, settings.height) != (plain.width, plain.height),
            display: (job.display != DisplaySettings::default()).then_some(job.display),
            camera: job.camera.clone(),
            environment: job.environment.clone(),
            backend: match window.renderer.as_deref() {
                Some("wgpu") => Backend::Wgpu,
                _ => Backend::Glow,
            },
            keys: window.keys.as_deref().map(|name| match name {
                "cs184" => KeyPreset::Cs184,
                _ => KeyPreset::Standard,
            }),
            exit_after: window
                .exit_after
                .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok()),
            logs_events: window.log_events,
            measures_fluency: window.measure_fluency,
        }
    }
}
