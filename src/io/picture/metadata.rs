use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Prefix of every attribute, text chunk or header line of ours.
pub(super) const PREFIX: &str = "softbox:";

/// What a picture file says about its own making, as texts in the order of their keys.
///
/// Keys are plain words (`version`, `seed`, `settings`, `camera`, `scene-hash`, `command`); files
/// carry them under the prefix `softbox:`. The text under `command` also becomes the file's comment.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Metadata(BTreeMap<String, String>);

impl Metadata {
    /// Key of the command line that renders the picture again.
    pub const COMMAND: &'static str = "command";

    /// Sets one text.
    ///
    /// # Panics
    /// When the key is not 1 to 23 ASCII letters, digits, `-` or `_`, the limit of the formats.
    pub fn set(&mut self, key: &str, value: impl Into<String>) {
        let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        assert!(
            (1..=23).contains(&key.len()) && key.chars().all(is_plain),
            "'{key}' cannot be a metadata key"
        );
        self.0.insert(key.to_owned(), value.into());
    }

    /// The text under `key`.
    pub fn get(&self, key: &str) -> Option<&str> {
        self.0.get(key).map(String::as_str)
    }

    /// True when there is no text.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// All pairs in the order of their keys.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.iter().map(|(k, v)| (k.as_str(), v.as_str()))
    }

    /// Takes over a pair from a file when its name carries our prefix.
    pub(super) fn insert_prefixed(&mut self, name: &str, value: String) {
        if let Some(key) = name.strip_prefix(PREFIX) {
            self.0.insert(key.to_owned(), value);
        }
    }
}
