//! Everything that menus, buttons and keys can ask for, and the one table of the keys.

use std::path::PathBuf;

use eframe::egui::{Key, Modifiers};
use softbox::settings::View;

/// A wish of the user.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Command {
    /// Choose a file.
    Open,
    /// Read this file.
    OpenPath(PathBuf),
    /// Type a path.
    AskPath,
    /// Choose a finished picture to hold the running one against.
    ChooseReference,
    /// Hold the running picture against this one.
    ReadReference(PathBuf),
    /// Hold it against none.
    ForgetReference,
    /// Read the file again.
    Reload,
    /// Stop reading; the old scene stays.
    CancelLoading,
    /// Write the picture as PNG and EXR.
    SaveSnapshot,
    /// The picture to the clipboard.
    CopyImage,
    /// The command line of the picture to the clipboard.
    CopyCommandLine,
    /// The camera to a file beside the scene.
    DumpCamera,
    /// Leave.
    Quit,
    /// Throw the samples away and begin again with the path-traced picture.
    Restart,
    /// Pause or go on.
    TogglePause,
    /// Surfaces without light and back.
    ToggleSurfaces,
    /// Show this.
    Show(View),
    /// Twice as many samples per pixel as the stop rule.
    DoubleSamples,
    /// Half as many samples per pixel as the stop rule.
    HalveSamples,
    /// Twice the light samples.
    DoubleLightSamples,
    /// Half the light samples.
    HalveLightSamples,
    /// One bounce more.
    DeeperPaths,
    /// One bounce less.
    ShallowerPaths,
    /// Between uniform hemisphere sampling and light sampling.
    ToggleHemisphere,
    /// A larger lens.
    WidenLens,
    /// A smaller lens.
    NarrowLens,
    /// Focus farther away.
    FocusFarther,
    /// Focus nearer.
    FocusNearer,
    /// The camera with which the scene was opened.
    ResetCamera,
    /// The whole scene in view.
    FrameScene,
    /// The camera before the last movement.
    UndoCamera,
    /// The camera that was undone.
    RedoCamera,
    /// Half a stop brighter.
    Brighter,
    /// Half a stop darker.
    Darker,
    /// Make a render region by dragging, or remove it.
    ToggleRegion,
    /// Cancel what is going on: dragging, region, BVH view, message.
    Cancel,
    /// The boxes of the BVH.
    ToggleBvh,
    /// Show every 500th camera ray of this picture, or hide them.
    ToggleRayLog,
    /// The parent of the selected box.
    BvhParent,
    /// The first child of the selected box.
    BvhLeft,
    /// The second child of the selected box.
    BvhRight,
    /// Drop the light that was added because the scene had none.
    RemoveAddedLight,
    /// The sheet of keys.
    ToggleKeys,
    /// The report of the import.
    ToggleReport,
    /// The panels.
    TogglePanels,
    /// Full screen.
    ToggleFullScreen,
}

/// Which meaning Space has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(super) enum KeyPreset {
    /// Space pauses.
    #[default]
    Standard,
    /// Space resets the camera, as in the course's program.
    Cs184,
}

/// A key with its modifiers. Shift is ignored where the key is a sign that may need it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Chord {
    /// Modifiers that must be held.
    pub(super) modifiers: Modifiers,
    /// The key.
    pub(super) key: Key,
}

/// One line of the key sheet.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Binding {
    /// What happens.
    pub(super) command: Command,
    /// Heading in the key sheet.
    pub(super) group: Group,
    /// Shown in menus and in the key sheet.
    pub(super) text: &'static str,
    /// Keys that ask for it; the first is shown in menus.
    pub(super) chords: Vec<Chord>,
}

/// Headings of the key sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Group {
    /// Files.
    File,
    /// The render.
    Render,
    /// The camera.
    Camera,
    /// What is shown.
    View,
    /// The BVH.
    Bvh,
}

impl Group {
    /// All headings in order.
    pub(super) const ALL: [Self; 5] = [
        Self::File,
        Self::Render,
        Self::Camera,
        Self::View,
        Self::Bvh,
    ];

    /// The heading.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::File => "File",
            Self::Render => "Render",
            Self::Camera => "Camera",
            Self::View => "View",
            Self::Bvh => "BVH view",
        }
    }
}
