//! `softbox compare`.

use std::fs;
use std::path::Path;

use softbox::color::Rgb;
use softbox::io::picture::{Metadata, write_exr, write_hdr, write_pfm, write_png};

use crate::{errors, softbox, status};

/// `a.exr` is grey 0.5, `b.pfm` the same but for one channel of one of its 32 × 32 pixels.
fn two_pictures(folder: &Path) {
    let mut pixels = vec![Rgb::splat(0.5); 1024];
    write_exr(&folder.join("a.exr"), 32, 32, &pixels, &Metadata::default()).expect("writable");
    pixels[100].x = 1.5;
    write_pfm(&folder.join("b.pfm"), 32, 32, &pixels).expect("writable");
}

#[test]
fn compare_prints_figures_as_json() {
    let folder = tempfile::tempdir().unwrap();
    two_pictures(folder.path());
    let output = softbox(folder.path(), &["compare", "b.pfm", "a.exr", "--json"]);
    assert_eq!((status(&output), errors(&output).as_str()), (Some(0), ""));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let number = |key: &str| report[key].as_f64().unwrap();
    let expected = 1.0 / 0.26 / 3.0 / 1024.0;
    assert!((number("rel_mse") - expected).abs() < 1e-9);
    assert_eq!(number("rel_mse_trimmed"), 0.0);
    assert!((number("mse") - 1.0 / 3072.0).abs() < 1e-12);
    assert!((report["mean_difference"][0].as_f64().unwrap() - 1.0 / 1024.0).abs() < 1e-12);
    assert_eq!(report["mean_difference"][1], 0.0);
    assert!((number("max_block_difference") - (1.0 / 64.0) / 0.501).abs() < 1e-9);
    assert!(number("flip") > 0.0 && number("flip") < 0.1);
    assert_eq!((number("width"), number("invalid_pixels")), (32.0, 0.0));
    assert_eq!(report["reference"], "a.exr");
}

#[test]
fn compare_prints_figures_for_people() {
    let folder = tempfile::tempdir().unwrap();
    two_pictures(folder.path());
    let output = softbox(folder.path(), &["compare", "a.exr", "a.exr"]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.starts_with("a.exr against a.exr\n"), "{text}");
    assert!(text.contains("relMSE            0.000000e0\n"), "{text}");
    assert!(!text.contains("not finite"), "{text}");
}

#[test]
fn pictures_that_cannot_be_compared_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    two_pictures(folder.path());
    let at = |name: &str| folder.path().join(name);
    write_png(&at("c.png"), 1, 1, &[[1, 2, 3]], &Metadata::default()).unwrap();
    write_hdr(&at("d.hdr"), 1, 1, &[Rgb::ONE], &Metadata::default()).unwrap();
    fs::write(at("e.exr"), "no picture").unwrap();
    for (name, reason) in [
        ("c.png", "not linear data"),
        ("d.hdr", "1 × 1 pixels"),
        ("e.exr", "it is not an OpenEXR"),
        ("missing.exr", "missing.exr"),
    ] {
        let output = softbox(folder.path(), &["compare", name, "a.exr"]);
        assert_eq!(status(&output), Some(1), "{name}");
        assert!(errors(&output).contains(reason), "{}", errors(&output));
        assert_eq!(errors(&output).lines().count(), 1, "{}", errors(&output));
        assert!(output.stdout.is_empty());
    }
}
