//! `softbox bench --rays`.

use serde_json::Value;
use softbox::math::Isa;

use crate::{errors, folder_with, run, softbox, status};

/// Small, and each run only once.
const QUICK: &str = "--rounds 1 --builds 1 --size 32x24";

fn measured(words: &str, scenes: &[&str]) -> Value {
    let folder = folder_with(scenes);
    let text = run(&folder, &format!("bench --rays --json {QUICK} {words}"));
    serde_json::from_str(&text).expect("JSON")
}

fn is_positive(value: &Value) -> bool {
    value.as_f64().is_some_and(|number| number > 0.0)
}

#[test]
fn every_kind_of_rays_is_measured_and_right() {
    let results = measured("--threads 1,2 box36", &[]);
    let scene = &results[0];
    assert_eq!(
        (&scene["scene"], &scene["triangles"]),
        (&"box36".into(), &36.into())
    );
    assert_eq!(scene["isa"], Isa::best().name());
    assert_eq!(scene["rays"][0], serde_json::json!(["primary", 32 * 24]));
    let builds = scene["builds"].as_array().unwrap();
    // Three qualities of the hierarchy.
    assert_eq!(builds.len(), 3 * 2);
    for build in builds {
        for key in [
            "processor_seconds",
            "wall_seconds",
            "bytes",
            "sah_cost",
            "threads",
        ] {
            assert!(is_positive(&build[key]), "{key}: {build}");
        }
    }
    let traced = scene["traced"].as_array().unwrap();
    assert_eq!(traced.len(), 3 * 10);
    for row in traced {
        assert!(is_positive(&row["rays_per_second"]), "{row}");
        assert!(is_positive(&row["rays_per_wall_second"]), "{row}");
        let system = row["system"].as_str().unwrap();
        assert!(
            ["ours", "ours-high", "ours-fast"].contains(&system),
            "{row}"
        );
        let mismatches = &row["mismatches"];
        assert_eq!(
            (&mismatches["hit_or_miss"], &mismatches["distance"]),
            (&0.into(), &0.into())
        );
    }
}

#[test]
fn a_scene_file_and_chosen_kinds_are_measured() {
    let words = "--threads 1 --kinds shadow1,bounce1 cornell-spheres.dae";
    let results = measured(words, &["cornell-spheres"]);
    let scene = &results[0];
    assert_eq!(scene["scene"], "cornell-spheres");
    // The walls, and two spheres as triangles.
    assert!(scene["triangles"].as_u64().unwrap() > 10_000, "{scene}");
    let kinds: Vec<&Value> = scene["traced"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|row| row["system"] == "ours")
        .map(|row| &row["kind"])
        .collect();
    assert_eq!(kinds, ["bounce1", "shadow1"]);
    assert!(
        scene["rays"]
            .as_array()
            .unwrap()
            .iter()
            .all(|rays| is_positive(&rays[1]))
    );
}

#[test]
fn people_get_a_table() {
    let folder = tempfile::tempdir().unwrap();
    let text = run(&folder, &format!("bench --rays {QUICK} --threads 1 box36"));
    for part in [
        "box36: 36 triangles",
        "Mtri/cpu s",
        "1 thread ",
        "Mray/s",
        "0 / 0",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn a_scene_that_is_not_there_is_named() {
    let folder = tempfile::tempdir().unwrap();
    for (scene, reason) in [
        ("no-such-scene", "box36, ico10k"),
        ("missing.dae", "missing.dae"),
    ] {
        let output = softbox(folder.path(), &["bench", "--rays", scene]);
        assert_eq!(status(&output), Some(3), "{scene}");
        assert!(errors(&output).contains(reason), "{}", errors(&output));
    }
}
