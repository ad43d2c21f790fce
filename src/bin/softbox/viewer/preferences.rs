//! What is remembered from one start to the next.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use softbox::display::DisplaySettings;
use softbox::settings::{RenderSettings, View};

use super::command::KeyPreset;
use super::document::Resolution;

/// The most recent files that are kept.
const RECENT: usize = 8;
const KEY: &str = "softbox";

/// The stored part of the program's state. Unknown and missing fields are fine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(super) struct Preferences {
    /// Files opened last, the newest first.
    pub(super) recent: Vec<PathBuf>,
    /// The meaning of Space.
    pub(super) keys: KeyPreset,
    /// True when the panels are shown.
    pub(super) shows_panels: bool,
    /// Reads the file again when it changes.
    pub(super) watches_files: bool,
    /// Who chooses the size.
    pub(super) resolution: Resolution,
    /// Display settings of the last run.
    pub(super) display: DisplaySettings,
    /// Render settings of the last run.
    pub(super) settings: RenderSettings,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            recent: Vec::new(),
            keys: KeyPreset::default(),
            shows_panels: true,
            watches_files: true,
            resolution: Resolution::default(),
            display: DisplaySettings::default(),
            settings: RenderSettings::default(),
        }
    }
}

impl Preferences {
    /// The stored preferences, or the defaults.
    pub(super) fn load(storage: Option<&dyn eframe::Storage>) -> Self {
        storage
            .and_then(|storage| eframe::get_value(storage, KEY))
            .unwrap_or_default()
    }

    /// Stores them.
    pub(super) fn save(&self, storage: &mut dyn eframe::Storage) {
        eframe::set_value(storage, KEY, self);
    }

    /// Takes over the settings that outlive a run: nothing that belongs to one scene.
    pub(super) fn remember(&mut self, settings: &RenderSettings, display: DisplaySettings) {
        self.display = display;
        self.settings = RenderSettings {
            region: None,
            view: View::Render,
            course_compatible: false,
            only_last_bounce: false,
            ..settings.clone()
        };
    }

    /// Puts `path` in front of the recent files.
    pub(super) fn note_file(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        self.recent.retain(|known| *known != path);
        self.recent.insert(0, path);
        self.recent.truncate(RECENT);
    }
}
