//! Broken files: each gives an error of one sentence that says where and what to do, or a scene
//! with a warning. None panics, hangs or asks for memory that the file only claims to need.

#[path = "../collada_text/mod.rs"]
mod collada_text;
mod faces;
mod files;
mod mutations;
mod nodes;
mod text;

use collada_text::{PLACE, VERTEX, document, load_bytes, square};
use softbox::io::{ImportError, Loaded, Severity, load_scene};
use std::ops::ControlFlow;
use std::path::Path;

fn load_path(path: &Path) -> Result<Loaded, ImportError> {
    load_scene(path, &mut |_| ControlFlow::Continue(()))
}

fn good() -> String {
    document(
        &square(&format!(
            "<triangles count='1'>{VERTEX}<p>0 1 2</p></triangles>"
        )),
        PLACE,
    )
}

/// The message is one sentence, names file and place, and has a remedy after the semicolon.
fn check_sentence(error: &ImportError, place: &str) {
    let message = error.to_string();
    assert!(
        message.ends_with('.') && !message.contains('\n'),
        "{message}"
    );
    assert!(!message.trim_end_matches('.').contains(". "), "{message}");
    assert!(
        message.contains(&*error.path().to_string_lossy()),
        "{message}"
    );
    assert!(message.contains(place), "{place}: {message}");
    let remedy = message.rsplit("; ").next().unwrap_or_default();
    assert!(message.contains("; ") && remedy.len() > 10, "{message}");
}

fn assert_error(name: &str, bytes: &[u8], place: &str) {
    match load_bytes(bytes) {
        Ok(loaded) => panic!("{name}: read as a scene\n{}", loaded.report),
        Err(error) => check_sentence(&error, place),
    }
}

/// Loads a text that has one fault; the report must have a warning with that part in its message.
/// Returns the triangles that are left.
fn warned(name: &str, text: &str, part: &str) -> usize {
    let loaded = match load_bytes(text.as_bytes()) {
        Ok(loaded) => loaded,
        Err(error) => panic!("{name}: {error}"),
    };
    let is_warned = loaded.report.notes.iter().any(|note| {
        note.severity >= Severity::Dropped
            && note.message.contains(part)
            && note.line.is_some()
            && !note.element.is_empty()
    });
    assert!(is_warned, "{name}:\n{}", loaded.report);
    loaded.report.read.triangles
}
