//! Drives the program itself: streams, exit statuses, files.

mod bench;
mod bench_rays;
#[path = "../collada_text/mod.rs"]
mod collada_text;
mod compare;
mod course;
mod describe;
mod ending;
mod faulty;
mod instruction_sets;
mod render;
mod same_bits;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use softbox::color::Rgb;
use softbox::io::picture::read_picture;
use tempfile::TempDir;

fn softbox(folder: &Path, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_softbox"))
        .args(words)
        .current_dir(folder)
        .output()
        .expect("the program was built with this test")
}

fn status(output: &Output) -> Option<i32> {
    output.status.code()
}

fn errors(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Runs a line of words without blanks that has to succeed; gives its standard output.
fn run(folder: &TempDir, line: &str) -> String {
    let words: Vec<&str> = line.split_whitespace().collect();
    let output = softbox(folder.path(), &words);
    assert_eq!(status(&output), Some(0), "{line}: {}", errors(&output));
    String::from_utf8(output.stdout).expect("text")
}

/// A folder of its own with some scenes of `assets/`.
fn folder_with(scenes: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for scene in scenes {
        let name = format!("{scene}.dae");
        let asset = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("assets")
            .join(&name);
        fs::copy(asset, folder.path().join(name)).expect("an asset");
    }
    folder
}

/// The linear pixels of a picture, row by row from the top.
fn pixels(folder: &TempDir, name: &str) -> Vec<Rgb> {
    let picture = read_picture(&folder.path().join(name)).expect("a picture");
    picture.image.pixels().to_vec()
}

fn mean(pixels: &[Rgb]) -> f32 {
    pixels.iter().map(|p| p.element_sum()).sum::<f32>() / (3 * pixels.len()) as f32
}

/// Names in the folder, sorted.
fn names(folder: &TempDir) -> Vec<String> {
    let entries = fs::read_dir(folder.path()).expect("a folder");
    let mut names: Vec<String> = entries
        .map(|e| {
            e.expect("readable")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    names.sort();
    names
}

#[test]
fn wrong_usage_ends_with_status_2_and_help_with_0() {
    let folder = tempfile::tempdir().unwrap();
    for words in [
        &["render", "x.dae"][..],
        &["render", "x.dae", "-o", "a.png", "--no-such-option"],
        &["render", "x.dae", "-o", "a.png", "--max-depth", "-1"],
        &["compare", "a.exr"],
        &["bench", "cornell-empty", "--spp", "4..1"],
        &["bench", "cornell-empty", "--view", "depth"],
        &["bench", "--rays", "--rounds", "0", "box36"],
        &["-f", "a.png"],
        &["-f", "a.png", "-r", "480", "x.dae"],
    ] {
        let output = softbox(folder.path(), words);
        assert_eq!(status(&output), Some(2), "{words:?}");
        assert!(
            output.stdout.is_empty() && errors(&output).starts_with("error:"),
            "{words:?}"
        );
    }
    for words in [
        &["--help"][..],
        &["-h"],
        &["render", "--help"],
        &["bench", "--help"],
        &["bench", "--rays", "--help"],
        &["--version"],
    ] {
        let output = softbox(folder.path(), words);
        assert_eq!(status(&output), Some(0), "{words:?}");
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(
            output.stderr.is_empty() && text.contains("softbox"),
            "{text}"
        );
    }
}

#[test]
fn unreadable_scenes_end_with_status_3() {
    let folder = tempfile::tempdir().unwrap();
    for words in [
        &["render", "missing.dae", "-o", "a.png"][..],
        &["-f", "a.png", "missing.dae"],
        &["render", ".", "-o", "a.png"],
        &["info", "missing.dae"],
    ] {
        let output = softbox(folder.path(), words);
        assert_eq!(status(&output), Some(3), "{words:?}");
        assert!(
            errors(&output).starts_with("softbox: ") && errors(&output).ends_with(".\n"),
            "{}",
            errors(&output)
        );
        assert_eq!(errors(&output).lines().count(), 1, "{}", errors(&output));
        assert!(output.stdout.is_empty());
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn unwritable_outputs_end_with_status_4_before_anything_else() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("x.dae"), "").unwrap();
    fs::create_dir(folder.path().join("folder.png")).unwrap();
    for output_name in ["missing/a.png", "folder.png", "a.jpg", "a"] {
        let words = ["render", "x.dae", "-o", "good.png", "-o", output_name];
        let output = softbox(folder.path(), &words);
        assert_eq!(status(&output), Some(4), "{output_name}");
        assert!(
            errors(&output).contains("Cannot write"),
            "{}",
            errors(&output)
        );
        let output = softbox(folder.path(), &["-f", output_name, "x.dae"]);
        assert_eq!(status(&output), Some(4), "{output_name}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}
