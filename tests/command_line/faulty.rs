//! Faulty scenes through the program: status 3 and one sentence, or a picture with a warning.

use std::fs;

use softbox::io::Severity;

use crate::collada_text::{PLACE, VERTEX, document, load_bytes, square};
use crate::{errors, folder_with, names, softbox, status};

fn good() -> String {
    let triangle = format!("<triangles count='1'>{VERTEX}<p>0 1 2</p></triangles>");
    document(&square(&triangle), PLACE)
}

/// A good triangle and another primitive.
fn with(primitive: &str) -> Vec<u8> {
    let triangle = format!("<triangles count='1'>{VERTEX}<p>0 1 2</p></triangles>");
    document(&square(&format!("{triangle}{primitive}")), PLACE).into_bytes()
}

fn unreadable() -> Vec<Vec<u8>> {
    let text = good();
    let circle = document("", "<node id='me'>\n<instance_node url='#me'/></node>");
    let deep = format!("{}{}", "<node>".repeat(5000), "</node>".repeat(5000));
    vec![
        Vec::new(),
        b" \n\t \n".to_vec(),
        b"hello world".to_vec(),
        b"PK\x03\x04....".to_vec(),
        vec![0; 1000],
        b"<?xml version='1.0'?>\n<svg><g/></svg>".to_vec(),
        b"<COLLADA/>".to_vec(),
        text.as_bytes()[..text.len() / 2].to_vec(),
        text.replace("</mesh></geometry>", "</geometry></mesh>")
            .into_bytes(),
        text.replace("id=\"g\"", "id=\"g").into_bytes(),
        text.replace("?>\n", "?>\n<!DOCTYPE COLLADA [<!ENTITY a \"0\">]>\n")
            .into_bytes(),
        circle.into_bytes(),
        document("", &deep).into_bytes(),
    ]
}

fn survivable() -> Vec<Vec<u8>> {
    let text = good();
    let beside = |node: &str| {
        let triangle = format!("<triangles count='1'>{VERTEX}<p>0 1 2</p></triangles>");
        document(&square(&triangle), &format!("{PLACE}\n{node}")).into_bytes()
    };
    vec![
        text.replace("name=\"square\"", "name=\"R&D\"").into_bytes(),
        text.replace("Y_UP", "sideways").into_bytes(),
        text.replace("0 1 2</p>", "0 1 99999999999999999999</p>")
            .into_bytes(),
        text.replace("0 1 2</p>", "</p>").into_bytes(),
        with("<triangles><p>0 1 2</p></triangles>"),
        with(&format!(
            "<polylist>{VERTEX}<vcount>4294967294</vcount><p>0 1 2</p></polylist>"
        )),
        with(
            "<triangles><input semantic='VERTEX' source='#v' offset='1000000000'/><p>0 1 2</p></triangles>",
        ),
        beside("<node><instance_geometry url='#none'/></node>"),
        beside("<node><matrix>1 2 3</matrix></node>"),
        beside("<node><scale>1 0 1</scale><instance_geometry url='#g'/></node>"),
    ]
}

#[test]
fn unreadable_scenes_give_one_sentence_and_no_file() {
    let folder = folder_with(&[]);
    for bytes in unreadable() {
        let start = String::from_utf8_lossy(&bytes[..bytes.len().min(60)]).into_owned();
        assert!(load_bytes(&bytes).is_err(), "{start}");
        fs::write(folder.path().join("x.dae"), &bytes).unwrap();
        for words in [
            &["render", "x.dae", "-o", "a.png", "--json"][..],
            &["-f", "a.png", "x.dae"],
            &["info", "x.dae", "--json"],
        ] {
            let output = softbox(folder.path(), words);
            assert_eq!(status(&output), Some(3), "{start}");
            assert!(output.stdout.is_empty(), "{start}");
            let text = errors(&output);
            assert!(
                text.starts_with("softbox: x.dae") && text.ends_with(".\n"),
                "{text}"
            );
            assert_eq!(text.lines().count(), 1, "{text}");
        }
        assert_eq!(names(&folder), ["x.dae"], "{start}");
    }
}

#[test]
fn survivable_faults_give_a_picture_and_a_warning() {
    let folder = folder_with(&[]);
    for bytes in survivable() {
        let loaded = load_bytes(&bytes).expect("a scene with a warning");
        let mut notes = loaded.report.notes.iter();
        let note = notes
            .find(|note| note.severity >= Severity::Dropped)
            .expect("a warning");
        fs::write(folder.path().join("x.dae"), &bytes).unwrap();
        let words = [
            "render", "x.dae", "-o", "a.exr", "--size", "8x6", "--spp", "2",
        ];
        let output = softbox(folder.path(), &words);
        assert_eq!(status(&output), Some(0), "{}", errors(&output));
        assert!(output.stdout.is_empty());
        assert!(
            errors(&output).contains(&note.message),
            "{}",
            errors(&output)
        );
        let described = softbox(folder.path(), &["info", "x.dae"]);
        let described = String::from_utf8(described.stdout).unwrap();
        assert!(described.contains(&note.message), "{described}");
        assert_eq!(crate::pixels(&folder, "a.exr").len(), 48);
    }
}
