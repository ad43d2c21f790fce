use std::path::{Path, PathBuf};

use eframe::egui::{DroppedFile, Key, Modifiers};
use softbox::io::picture::{read_exr, read_png};
use tempfile::TempDir;

use super::*;

#[derive(Debug)]
struct Dropped(PathBuf);

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

const PLANE: &str = r##"<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#a" count="3" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
</accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"##;

pub(super) fn drop_file(harness: &mut Harness<'_, App>, path: &Path) {
    let dropped = Arc::new(Dropped(path.to_owned()));
    harness.input_mut().dropped_files.push(dropped);
    harness.step();
}

#[test]
fn a_broken_file_is_told_and_the_scene_stays() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("broken.dae");
    std::fs::write(&path, "<COLLADA><library_geometries>").unwrap();
    let mut harness = viewer();
    let scene = Arc::clone(&harness.state().document.scene);
    drop_file(&mut harness, &path);
    wait(&mut harness, "the loader", |app| {
        app.files.loading().is_none()
    });
    harness.run_steps(2);
    harness.get_by_label("That did not work");
    harness.get_by_label_contains("broken.dae");
    assert!(Arc::ptr_eq(&scene, &harness.state().document.scene));
    harness.get_by_label("Close").click();
    harness.run_steps(2);
    assert!(harness.query_by_label("That did not work").is_none());
}

#[test]
fn a_good_file_takes_the_place_of_the_scene_and_is_remembered() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("plane ä.dae");
    std::fs::write(&path, PLANE).unwrap();
    let mut harness = viewer();
    drop_file(&mut harness, &path);
    wait(&mut harness, "the scene", |app| {
        app.document.name() != "box"
    });
    wait_for_picture(&mut harness);
    let app = harness.state();
    assert_eq!(app.preferences.recent, std::slice::from_ref(&path));
    assert!(app.files.report.is_some());
    assert_eq!(app.document.scene.instances.len(), 1);

    // A changed file is read again, and the camera stays.
    let mut camera = app.document.camera;
    camera.eye.x += 0.25;
    harness.state_mut().document.camera = camera;
    let before = Arc::clone(&harness.state().document.scene);
    std::fs::write(&path, PLANE.replace("1 0 0 0 1 0<", "2 0 0 0 2 0<")).unwrap();
    wait(&mut harness, "the changed file", |app| {
        !Arc::ptr_eq(&before, &app.document.scene)
    });
    assert_eq!(harness.state().document.camera, camera);
    let (_, max) = harness.state().document.scene.bounds().unwrap();
    assert_eq!(max, DVec3::new(2.0, 2.0, 0.0));
}

#[test]
fn pictures_are_written_in_pairs_and_never_over_others() {
    let folder = TempDir::new().unwrap();
    let mut scene = small_scene();
    scene.path = Some(folder.path().join("box.dae"));
    let mut harness = viewer_of(scene, small_options());
    wait_for_picture(&mut harness);
    let files = || {
        let mut names: Vec<String> = std::fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    };
    for key in [Key::S, Key::F12] {
        let before = files().len();
        harness.key_press(key);
        // While one is being written it has another name, with a dot in front.
        let finished = || files().iter().filter(|name| !name.starts_with('.')).count();
        wait(&mut harness, "the files", |_| finished() == before + 2);
    }
    assert_eq!(
        files(),
        [
            "box_2spp_001.exr",
            "box_2spp_001.png",
            "box_2spp_002.exr",
            "box_2spp_002.png"
        ]
    );
    let snapshot = &harness
        .state()
        .view
        .viewport
        .frame()
        .expect("a picture")
        .snapshot;
    let exr = read_exr(&folder.path().join("box_2spp_001.exr")).unwrap();
    assert_eq!(exr.image.pixels(), snapshot.pixels);
    let png = read_png(&folder.path().join("box_2spp_001.png")).unwrap();
    assert_eq!((png.image.width(), png.image.height()), (64, 48));
    let command = exr.metadata.get("command").expect("the command is there");
    assert!(command.starts_with("softbox render "), "{command}");
    assert!(
        command.contains("--size 64x48") && command.contains("--spp 2"),
        "{command}"
    );
}

#[test]
fn a_typed_path_is_opened_by_enter() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("typed.dae");
    std::fs::write(&path, PLANE).unwrap();
    let mut harness = viewer();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::L);
    harness.run_steps(3);
    harness
        .get_by_role_and_label(Role::TextInput, "Path of a scene")
        .type_text(path.to_str().unwrap());
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    wait(&mut harness, "the scene", |app| {
        app.document.name() == "typed"
    });
    assert!(harness.query_by_label("Path of a scene").is_none());
}

#[test]
fn reading_can_be_cancelled_and_the_scene_stays() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("plane.dae");
    std::fs::write(&path, PLANE).unwrap();
    let mut harness = viewer();
    let scene = Arc::clone(&harness.state().document.scene);
    harness.state_mut().open(&path, false);
    assert!(harness.state_mut().files.cancel_loading());
    harness.run_steps(20);
    assert!(Arc::ptr_eq(&scene, &harness.state().document.scene));
}

#[test]
fn a_build_can_be_cancelled_and_the_picture_before_stays() {
    let mut harness = viewer();
    wait_for_picture(&mut harness);
    let app = harness.state_mut();
    let (scene, camera) = (Arc::clone(&app.document.scene), app.document.camera);
    let rays = app.engine.status().counts.camera_rays;
    let large = softbox::scene::procedural("knot-1m").expect("built in");
    app.document.replace_scene(Arc::new(large), false);
    wait(&mut harness, "the build", |app| {
        matches!(app.engine.status().state, SessionState::Preparing { .. })
    });
    harness.step();
    harness.get_by_label("Cancel").click();
    harness.run_steps(2);
    assert!(Arc::ptr_eq(&scene, &harness.state().document.scene));
    assert_eq!(harness.state().document.camera, camera);
    wait_for_picture(&mut harness);
    let status = harness.state().engine.status();
    assert_eq!(status.counts.camera_rays, rays, "no sample is taken again");
}
