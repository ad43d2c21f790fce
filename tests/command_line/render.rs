//! `softbox render`: files, options and the JSON object.

use std::collections::BTreeSet;

use serde_json::Value;
use softbox::color::Rgb;
use softbox::io::picture::{Metadata, read_png, write_exr, write_hdr};
use softbox::math::Isa;
use softbox::settings::View;

use crate::{errors, folder_with, mean, names, pixels, run, softbox, status};

const SCENE: &str = "cornell-spheres";

/// The keys that scripts rely on.
const KEYS: [&str; 24] = [
    "scene",
    "width",
    "height",
    "spp_mean",
    "spp_max",
    "threads",
    "isa",
    "seed",
    "mode",
    "max_depth",
    "load_seconds",
    "build_seconds",
    "bvh_quality",
    "refine_seconds",
    "render_seconds",
    "cpu_seconds",
    "camera_rays",
    "closest_rays",
    "shadow_rays",
    "samples_per_second",
    "peak_memory_bytes",
    "invalid_samples",
    "estimated_relative_error",
    "skips",
];

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("one JSON object and nothing else")
}

#[test]
fn the_json_object_has_the_promised_keys_and_sane_values() {
    let folder = folder_with(&[SCENE]);
    let line = "render cornell-spheres.dae -o a.png -o a.exr --size 32x24 --spp 8 --seed 5 \
                --threads 2 --max-depth inf --mode importance --json";
    let report = json(&run(&folder, line));
    let keys: BTreeSet<&str> = report
        .as_object()
        .unwrap()
        .keys()
        .map(String::as_str)
        .collect();
    assert_eq!(keys, BTreeSet::from(KEYS));
    for (key, expected) in [
        ("scene", Value::from("cornell-spheres")),
        ("width", 32.into()),
        ("height", 24.into()),
        ("spp_mean", 8.0.into()),
        ("spp_max", 8.into()),
        ("threads", 2.into()),
        ("isa", Isa::best().name().into()),
        ("seed", 5.into()),
        ("mode", "importance".into()),
        ("max_depth", "inf".into()),
        ("camera_rays", (32 * 24 * 8).into()),
        ("bvh_quality", "high".into()),
        // A few spheres in a box are not worth it.
        ("refine_seconds", Value::Null),
        ("invalid_samples", 0.into()),
    ] {
        assert_eq!(report[key], expected, "{key}");
    }
    for key in [
        "load_seconds",
        "build_seconds",
        "render_seconds",
        "cpu_seconds",
    ] {
        let seconds = report[key].as_f64().unwrap();
        assert!(seconds > 0.0 && seconds < 600.0, "{key}: {seconds}");
    }
    let count = |key: &str| report[key].as_u64().unwrap();
    assert!(count("closest_rays") > count("camera_rays") && count("shadow_rays") > 0);
    assert!(report["samples_per_second"].as_f64().unwrap() > 0.0);
    if cfg!(target_os = "linux") {
        assert!(count("peak_memory_bytes") > 1 << 20);
    }
    let error = report["estimated_relative_error"].as_f64().unwrap();
    assert!(error > 0.0 && error < 10.0, "{error}");
    assert!(
        report["skips"]
            .as_object()
            .unwrap()
            .values()
            .all(Value::is_u64)
    );
    assert_eq!(names(&folder), ["a.exr", "a.png", "cornell-spheres.dae"]);
    // The same picture in both files: the PNG through the tone curve, which keeps order.
    assert_eq!(pixels(&folder, "a.exr").len(), 32 * 24);
    let shown = read_png(&folder.path().join("a.png")).unwrap();
    assert_eq!((shown.image.width(), shown.image.height()), (32, 24));
    assert!(
        shown
            .metadata
            .get(Metadata::COMMAND)
            .unwrap()
            .contains("--seed 5")
    );
}

#[test]
fn messages_go_to_standard_error_and_can_be_silenced() {
    let folder = folder_with(&[SCENE]);
    let base = [
        "render",
        "cornell-spheres.dae",
        "-o",
        "a.png",
        "--size",
        "8x6",
        "--spp",
        "1",
    ];
    let with = |more: &[&str]| softbox(folder.path(), &[&base[..], more].concat());
    let plain = with(&[]);
    assert!(plain.stdout.is_empty());
    assert_eq!(errors(&plain).lines().count(), 1, "{}", errors(&plain));
    assert!(errors(&plain).contains("1.0 samples per pixel"));
    let quiet = with(&["--quiet", "--json"]);
    assert_eq!(errors(&quiet), "");
    json(&String::from_utf8(quiet.stdout).unwrap());
    let verbose = with(&["--verbose"]);
    assert!(verbose.stdout.is_empty());
    assert!(errors(&verbose).starts_with("softbox render cornell-spheres.dae -o a.png"));
}

#[test]
fn every_format_holds_the_same_picture() {
    let folder = folder_with(&[SCENE]);
    run(
        &folder,
        "render cornell-spheres.dae -o a.exr -o a.pfm -o a.hdr --size 16x12 --spp 4",
    );
    let exr = pixels(&folder, "a.exr");
    assert_eq!(exr, pixels(&folder, "a.pfm"));
    for (x, y) in exr.iter().zip(pixels(&folder, "a.hdr")) {
        let largest = x.max_element().max(1e-6);
        assert!((*x - y).abs().max_element() <= largest / 100.0, "{x} {y}");
    }
}

#[test]
fn every_view_renders_and_shows_something_else() {
    let folder = folder_with(&[SCENE]);
    let mut seen: Vec<(Vec<Rgb>, View)> = Vec::new();
    for view in View::ALL {
        let name = view.name();
        run(
            &folder,
            &format!(
                "render {SCENE}.dae -o {name}.png -o {name}.exr --size 24x18 --spp 8 --view {name}"
            ),
        );
        let shown = read_png(&folder.path().join(format!("{name}.png"))).unwrap();
        assert_eq!(shown.metadata.get("view"), Some(name));
        let shown = shown.image.pixels().to_vec();
        let is_uniform = shown.windows(2).all(|pair| pair[0] == pair[1]);
        assert_eq!(is_uniform, view == View::Samples, "{name}");
        let twin = seen.iter().find(|(other, _)| *other == shown);
        // The box has no interpolated normals but on its spheres, which are exact.
        assert!(
            twin.is_none_or(|(_, other)| *other == View::Normals),
            "{name}"
        );
        seen.push((shown, view));
    }
    let depth = pixels(&folder, "depth.exr");
    assert!(depth.iter().all(|d| !d.is_nan() && d.x > 0.0));
    let albedo = pixels(&folder, "albedo.exr");
    assert!(
        albedo
            .iter()
            .all(|a| a.min_element() >= 0.0 && a.max_element() <= 1.0)
    );
}

#[test]
fn depths_add_light_and_single_bounces_add_up() {
    let folder = folder_with(&[SCENE]);
    let render = |name: &str, options: &str| {
        let fixed = "--size 24x18 --spp 32 --mode importance";
        run(
            &folder,
            &format!("render {SCENE}.dae -o {name}.exr {fixed} {options}"),
        );
        pixels(&folder, &format!("{name}.exr"))
    };
    let depths: Vec<Vec<Rgb>> = (0..3)
        .map(|m| render(&format!("m{m}"), &format!("--max-depth {m}")))
        .collect();
    assert!(mean(&depths[0]) > 0.0, "the lamp is in view");
    assert!(mean(&depths[1]) > 1.5 * mean(&depths[0]));
    assert!(mean(&depths[2]) > 1.1 * mean(&depths[1]));
    let only = |m| {
        render(
            &format!("o{m}"),
            &format!("--max-depth {m} --only-last-bounce"),
        )
    };
    let single: Vec<Vec<Rgb>> = (0..3).map(only).collect();
    for (i, whole) in depths[2].iter().enumerate() {
        let sum = single[0][i] + single[1][i] + single[2][i];
        assert!(
            (sum - *whole).abs().max_element() < 1e-4 * (1.0 + whole.max_element()),
            "{i}"
        );
    }
}

#[test]
fn renders_end_by_time_and_by_error() {
    let folder = folder_with(&[SCENE]);
    let by_time = run(
        &folder,
        "render cornell-spheres.dae -o a.png --size 16x12 --time-limit 0.2 --json",
    );
    let by_time = json(&by_time);
    assert!(by_time["spp_max"].as_u64().unwrap() > 0);
    assert!(by_time["render_seconds"].as_f64().unwrap() >= 0.19);
    let line = "render cornell-spheres.dae -o a.png --size 16x12 --json --target-error";
    let rough = json(&run(&folder, &format!("{line} 0.2")));
    let fine = json(&run(&folder, &format!("{line} 0.1")));
    let error = |report: &Value| report["estimated_relative_error"].as_f64().unwrap();
    assert!(error(&rough) <= 0.2 && error(&fine) <= 0.1);
    assert!(fine["spp_mean"].as_f64() > rough["spp_mean"].as_f64());
}

#[test]
fn a_region_holds_the_pixels_of_the_whole_picture() {
    let folder = folder_with(&[SCENE]);
    let line = "render cornell-spheres.dae --size 20x15 --spp 4";
    run(&folder, &format!("{line} -o whole.exr"));
    run(&folder, &format!("{line} -o part.exr --region 5,3,8,6"));
    let (whole, part) = (pixels(&folder, "whole.exr"), pixels(&folder, "part.exr"));
    assert_eq!(part.len(), 20 * 15);
    for (i, (a, b)) in whole.iter().zip(&part).enumerate() {
        let is_inside = (5..13).contains(&(i % 20)) && (3..9).contains(&(i / 20));
        assert_eq!(*b, if is_inside { *a } else { Rgb::ZERO }, "{i}");
    }
}

#[test]
fn an_environment_map_lights_the_scene() {
    let folder = folder_with(&["open-sky"]);
    let sky = |radiance: f32| vec![Rgb::splat(radiance); 32];
    let none = Metadata::default();
    write_exr(&folder.path().join("one.exr"), 8, 4, &sky(1.0), &none).unwrap();
    write_hdr(&folder.path().join("two.hdr"), 8, 4, &sky(2.0), &none).unwrap();
    for map in ["one.exr", "two.hdr"] {
        run(
            &folder,
            &format!("render open-sky.dae -o of-{map} --size 16x12 --spp 16 -e {map}"),
        );
    }
    let ratio = mean(&pixels(&folder, "of-two.hdr")) / mean(&pixels(&folder, "of-one.exr"));
    assert!((ratio - 2.0).abs() < 0.02, "{ratio}");
    let words = ["render", "open-sky.dae", "-o", "x.png", "-e", "missing.exr"];
    let output = softbox(folder.path(), &words);
    assert_eq!(status(&output), Some(3));
    assert!(
        errors(&output).contains("missing.exr"),
        "{}",
        errors(&output)
    );
}

#[test]
fn a_lens_blurs_and_a_lens_of_no_size_does_not() {
    let folder = folder_with(&[SCENE]);
    let line = "render cornell-spheres.dae --size 24x18 --spp 16";
    run(&folder, &format!("{line} -o pinhole.exr"));
    run(&folder, &format!("{line} -o closed.exr -b 0 -d 2"));
    run(&folder, &format!("{line} -o open.exr -b 0.4 -d 2"));
    let pinhole = pixels(&folder, "pinhole.exr");
    assert_eq!(pinhole, pixels(&folder, "closed.exr"));
    let open = pixels(&folder, "open.exr");
    assert_ne!(pinhole, open);
    assert!((mean(&open) / mean(&pinhole) - 1.0).abs() < 0.5);
}
