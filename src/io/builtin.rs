use super::{ImportReport, Loaded, collada::parse_collada};
use crate::scene::{PROCEDURAL, procedural};

/// Name of the scene that opens without an argument.
pub const DEFAULT_SCENE: &str = "cornell-spheres";

/// The scenes of `assets/`, in the program itself.
const ASSETS: [(&str, &str); 7] = [
    (
        "cornell-spheres",
        include_str!("../../assets/cornell-spheres.dae"),
    ),
    (
        "cornell-empty",
        include_str!("../../assets/cornell-empty.dae"),
    ),
    (
        "cornell-mirror-glass",
        include_str!("../../assets/cornell-mirror-glass.dae"),
    ),
    (
        "cornell-microfacet",
        include_str!("../../assets/cornell-microfacet.dae"),
    ),
    ("lights", include_str!("../../assets/lights.dae")),
    ("many-lights", include_str!("../../assets/many-lights.dae")),
    ("open-sky", include_str!("../../assets/open-sky.dae")),
];

/// Names of the scenes that need no file: those of `assets/`, then the procedural ones.
pub fn builtin_names() -> impl Iterator<Item = &'static str> {
    ASSETS.iter().chain(&PROCEDURAL).map(|(name, _)| *name)
}

/// The built-in scene called `name`.
pub fn builtin_scene(name: &str) -> Option<Loaded> {
    if let Some(scene) = procedural(name) {
        return Some(Loaded {
            scene,
            report: ImportReport::default(),
        });
    }
    let (name, text) = ASSETS.iter().find(|(asset, _)| *asset == name)?;
    Some(parse_collada(text, name).expect("the program's own scenes are tested"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_builtin_scene_opens_without_a_warning() {
        for name in builtin_names() {
            let loaded = builtin_scene(name).expect("listed");
            assert!(loaded.scene.has_light(), "{name}");
            assert_eq!(loaded.scene.name, name);
            let worst = loaded.report.notes.iter().map(|note| note.severity).max();
            assert!(
                worst.is_none_or(|s| s <= crate::io::Severity::Guessed),
                "{name}: {}",
                loaded.report
            );
        }
        assert!(builtin_scene("no such scene").is_none());
        assert!(builtin_names().any(|name| name == DEFAULT_SCENE));
    }
}
