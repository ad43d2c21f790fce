//! `--isa` and `SOFTBOX_ISA`: they choose the code, never the picture.

use std::process::{Command, Output};

use serde_json::Value;
use softbox::io::picture::{Metadata, read_picture};
use softbox::math::Isa;
use tempfile::TempDir;

use crate::same_bits::bits;
use crate::{errors, folder_with, names, run, status};

/// Runs a line of words with a value of the variable.
fn softbox_with(folder: &TempDir, variable: &str, line: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_softbox"))
        .args(line.split_whitespace())
        .current_dir(folder.path())
        .env("SOFTBOX_ISA", variable)
        .output()
        .expect("the program was built with this test")
}

/// What `--json` says was used.
fn used(output: &Output) -> String {
    assert_eq!(status(output), Some(0), "{}", errors(output));
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let report = report.get(0).unwrap_or(&report);
    report["isa"].as_str().expect("a name").to_owned()
}

#[test]
fn every_instruction_set_gives_the_same_picture() {
    let folder = folder_with(&["cornell-microfacet", "cornell-spheres"]);
    for scene in ["cornell-microfacet", "cornell-spheres"] {
        let line = format!("render {scene}.dae --size 40x30 --spp 6 --max-depth inf --seed 4");
        for isa in Isa::available() {
            run(&folder, &format!("{line} -o {isa}.exr --isa {isa}"));
            let metadata = read_picture(&folder.path().join(format!("{isa}.exr")))
                .expect("a picture")
                .metadata;
            assert_eq!(metadata.get("isa"), Some(isa.name()));
            let command = metadata.get(Metadata::COMMAND).expect("a command");
            assert!(command.contains(&format!("--isa {isa}")), "{command}");
        }
        run(&folder, &format!("{line} -o best.exr"));
        let best = bits(&folder, "best.exr");
        for isa in Isa::available() {
            assert!(
                best == bits(&folder, &format!("{isa}.exr")),
                "{scene} {isa}"
            );
        }
    }
}

#[test]
fn the_option_wins_over_the_variable_and_the_variable_over_the_best() {
    let folder = folder_with(&["cornell-spheres"]);
    let render = "render cornell-spheres.dae -o a.exr --size 8x6 --spp 1 --json";
    let course = "-f a.png -r 8 6 -s 1 --json cornell-spheres.dae";
    let bench = "bench --rays --rounds 1 --builds 1 --size 8x8 --kinds primary --json box36";
    let best = Isa::best().name();
    for line in [render, course, bench] {
        assert_eq!(used(&softbox_with(&folder, "", line)), best);
        assert_eq!(used(&softbox_with(&folder, "portable", line)), "portable");
        let forced = format!("{line} --isa {best}");
        assert_eq!(used(&softbox_with(&folder, "portable", &forced)), best);
    }
}

#[test]
fn an_instruction_set_that_is_not_there_ends_with_status_2_before_anything_is_read() {
    let folder = folder_with(&[]);
    for line in [
        "render none.dae -o a.png",
        "-f a.png none.dae",
        "none.dae",
        "bench --rays none",
    ] {
        let by_variable = softbox_with(&folder, "mmx", line);
        let by_option = softbox_with(&folder, "", &format!("{line} --isa mmx"));
        for (output, place) in [(by_variable, "SOFTBOX_ISA"), (by_option, "--isa")] {
            let text = errors(&output);
            assert_eq!(status(&output), Some(2), "{line}: {text}");
            let first = text.lines().next().expect("a sentence");
            assert!(first.contains(place), "{text}");
            assert!(first.contains("no instruction set 'mmx'"), "{text}");
            assert!(output.stdout.is_empty(), "{line}");
        }
    }
    assert!(names(&folder).is_empty());
    // Nothing is traced, so nothing is chosen.
    let output = softbox_with(&folder, "mmx", "compare none.exr none.exr");
    assert_ne!(status(&output), Some(2));
}
