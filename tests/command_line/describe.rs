//! `softbox info`.

use serde_json::Value;

use crate::collada_text::{VERTEX, document, square};
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
    assert_eq!(json["bvh"]["primitives"], 8);
    assert_eq!(json["bvh"]["quads"], 6);
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

#[test]
fn info_tells_what_instances_share() {
    let folder = folder_with(&[]);
    let triangles = ["0 1 2", "0 2 3"].repeat(500).join(" ");
    let primitives = format!("<triangles count=\"1000\">{VERTEX}<p>{triangles}</p></triangles>");
    let node = |i: usize| {
        format!(
            "<node id=\"n{i}\"><translate>{i} 0 0</translate>\
             <instance_geometry url=\"#g\"/></node>"
        )
    };
    let nodes: String = (0..300).map(node).collect();
    let text = document(&square(&primitives), &nodes);
    std::fs::write(folder.path().join("copies.dae"), text).expect("a file");
    let text = run(&folder, "info copies.dae");
    let line = "instances: 300 of 1 shared meshes, 1000 triangles that rays meet as 300000, ";
    assert!(text.contains(line), "{text}");
    let json: Value = serde_json::from_str(&run(&folder, "info copies.dae --json")).unwrap();
    assert_eq!(json["primitives"], 300_000);
    let shared = &json["instancing"];
    assert_eq!(shared["instances"], 300);
    assert_eq!(shared["meshes"], 1);
    assert_eq!(shared["unique_triangles"], 1_000);
    assert_eq!(shared["virtual_triangles"], 300_000);
    assert!(shared["bytes"].as_u64().expect("a number") < 1_000_000);
}
