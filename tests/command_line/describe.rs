//! `softbox info`.

use serde_json::Value;

use crate::{folder_with, run};

#[test]
fn info_tells_what_was_read_and_decided() {
    let folder = folder_with(&["cornell-spheres"]);
    let text = run(&folder, "info cornell-spheres.dae");
    assert!(text.starts_with("cornell-spheres\n"), "{text}");
    for part in [
        "course dialect",
        "12 triangles",
        "1 lights",
        "lamp-panel",
        "BVH: ",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let json: Value =
        serde_json::from_str(&run(&folder, "info cornell-spheres.dae --json")).unwrap();
    assert_eq!(json["scene"], "cornell-spheres");
    assert_eq!(json["primitives"], 14);
    assert_eq!(json["bounds_max"], serde_json::json!([1.0, 1.5, 1.0]));
    assert_eq!(json["report"]["read"]["lights"], 1);
    assert_eq!(json["report"]["notes"], serde_json::json!([]));
    assert_eq!(json["bvh"]["primitives"], 14);
    assert_eq!(json["added_light"], false);
}

#[test]
fn built_in_scenes_need_no_file() {
    let folder = folder_with(&[]);
    for name in ["cornell-spheres", "many-lights", "open-sky"] {
        assert!(run(&folder, &format!("info {name}")).starts_with(name));
    }
    run(&folder, "render lights -o a.png --size 8x6 --spp 1");
}
