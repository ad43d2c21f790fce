//! What a picture file says about its own making.

use std::path::Path;

use softbox::display::DisplaySettings;
use softbox::io::picture::Metadata;
use softbox::session::Snapshot;

/// The words that go into the files of a picture of the scene called `scene_name`; `command`
/// renders it again.
pub(crate) fn metadata(
    snapshot: &Snapshot,
    display: &DisplaySettings,
    (scene_name, scene_path): (&str, Option<&Path>),
    command: &str,
) -> Metadata {
    let mut metadata = Metadata::default();
    metadata.set("version", env!("CARGO_PKG_VERSION"));
    metadata.set("scene", scene_name);
    if let Some(hash) = scene_path.and_then(scene_hash) {
        metadata.set("scene-hash", hash);
    }
    metadata.set("seed", snapshot.settings.seed.to_string());
    // Samples of a pixel are numbered from 0.
    metadata.set("samples", format!("0..{}", snapshot.samples_max));
    metadata.set("samples-mean", snapshot.samples_mean.to_string());
    metadata.set("seconds", format!("{:.3}", snapshot.seconds));
    metadata.set("isa", snapshot.settings.instruction_set().name());
    metadata.set("view", snapshot.view.name());
    if let Some(error) = snapshot.relative_error {
        metadata.set("relative-error", error.to_string());
    }
    if snapshot.settings.adaptive.is_some() {
        metadata.set("biased", "adaptive sampling");
    }
    for (key, text) in [
        ("settings", serde_json::to_string(&snapshot.settings)),
        ("camera", serde_json::to_string(&snapshot.camera)),
        ("display", serde_json::to_string(display)),
    ] {
        metadata.set(key, text.expect("plain data always has a JSON form"));
    }
    metadata.set(Metadata::COMMAND, command);
    metadata
}

/// The CRC-32 of the scene's file, in hexadecimal; tells versions apart, proves nothing.
fn scene_hash(path: &Path) -> Option<String> {
    let bytes = std::fs::read(path).ok()?;
    Some(format!("crc32:{:08x}", crc32fast::hash(&bytes)))
}
