//! How a run ends, and what it leaves behind.

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use crate::{errors, folder_with, names, pixels, softbox, status};

const SCENE: &str = "cornell-spheres";

/// A render that would take days, so that only an early end passes.
const ENDLESS: [&str; 6] = [
    "render",
    "cornell-spheres.dae",
    "--spp",
    "1000000",
    "--size",
    "1600x1200",
];

#[test]
fn outputs_that_cannot_be_written_are_found_before_rendering() {
    let folder = folder_with(&[SCENE]);
    let read_only = folder.path().join("old.png");
    fs::write(&read_only, "old").unwrap();
    let mut permissions = fs::metadata(&read_only).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&read_only, permissions).unwrap();
    for output_name in ["old.png", "missing/a.png", "a.gif", "."] {
        let output = softbox(
            folder.path(),
            &[&ENDLESS[..], &["-o", output_name]].concat(),
        );
        assert_eq!(status(&output), Some(4), "{output_name}");
        let text = errors(&output);
        assert!(
            text.starts_with("softbox: ") && text.lines().count() == 1,
            "{text}"
        );
        assert!(output.stdout.is_empty());
        let rate = [
            &ENDLESS[..],
            &["-o", "b.png", "--rate-picture", output_name],
        ]
        .concat();
        assert_eq!(
            status(&softbox(folder.path(), &rate)),
            Some(4),
            "{output_name}"
        );
    }
    assert_eq!(fs::read(&read_only).unwrap(), b"old");
    assert_eq!(names(&folder), ["cornell-spheres.dae", "old.png"]);
}

#[test]
fn a_camera_file_that_cannot_be_read_is_told_once() {
    let folder = folder_with(&[SCENE]);
    let output = softbox(
        folder.path(),
        &[&ENDLESS[..], &["-o", "a.png", "-c", "gone.txt"]].concat(),
    );
    assert_eq!(status(&output), Some(1));
    let text = errors(&output);
    assert!(
        text.starts_with("softbox: Cannot read the camera file 'gone.txt'"),
        "{text}"
    );
    assert_eq!(
        (text.matches("os error").count(), text.lines().count()),
        (1, 1),
        "{text}"
    );
    assert_eq!(names(&folder), ["cornell-spheres.dae"]);
}

/// A second name of the old file still shows the old bytes, so the file was not written in place.
#[test]
fn an_existing_picture_is_replaced_as_a_whole() {
    let folder = folder_with(&[SCENE]);
    let (old, second_name) = (folder.path().join("a.exr"), folder.path().join("kept"));
    fs::write(&old, "old").unwrap();
    fs::hard_link(&old, &second_name).unwrap();
    let broken = softbox(folder.path(), &["render", "kept", "-o", "a.exr"]);
    assert_eq!(status(&broken), Some(3));
    assert_eq!(fs::read(&old).unwrap(), b"old");
    crate::run(
        &folder,
        "render cornell-spheres.dae -o a.exr --size 8x6 --spp 1",
    );
    assert_eq!(pixels(&folder, "a.exr").len(), 48);
    assert_eq!(fs::read(&second_name).unwrap(), b"old");
    assert_eq!(names(&folder), ["a.exr", "cornell-spheres.dae", "kept"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_is_a_failure() {
    let folder = folder_with(&[SCENE]);
    for words in [
        &[
            "render",
            "cornell-spheres.dae",
            "-o",
            "a.png",
            "--size",
            "8x6",
            "--spp",
            "1",
            "--json",
        ][..],
        &["info", "cornell-spheres.dae"],
    ] {
        let full = fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_softbox"))
            .args(words)
            .current_dir(folder.path())
            .stdout(full)
            .output()
            .unwrap();
        assert_eq!(status(&output), Some(1));
        assert!(
            errors(&output).contains("standard output"),
            "{}",
            errors(&output)
        );
    }
}

#[cfg(unix)]
#[test]
fn an_interrupt_writes_what_there_is() {
    use rustix::process::{Pid, Signal, kill_process};
    let folder = folder_with(&[SCENE]);
    let mut child = Command::new(env!("CARGO_BIN_EXE_softbox"))
        .args([
            "render",
            "cornell-spheres.dae",
            "-o",
            "a.exr",
            "-o",
            "a.png",
            "--json",
            "--verbose",
        ])
        .args(["--size", "32x24", "--spp", "1000000000"])
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut messages = BufReader::new(child.stderr.take().unwrap());
    // The first line of progress comes when it renders.
    let mut line = String::new();
    while !line.contains(" of 1000000000 samples") {
        line.clear();
        assert!(
            messages.read_line(&mut line).unwrap() > 0,
            "it ended by itself"
        );
    }
    sleep(Duration::from_millis(300));
    kill_process(Pid::from_child(&child), Signal::INT).unwrap();
    let mut rest = String::new();
    messages.read_to_string(&mut rest).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(status(&output), Some(130), "{rest}");
    assert!(rest.contains("Interrupted"), "{rest}");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(report["spp_mean"].as_f64().unwrap() >= 1.0);
    assert!(crate::mean(&pixels(&folder, "a.exr")) > 0.0);
    assert_eq!(names(&folder), ["a.exr", "a.png", "cornell-spheres.dae"]);
}
