//! Files that are no scene.

use crate::{assert_error, check_sentence, good, load_path};
use softbox::io::ImportError;
use std::path::Path;

#[test]
fn what_is_no_file_is_named() {
    let folder = tempfile::TempDir::new().expect("a temporary folder");
    let error = |path: &Path| load_path(path).expect_err("not readable");
    check_sentence(&error(&folder.path().join("gone.dae")), "no such file");
    check_sentence(&error(folder.path()), "a folder");
    let null = Path::new("/dev/null");
    if null.exists() {
        check_sentence(&error(null), "a pipe or a device");
    }
    let picture = folder.path().join("picture.png");
    std::fs::write(&picture, b"\x89PNG\r\n").expect("a temporary file");
    check_sentence(&error(&picture), "a .png file");
    let below_a_file = picture.join("scene.dae");
    check_sentence(&error(&below_a_file), "no such file");
}

#[cfg(unix)]
#[test]
fn a_file_that_may_not_be_read_is_named() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::TempDir::new().expect("a temporary folder");
    let path = folder.path().join("secret.dae");
    std::fs::write(&path, good()).expect("a temporary file");
    std::fs::set_permissions(&path, PermissionsExt::from_mode(0o000)).expect("own file");
    if std::fs::read(&path).is_ok() {
        println!("skipped: this user may read everything");
        return;
    }
    let error = load_path(&path).expect_err("not readable");
    assert!(matches!(error, ImportError::NoPermission { .. }));
    check_sentence(&error, "permission");
}

#[test]
fn bytes_that_are_no_collada_are_named() {
    assert_error("0 bytes", b"", "empty");
    assert_error("blanks", b" \n\t \n", "empty");
    assert_error("text", b"hello world", "not <");
    assert_error("zip", b"PK\x03\x04....", "zip archive");
    assert_error("gltf", b"glTF\x02\0\0\0", "glTF");
    assert_error("zeros", &[0; 1000], "not <");
    assert_error("noise", &[0xFF, 0xFE, 0xFD, 0xFC, 0x00, 0x80], "not <");
    assert_error(
        "svg",
        b"<?xml version='1.0'?>\n<svg><g/></svg>",
        "line 2: the outermost element is <svg>",
    );
    assert_error("html", b"<html><body><p>404<br></body></html>", "line 1");
    assert_error("only a declaration", b"<?xml version='1.0'?>", "line 1");
    assert_error("utf-16 cut off", &[0xFF, 0xFE, b'<', 0, b'C'], "line 1");
}
