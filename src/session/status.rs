use crate::integrator::PathCounts;

/// Why a render is finished.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopReason {
    /// All samples were taken.
    Samples,
    /// The time limit was reached.
    Seconds,
    /// The estimated relative error is small enough.
    Error,
    /// Adaptive sampling has closed every pixel.
    Converged,
    /// The view needs one ray a pixel only.
    FirstHit,
}

/// What a session is doing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum SessionState {
    /// No job yet.
    #[default]
    Idle,
    /// Making a scene ready; the old picture stays.
    Preparing {
        /// What is being done.
        stage: &'static str,
        /// How far, 0..1.
        fraction: f32,
    },
    /// Taking samples.
    Rendering,
    /// Held.
    Paused,
    /// Done; uses no processor time.
    Finished(StopReason),
}

/// What has become of the hierarchy of a scene, which [`crate::bvh::BvhQuality::High`] asks to make
/// better while the picture renders. Never changes the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum TreeState {
    /// As it was first built; nothing is being done about it.
    #[default]
    AsBuilt,
    /// A better one is in the making; it rests while the render does.
    Refining {
        /// How far, 0..1.
        fraction: f32,
    },
    /// The better one is in use.
    Refined {
        /// Seconds that it took.
        seconds: f64,
    },
    /// There was a fault; the first one stays in use.
    NotRefined,
}

/// A cheap description of a running render.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SessionStatus {
    /// What is being done.
    pub state: SessionState,
    /// Mean samples per pixel so far.
    pub samples_mean: f64,
    /// Samples per pixel at which the render ends.
    pub samples_target: Option<u32>,
    /// Seconds spent rendering this picture.
    pub seconds: f64,
    /// Processor time that the workers spent on this picture.
    pub cpu_seconds: f64,
    /// Seconds spent building the hierarchy and the light tables of this scene.
    pub build_seconds: f64,
    /// The hierarchy of this scene.
    pub tree: TreeState,
    /// Root of the relative squared error that the samples tell, see [`crate::film::Film::summary`].
    pub relative_error: Option<f64>,
    /// Seconds until the active stop rule ends the render; `None` until it means something.
    pub eta_seconds: Option<f64>,
    /// Samples per second over the last passes.
    pub samples_per_second: f64,
    /// Work done for this picture.
    pub counts: PathCounts,
    /// A sentence for the user when something went wrong.
    pub message: Option<String>,
}

impl SessionStatus {
    /// True when nothing more will happen by itself.
    pub fn is_finished(&self) -> bool {
        matches!(self.state, SessionState::Finished(_))
    }

    /// True when the session has come to rest after [`super::RenderSession::pause`].
    pub fn is_held(&self) -> bool {
        self.is_finished() || self.state == SessionState::Paused
    }
}
