use std::ops::ControlFlow;
use std::path::Path;

use super::ImportError;

/// How far reading has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadProgress {
    /// What is being done.
    pub stage: LoadStage,
    /// How much of this stage is done, 0..1.
    pub fraction: f32,
}

/// The stages of reading, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LoadStage {
    /// Bytes from the disk.
    Reading,
    /// Text to a tree of elements.
    Parsing,
    /// The node hierarchy.
    Nodes,
    /// Meshes and spheres.
    Geometry,
    /// Materials bound to what the nodes place.
    Materials,
}

impl LoadStage {
    /// A word for a status line.
    pub fn label(self) -> &'static str {
        match self {
            Self::Reading => "reading",
            Self::Parsing => "parsing",
            Self::Nodes => "nodes",
            Self::Geometry => "geometry",
            Self::Materials => "materials",
        }
    }
}

/// The caller's callback together with the path that a cancellation names.
pub(super) struct Reporter<'a> {
    pub(super) path: &'a Path,
    pub(super) callback: &'a mut dyn FnMut(LoadProgress) -> ControlFlow<()>,
}

impl Reporter<'_> {
    /// Tells the caller where reading stands.
    ///
    /// # Errors
    /// [`ImportError::Cancelled`] when the caller breaks.
    pub(super) fn at(&mut self, stage: LoadStage, fraction: f32) -> Result<(), ImportError> {
        match (self.callback)(LoadProgress { stage, fraction }) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(ImportError::Cancelled {
                path: self.path.to_owned(),
            }),
        }
    }
}
