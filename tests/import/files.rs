//! Encodings, progress, reports and errors.

use crate::collada_text::{PLACE, VERTEX, document, load_bytes, square};
use crate::{faults, first_mesh, load, mesh_of};
use softbox::io::{ImportError, LoadStage, load_scene, read_collada};
use std::ops::ControlFlow;
use std::path::Path;

#[test]
fn encodings_namespaces_and_names_make_no_difference() {
    let text = document(
        &square(&format!("<triangles>{VERTEX}<p>0 1 2</p></triangles>")),
        PLACE,
    )
    .replace("name=\"square\"", "name=\"Würfel\"");
    let expected = load(&text).scene;
    assert_eq!(first_mesh(&expected).name, "Würfel");
    let utf16: Vec<u8> = [0xFF, 0xFE]
        .into_iter()
        .chain(text.encode_utf16().flat_map(u16::to_le_bytes))
        .collect();
    let latin1: Vec<u8> = text
        .replace("utf-8", "ISO-8859-1")
        .chars()
        .map(|c| u8::try_from(u32::from(c)).expect("Latin-1 letters only"))
        .collect();
    let with_mark = format!("\u{FEFF}{text}");
    let newer = text.replace("2005/11", "2008/03").replace("1.4.1", "1.5.0");
    let prefixed = text
        .replace("xmlns=", "xmlns:c=")
        .replace("<COLLADA", "<c:COLLADA")
        .replace("</COLLADA", "</c:COLLADA");
    let old_lines = text.replace('\n', "\r\n");
    for bytes in [
        &utf16,
        &latin1,
        with_mark.as_bytes(),
        newer.as_bytes(),
        prefixed.as_bytes(),
        old_lines.as_bytes(),
    ] {
        let loaded = load_bytes(bytes).expect("the same scene");
        assert_eq!(loaded.scene.geometries, expected.geometries);
        assert_eq!(faults(&loaded), Vec::<String>::new());
    }
}

#[test]
fn progress_runs_through_the_stages_and_can_be_stopped() {
    let folder = tempfile::TempDir::new().expect("a temporary folder");
    let path = folder.path().join("scene.xyz");
    let text = document(
        &square(&format!("<triangles>{VERTEX}<p>0 1 2</p></triangles>")),
        PLACE,
    );
    std::fs::write(&path, text).expect("a temporary file");
    let mut seen = Vec::new();
    let loaded = load_scene(&path, &mut |progress| {
        assert!((0.0..=1.0).contains(&progress.fraction));
        seen.push(progress.stage);
        ControlFlow::Continue(())
    });
    let loaded = loaded.expect("any extension will do for XML");
    assert_eq!(loaded.scene.name, "scene");
    assert_eq!(loaded.scene.path.as_deref(), Some(path.as_path()));
    assert!(seen.is_sorted());
    for stage in [
        LoadStage::Reading,
        LoadStage::Parsing,
        LoadStage::Nodes,
        LoadStage::Geometry,
        LoadStage::Materials,
    ] {
        assert!(seen.contains(&stage), "{stage:?}");
        let stopped = read_collada(&path, &mut |progress| {
            if progress.stage == stage {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        assert!(
            matches!(stopped, Err(ImportError::Cancelled { .. })),
            "{stage:?}"
        );
    }
}

#[test]
fn the_report_reads_well_and_goes_into_json() {
    let (_, loaded) = mesh_of(&format!(
        "<triangles count='5'>{VERTEX}<p>0 1 2 0 1 77</p></triangles>"
    ));
    let text = loaded.report.to_string();
    assert!(text.contains("1 triangles in 1 meshes"), "{text}");
    assert!(
        text.contains("warning line 8: triangles of geometry \"g\": 1 faces with an index"),
        "{text}"
    );
    assert!(text.contains("count says 5, the lists give 2"), "{text}");
    let json = serde_json::to_value(&loaded.report).expect("plain data");
    assert_eq!(json["read"]["triangles"], 1);
    assert_eq!(json["notes"][0]["severity"], "Warning");
}

#[test]
fn errors_can_cross_threads() {
    fn assert_can_cross<T: Send + Sync + 'static>(_: &T) {}
    let error = load_scene(Path::new("/nowhere/at all.dae"), &mut |_| {
        ControlFlow::Continue(())
    });
    assert_can_cross(&error.expect_err("there is no such file"));
}
