//! The window where there can be none.
#![cfg(all(target_os = "linux", feature = "viewer"))]

use std::process::Command;

#[test]
fn without_a_display_one_sentence_names_the_way_without_a_window() {
    let output = Command::new(env!("CARGO_BIN_EXE_softbox"))
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(output.stdout.is_empty());
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(message.lines().count(), 1, "{message}");
    assert!(
        message.contains("softbox render SCENE -o OUT.png"),
        "{message}"
    );
    assert!(!message.contains(".rs"), "{message}");
}
