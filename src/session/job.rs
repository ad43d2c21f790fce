use std::sync::Arc;

use crate::camera::Camera;
use crate::scene::Scene;
use crate::settings::RenderSettings;

/// One order: what to render. Two jobs are equal when they share the scene (by pointer) and agree
/// in camera and settings.
#[derive(Clone, Debug)]
pub struct RenderJob {
    /// The scene; an edit makes a new one.
    pub scene: Arc<Scene>,
    /// From where.
    pub camera: Camera,
    /// How.
    pub settings: RenderSettings,
}

impl PartialEq for RenderJob {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && self.camera == other.camera
            && self.settings == other.settings
    }
}

/// How a session behaves towards its host.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SessionOptions {
    /// For a window: workers run at low priority, every change shows a coarse preview first, and
    /// snapshots follow each other quickly. Otherwise all time goes into samples and a snapshot
    /// is made about once a second and at the end.
    pub interactive: bool,
}
