//! `softbox bench`: error against time.

use std::fs;

use serde_json::Value;
use softbox::io::picture::read_png;

use crate::{errors, folder_with, names, run, softbox, status};

/// Small and on one thread.
const QUICK: &str = "bench cornell-empty --size 24x18 --threads 1 --quiet";

fn measured(words: &str) -> Value {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let text = run(&folder, &format!("{QUICK} --json {words}"));
    let reports: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(reports.as_array().map(Vec::len), Some(1));
    reports[0].clone()
}

fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("no number: {value}"))
}

fn levels(method: &Value) -> Vec<Value> {
    method["levels"].as_array().expect("levels").clone()
}

#[test]
fn modes_are_measured_side_by_side_against_a_reference_of_its_own() {
    let report = measured("--spp 1..16 --compare best,hemisphere --max-depth 2");
    assert_eq!(
        (&report["width"], &report["max_depth"]),
        (&24.into(), &"2".into())
    );
    assert_eq!(report["is_complete"], true);
    let reference = &report["reference"];
    assert_eq!(reference["mode"], "importance");
    assert_eq!(reference["samples_per_pixel"], 256);
    assert!(number(&reference["rel_mse"]) > 0.0);
    assert!(number(&reference["agreement"]) > 1e-4);
    let methods = report["methods"].as_array().unwrap();
    assert_eq!(methods.len(), 2);
    for method in methods {
        let levels = levels(method);
        let samples: Vec<f64> = levels.iter().map(|l| number(&l["samples"])).collect();
        assert_eq!(samples, [1, 2, 4, 8, 16].map(|n| f64::from(24 * 18 * n)));
        for pair in levels.windows(2) {
            for figure in ["rel_mse", "rel_mse_trimmed", "mse"] {
                assert!(
                    number(&pair[1][figure]) < number(&pair[0][figure]),
                    "{pair:?}"
                );
            }
            for figure in ["cpu_seconds", "rays"] {
                assert!(
                    number(&pair[1][figure]) > number(&pair[0][figure]),
                    "{pair:?}"
                );
            }
        }
        let slope = number(&method["power_law"]["slope"]);
        assert!((-2.5..-0.4).contains(&slope), "{slope}");
        assert_eq!(method["seconds_to"].as_array().unwrap().len(), 3);
    }
    let best = &levels(&methods[0])[4];
    assert_eq!(best["seeds"], 5);
    let interval = &best["mean_ratio_interval"];
    assert!(number(&interval[0]) < number(&interval[1]));
    let expected = 1.0 / (number(&best["rel_mse"]) * number(&best["cpu_seconds"]));
    assert!((number(&best["efficiency"]) / expected - 1.0).abs() < 1e-9);
    let comparison = &report["comparisons"][0];
    assert_eq!(comparison["against"], "hemisphere");
    assert!(number(&comparison["ratio"]) > 2.0, "{comparison}");
    assert_eq!(comparison["outcome"], "better");
}

/// The picture of a bench is that of a render, and its score that of `compare`.
#[test]
fn a_given_reference_is_scored_as_compare_does() {
    let folder = folder_with(&["cornell-empty"]);
    let size = "--size 24x18 --quiet";
    let scene = "cornell-empty.dae";
    run(
        &folder,
        &format!("render {scene} -o r.exr --spp 64 --seed 9 {size}"),
    );
    run(
        &folder,
        &format!("render {scene} -o a.exr --spp 4 --seed 3 {size}"),
    );
    let compared: Value =
        serde_json::from_str(&run(&folder, "compare a.exr r.exr --json")).unwrap();
    let words = "--reference r.exr --spp 1,4 --seeds 1 --seed 3 --json";
    let text = run(&folder, &format!("bench {scene} {words} {size}"));
    let report: Value = serde_json::from_str(&text).unwrap();
    let level = &levels(&report[0]["methods"][0])[1];
    for figure in ["rel_mse", "rel_mse_trimmed", "mse"] {
        let (got, expected) = (number(&level[figure]), number(&compared[figure]));
        assert!(
            (got / expected - 1.0).abs() < 1e-9,
            "{figure}: {got} {expected}"
        );
    }
    assert_eq!(level["efficiency_interval"], Value::Null);

    // Its known noise is taken off.
    let words = "--reference-noise 0.001 --reference r.exr --spp 4 --seeds 1 --seed 3 --json";
    let text = run(&folder, &format!("bench {scene} {words} {size}"));
    let report: Value = serde_json::from_str(&text).unwrap();
    let net = number(&levels(&report[0]["methods"][0])[0]["rel_mse"]);
    assert!((number(&level["rel_mse"]) - net - 0.001).abs() < 1e-9);
}

#[test]
fn people_get_a_table_a_picture_and_a_line_whose_command_works() {
    let folder = tempfile::tempdir().unwrap();
    let line = format!("{QUICK} --spp 1,4 --seeds 2 --append results --plot curves.png");
    let text = run(&folder, &line);
    for part in [
        "cornell-empty: 24x18",
        "reference: importance, 64 samples",
        "its halves agree",
        "relMSE",
        "slope",
        "1e-3 in ",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let plot = read_png(&folder.path().join("curves.png")).unwrap();
    assert_eq!((plot.image.width(), plot.image.height()), (1200, 840));
    run(
        &folder,
        &format!("{QUICK} --spp 2 --seeds 2 --append results"),
    );
    let results = fs::read_to_string(folder.path().join("results")).unwrap();
    let rows: Vec<&str> = results.lines().collect();
    assert_eq!(rows.len(), 3, "{results}");
    assert!(rows[0].starts_with("# scene"), "{results}");
    assert_eq!(names(&folder), ["curves.png", "results"]);

    let (figures, command) = rows[1].split_once("  softbox ").unwrap();
    let again: Value = serde_json::from_str(&run(&folder, &format!("{command} --json"))).unwrap();
    let rel_mse = number(&levels(&again[0]["methods"][0])[1]["rel_mse"]);
    assert!(
        figures.contains(&format!(" {rel_mse:.3e} ")),
        "{figures}: {rel_mse:.3e}"
    );
}

#[test]
fn a_time_limit_ends_what_would_take_days() {
    let report = measured("--spp 1..2147483648 --time-limit 0.5 --seeds 2");
    let reached = levels(&report["methods"][0]);
    assert!((1..30).contains(&reached.len()), "{}", reached.len());
    let samples = number(&report["reference"]["samples_per_pixel"]);
    assert!((2.0..1e8).contains(&samples), "{samples}");
    assert_eq!(report["is_complete"], true);
}

#[test]
fn what_cannot_work_is_told_in_one_sentence_and_leaves_nothing_behind() {
    let folder = folder_with(&["cornell-empty"]);
    fs::write(folder.path().join("text.exr"), "no picture").unwrap();
    let size = "--size 8x6 --spp 1 --seeds 1 --quiet";
    run(
        &folder,
        &format!(
            "render cornell-empty -o small.exr --spp 1 {}",
            "--size 8x6 --quiet"
        ),
    );
    let before = names(&folder);
    for (words, expected, reason) in [
        ("bench missing.dae", 3, "missing.dae"),
        ("bench no-such-scene", 3, "cornell-empty"),
        ("bench cornell-empty --reference gone.exr", 1, "gone.exr"),
        ("bench cornell-empty --reference text.exr", 1, "text.exr"),
        (
            "bench cornell-empty --reference small.exr --size 9x6",
            1,
            "8x6",
        ),
        ("bench cornell-empty --plot a.jpg", 4, "a.jpg"),
        ("bench cornell-empty --plot gone/a.png", 4, "gone"),
        (
            "bench cornell-empty --append gone/results",
            4,
            "gone/results",
        ),
        (
            "bench cornell-empty --eye 0,0,0 --target 0,0,0",
            2,
            "camera",
        ),
    ] {
        let line = if words.contains("--size") {
            format!("{words} --spp 1 --seeds 1 --quiet")
        } else {
            format!("{words} {size}")
        };
        let words: Vec<&str> = line.split_whitespace().collect();
        let output = softbox(folder.path(), &words);
        assert_eq!(
            status(&output),
            Some(expected),
            "{line}: {}",
            errors(&output)
        );
        let told = errors(&output);
        assert!(
            told.starts_with("softbox: ") && told.contains(reason),
            "{told}"
        );
        assert_eq!(told.lines().count(), 1, "{told}");
        assert!(output.stdout.is_empty());
        assert_eq!(names(&folder), before, "{line}");
    }
}

#[cfg(unix)]
#[test]
fn an_interrupt_tells_what_there_is() {
    use std::io::{BufRead, BufReader, Read};
    use std::process::{Command, Stdio};

    use rustix::process::{Pid, Signal, kill_process};
    let mut child = Command::new(env!("CARGO_BIN_EXE_softbox"))
        .args("bench cornell-empty --size 16x12 --seeds 1 --spp 1,2,1000000000".split(' '))
        .args("--reference-spp 8 --json --verbose".split(' '))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut messages = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.contains(" of 1000000000 samples") {
        line.clear();
        let length = messages.read_line(&mut line).unwrap();
        assert!(length > 0, "it ended by itself");
    }
    kill_process(Pid::from_child(&child), Signal::INT).unwrap();
    let mut rest = String::new();
    messages.read_to_string(&mut rest).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(status(&output), Some(130), "{rest}");
    assert!(rest.contains("Interrupted"), "{rest}");
    let reports: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(reports[0]["is_complete"], false);
    assert!(!levels(&reports[0]["methods"][0]).is_empty());
}
