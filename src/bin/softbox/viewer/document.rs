//! What is open: the scene, the camera, the settings, and the cameras before.

use eframe::egui;
use std::sync::Arc;

use softbox::camera::Camera;
use softbox::display::DisplaySettings;
use softbox::scene::{Scene, initial_camera};
use softbox::session::RenderJob;
use softbox::settings::{Mode, RenderSettings};

use super::history::History;
use crate::job::CameraChoice;
use crate::place_camera::place_camera;

/// How the picture's size is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(super) enum Resolution {
    /// As large as the view.
    #[default]
    FollowWindow,
    /// The numbers in the settings.
    Fixed,
}

/// The document: everything that a picture on the screen depends on.
#[derive(Debug)]
pub(super) struct Document {
    /// The scene as its file describes it.
    pub(super) scene: Arc<Scene>,
    /// The camera.
    pub(super) camera: Camera,
    /// The settings of the render.
    pub(super) settings: RenderSettings,
    /// The settings of the display, which never restart a render.
    pub(super) display: DisplaySettings,
    /// Where "reset" finds the camera.
    pub(super) camera_choice: CameraChoice,
    /// Who chooses the size.
    pub(super) resolution: Resolution,
    /// The mode that takes turns with the hemisphere mode.
    pub(super) light_mode: Mode,
    history: History<Camera>,
    size: f64,
    /// What was open before, to go back to when the build of a new scene is cancelled.
    before: Option<(Arc<Scene>, Camera)>,
}

impl Document {
    /// A document of `scene`, seen by its own camera.
    pub(super) fn new(
        scene: Arc<Scene>,
        settings: RenderSettings,
        display: DisplaySettings,
        camera_choice: CameraChoice,
    ) -> Self {
        let camera = placed(&camera_choice, &scene, &settings);
        let size = scene_size(&scene);
        Self {
            scene,
            camera,
            settings,
            display,
            camera_choice,
            resolution: Resolution::default(),
            light_mode: Mode::Best,
            history: History::new(camera),
            size,
            before: None,
        }
    }

    /// The job that shows this document.
    pub(super) fn render_job(&self) -> RenderJob {
        RenderJob {
            scene: Arc::clone(&self.scene),
            camera: self.camera,
            settings: self.settings.clone(),
        }
    }

    /// Forgets what the command line said about the camera of the first scene.
    pub(super) fn forget_camera_choice(&mut self) {
        self.camera_choice = CameraChoice {
            rule: self.camera_choice.rule,
            ..CameraChoice::default()
        };
    }

    /// Shows `scene` instead. `keeps_camera` for a new version of the same file.
    pub(super) fn replace_scene(&mut self, scene: Arc<Scene>, keeps_camera: bool) {
        self.size = scene_size(&scene);
        let old = std::mem::replace(&mut self.scene, scene);
        self.before = Some((old, self.camera));
        if !keeps_camera {
            self.settings.region = None;
            self.reset_camera();
            self.history = History::new(self.camera);
        }
    }

    /// Back to the scene that was open before; false when there is none.
    pub(super) fn return_to_scene_before(&mut self) -> bool {
        let Some((scene, camera)) = self.before.take() else {
            return false;
        };
        self.size = scene_size(&scene);
        self.scene = scene;
        self.camera = camera;
        self.history = History::new(camera);
        true
    }

    /// Back to the camera with which the scene was opened.
    pub(super) fn reset_camera(&mut self) {
        self.camera = placed(&self.camera_choice, &self.scene, &self.settings);
    }

    /// Makes the picture as large as a view of `pixels`, as far as the graphics driver allows.
    pub(super) fn follow(&mut self, pixels: egui::Vec2, longest_side: usize) {
        let longest = longest_side.max(1) as f32;
        let side = |length: f32| length.round().clamp(1.0, longest) as u32;
        self.settings.width = side(pixels.x);
        self.settings.height = side(pixels.y);
    }

    /// The diagonal of the scene in file units; 1 for an empty one.
    pub(super) fn scene_size(&self) -> f64 {
        self.size
    }

    /// The picture's size in pixels.
    pub(super) fn image_size(&self) -> [u32; 2] {
        [self.settings.width, self.settings.height]
    }

    /// Remembers the camera once it has rested: call every frame with the time in seconds and
    /// whether a hand still moves it.
    pub(super) fn settle_camera(&mut self, now: f64, is_moving: bool) {
        self.history.observe(self.camera, now, is_moving);
    }

    /// The camera before the last movement.
    pub(super) fn undo_camera(&mut self) {
        self.camera = self.history.undo(self.camera);
    }

    /// The camera that was undone last.
    pub(super) fn redo_camera(&mut self) {
        self.camera = self.history.redo(self.camera);
    }

    /// The scene's name for titles and file names.
    pub(super) fn name(&self) -> &str {
        &self.scene.name
    }
}

/// The chosen camera; a camera file that has become unreadable counts as not given.
fn placed(choice: &CameraChoice, scene: &Scene, settings: &RenderSettings) -> Camera {
    let choice = CameraChoice {
        crops: choice.crops || settings.course_compatible,
        ..choice.clone()
    };
    place_camera(&choice, scene, [settings.width, settings.height])
        .unwrap_or_else(|_| initial_camera(scene, choice.rule, choice.crops))
}

fn scene_size(scene: &Scene) -> f64 {
    scene
        .bounds()
        .map(|(min, max)| (max - min).length())
        .filter(|size| *size > 0.0 && size.is_finite())
        .unwrap_or(1.0)
}
