use std::sync::Arc;

use super::Shared;
use super::picture::Picture;
use crate::scene::PreparedScene;
use crate::session::TreeState;
use crate::session::background::{Background, Outcome};
use crate::session::refinement::{is_asked_for, is_worth_it};

/// Makes the hierarchy of the prepared scene better while its picture renders.
#[derive(Debug, Default)]
pub(super) struct Refiner {
    /// The work on the scene that is rendered, and on no other.
    task: Option<Background<PreparedScene>>,
    /// The scene has its refined hierarchy, or cannot have one.
    is_done: bool,
}

impl Refiner {
    /// Stops the work; what is known about the scene stays.
    pub(super) fn cancel(&mut self, shared: &Shared) {
        if self.task.take().is_some() {
            shared.update_status(|status| status.tree = TreeState::AsBuilt);
        }
    }

    /// Begins anew with another scene.
    pub(super) fn reset(&mut self, shared: &Shared) {
        *self = Self::default();
        shared.update_status(|status| status.tree = TreeState::AsBuilt);
    }

    /// Lets the work rest.
    pub(super) fn hold(&self) {
        if let Some(task) = &self.task {
            task.hold();
        }
    }

    /// True when [`Self::take`] has something to give.
    pub(super) fn has_news(&self) -> bool {
        self.task.as_ref().is_some_and(Background::is_over)
    }

    /// The refined scene, once.
    pub(super) fn take(&mut self, shared: &Shared) -> Option<PreparedScene> {
        let outcome = self.task.as_ref()?.take_outcome()?;
        self.task = None;
        self.is_done = true;
        let (scene, state) = match outcome {
            Outcome::Done(scene, time) => {
                let seconds = time.as_secs_f64();
                (Some(scene), TreeState::Refined { seconds })
            }
            Outcome::Failed => (None, TreeState::NotRefined),
        };
        shared.update_status(|status| status.tree = state);
        scene
    }

    /// Starts the work, or goes on with it, while `picture` of `scene` is rendered and that pays.
    pub(super) fn tend(&mut self, shared: &Shared, scene: &Arc<PreparedScene>, picture: &Picture) {
        let settings = &picture.job.settings;
        if !is_asked_for(settings) {
            return self.cancel(shared);
        }
        if let Some(task) = &self.task {
            task.go_on();
            let fraction = task.fraction();
            return shared.update_status(|status| status.tree = TreeState::Refining { fraction });
        }
        let primitives = scene.shapes().len() + scene.aggregate().instance_stats().unique_triangles;
        let is_interactive = shared.options.interactive;
        let pays = is_interactive || is_worth_it(primitives, settings, picture.counts());
        if self.is_done || scene.aggregate().is_refined() || !pays {
            return;
        }
        let scene = Arc::clone(scene);
        self.task = Some(Background::start(
            "softbox-refine",
            is_interactive,
            move |progress| scene.refined(progress),
        ));
        shared.update_status(|status| status.tree = TreeState::Refining { fraction: 0.0 });
    }
}
