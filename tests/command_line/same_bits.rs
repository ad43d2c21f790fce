//! A picture is the same bits however it is made.

use std::env;
use std::fs;
use std::path::Path;
use std::process::Command;

use softbox::io::picture::{Metadata, read_picture};
use tempfile::TempDir;

use crate::{folder_with, run, softbox, status};

pub(crate) fn bits(folder: &TempDir, name: &str) -> Vec<[u32; 3]> {
    let pixels = crate::pixels(folder, name);
    pixels
        .iter()
        .map(|p| p.to_array().map(f32::to_bits))
        .collect()
}

#[test]
fn threads_change_no_bit_and_seeds_do() {
    let folder = folder_with(&["cornell-microfacet"]);
    let line = "render cornell-microfacet.dae --size 40x30 --spp 7 --max-depth inf";
    for threads in 1..=3 {
        run(
            &folder,
            &format!("{line} -o t{threads}.exr --seed 9 --threads {threads}"),
        );
    }
    let one = bits(&folder, "t1.exr");
    assert!(one == bits(&folder, "t2.exr") && one == bits(&folder, "t3.exr"));
    run(&folder, &format!("{line} -o other.exr --seed 10"));
    assert!(one != bits(&folder, "other.exr"));
    run(
        &folder,
        &format!("{line} -o reference.exr --seed 9 --integrator reference"),
    );
    assert!(one == bits(&folder, "reference.exr"));
}

/// Runs the command that a picture carries in a shell and compares what it writes.
#[cfg(unix)]
fn assert_reproduces(folder: &TempDir, name: &str) {
    let path = folder.path().join(name);
    let picture = read_picture(&path).expect("a picture");
    let command = picture.metadata.get(Metadata::COMMAND).expect("a command");
    let first = bits(folder, name);
    fs::remove_file(&path).expect("own file");
    let program = Path::new(env!("CARGO_BIN_EXE_softbox"))
        .parent()
        .expect("in a folder");
    let inherited = env::var_os("PATH").unwrap_or_default();
    let search = [program.to_owned()]
        .into_iter()
        .chain(env::split_paths(&inherited));
    let ended = Command::new("sh")
        .args(["-c", command])
        .env("PATH", env::join_paths(search).expect("plain folders"))
        .current_dir(folder.path())
        .output()
        .expect("a shell");
    assert!(ended.status.success(), "{command}");
    assert!(first == bits(folder, name), "{command}");
}

#[cfg(unix)]
#[test]
fn the_command_in_a_picture_renders_it_again() {
    let folder = folder_with(&["cornell-spheres"]);
    let scene = "it's my scene.dae";
    fs::rename(
        folder.path().join("cornell-spheres.dae"),
        folder.path().join(scene),
    )
    .unwrap();
    for options in [
        "--spp 5 --seed 3 --mode importance --light-samples 2 --max-depth 3",
        "--spp 6 --eye 0.3,0.8,3 --target 0,0.7,-1 --xfov 41.5 -b 0.05 -d 3.5 --region 2,3,9,7",
        "--spp 64 --adaptive 16,0.2 --mode hemisphere --bvh median",
        "--spp 100 --adaptive 32,0.1 --adaptive-goal even --exposure 1",
        "--spp 70 --adaptive 32,0.1 --adaptive-goal least-error",
        "--spp 64 --adaptive 16,0.2 --adaptive-rule course",
        "--target-error 0.2 --adaptive 64,0.05",
        "--spp 4 --bvh-quality fast --leaf-size 2",
        "--spp 3 --course-compatible --exposure -1 --view render --only-last-bounce",
        "--time-limit 0.2 --max-depth 2",
        "--target-error 0.4 --max-depth 1",
        "--view depth --tone-curve filmic --crop-view --yfov 30",
    ] {
        let mut words = vec![
            "render",
            scene,
            "-o",
            "./-a b.exr",
            "--size",
            "24x18",
            "--threads",
            "2",
        ];
        words.extend(options.split_whitespace());
        let output = softbox(folder.path(), &words);
        assert_eq!(
            status(&output),
            Some(0),
            "{options}: {}",
            crate::errors(&output)
        );
        assert_reproduces(&folder, "-a b.exr");
    }
    let course = [
        "-s", "9", "-l", "3", "-H", "-m", "2", "-r", "30", "20", "-f", "c.exr", scene,
    ];
    assert_eq!(status(&softbox(folder.path(), &course)), Some(0));
    assert_reproduces(&folder, "c.exr");
}
