use std::path::Path;

use eframe::egui::Key;
use softbox::color::Rgb;
use softbox::image::{Image, score};
use softbox::io::picture::{Metadata, write_linear};
use softbox::session::Snapshot;
use tempfile::TempDir;

use super::files::drop_file;
use super::*;
use crate::viewer::provenance;

fn open_section(harness: &mut Harness<'_, App>) {
    harness.get_by_label("Error curve").click();
    harness.run_steps(3);
}

fn endless() -> ViewerOptions {
    let mut options = small_options();
    options.settings.as_mut().expect("small ones").stop = StopRule::default();
    options
}

fn shown(harness: &Harness<'_, App>) -> Arc<Snapshot> {
    let frame = harness.state().view.viewport.frame();
    Arc::clone(&frame.expect("a picture").snapshot)
}

fn points(app: &App) -> usize {
    app.view.error.points().len()
}

/// A picture that is brighter than the shown one, made as `metadata` says.
fn write_reference(path: &Path, snapshot: &Snapshot, metadata: &Metadata) -> Vec<Rgb> {
    let pixels: Vec<Rgb> = snapshot.pixels.iter().map(|p| *p * 1.25 + 0.01).collect();
    write_linear(path, snapshot.width, snapshot.height, &pixels, metadata).unwrap();
    pixels
}

fn compare_with(harness: &mut Harness<'_, App>, path: &Path) {
    harness.state_mut().view.error.path = path.display().to_string();
    harness.run_steps(2);
    harness.get_by_label("Compare").click();
    harness.run_steps(2);
}

#[test]
fn the_estimate_grows_while_rendering_and_begins_again_with_the_picture() {
    let mut harness = viewer_of(small_scene(), endless());
    wait(&mut harness, "samples", |app| {
        app.engine.status().samples_mean >= 4.0
    });
    assert_eq!(points(harness.state()), 0, "folded, nothing is noted");
    open_section(&mut harness);
    wait(&mut harness, "a slope", |app| {
        app.view.error.power_law().is_some()
    });
    // What was found is shown in the next frame.
    harness.step();
    harness.get_by_label("estimated from the spread of the samples");
    harness.get_by_label_contains("slope");
    let last = *harness.state().view.error.points().last().unwrap();
    let app = harness.state_mut();
    app.document.settings.seed += 1;
    wait(&mut harness, "the next picture", |app| {
        let first = app.view.error.points().first();
        first.is_some_and(|point| point.cpu_seconds < last.cpu_seconds)
    });
    harness.get_by_label("Error curve").click();
    wait(&mut harness, "it to be folded", |app| points(app) == 0);
}

#[test]
fn a_reference_is_read_and_its_relative_error_shown() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("reference.exr");
    let mut harness = viewer();
    wait_for_picture(&mut harness);
    let snapshot = shown(&harness);
    let pixels = write_reference(&path, &snapshot, &Metadata::default());
    open_section(&mut harness);
    compare_with(&mut harness, &path);
    wait(&mut harness, "the score", |app| {
        app.view.error.reference_name().is_some() && points(app) == 1
    });
    let size = (snapshot.width, snapshot.height);
    let image = |pixels| Image::from_pixels(size.0, size.1, pixels);
    let expected = score(&image(snapshot.pixels.clone()), &image(pixels)).unwrap();
    let point = harness.state().view.error.points()[0];
    assert_eq!(point.rel_mse, expected.rel_mse);
    assert_eq!(point.cpu_seconds, snapshot.cpu_seconds);
    harness.step();
    harness.get_by_label("against reference.exr");
    harness.get_by_label_contains("relMSE ");

    harness.get_by_label("Target").click();
    harness.run_steps(2);
    assert_eq!(harness.state().view.error.target, Some(1e-3));
    harness.get_by_label("Forget").click();
    harness.run_steps(3);
    harness.get_by_label("estimated from the spread of the samples");
}

#[test]
fn pictures_that_do_not_show_the_same_are_told_in_one_sentence() {
    let folder = TempDir::new().unwrap();
    let mut harness = viewer();
    wait_for_picture(&mut harness);
    let snapshot = shown(&harness);
    open_section(&mut harness);

    let smaller = folder.path().join("smaller.exr");
    let pixels = vec![Rgb::ONE; 6];
    write_linear(&smaller, 3, 2, &pixels, &Metadata::default()).unwrap();
    compare_with(&mut harness, &smaller);
    wait(&mut harness, "the sentence", |app| {
        app.view.error.misfit().is_some()
    });
    harness.step();
    harness.get_by_label_contains("smaller.exr has 3 x 2 pixels, the picture 64 x 48");
    assert_eq!(points(harness.state()), 0);

    // Its own metadata fit; those of another camera and depth do not.
    let metadata = provenance::metadata(&harness.state().document, &snapshot);
    let fitting = folder.path().join("fitting.exr");
    write_reference(&fitting, &snapshot, &metadata);
    compare_with(&mut harness, &fitting);
    wait(&mut harness, "the score", |app| points(app) == 1);
    harness.state_mut().document.settings.max_depth = softbox::settings::MaxDepth(2);
    wait(&mut harness, "the sentence", |app| {
        let misfit = app.view.error.misfit();
        misfit.is_some_and(|m| m == "fitting.exr has up to 5 bounces, the picture 2.")
    });
    harness.state_mut().document.settings.max_depth = softbox::settings::MaxDepth(5);
    harness.state_mut().document.camera.eye.x += 0.1;
    wait(&mut harness, "the sentence", |app| {
        let misfit = app.view.error.misfit();
        misfit == Some("fitting.exr was made with another camera.")
    });
}

#[test]
fn a_dropped_picture_opens_the_section_and_a_broken_one_is_told() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("dropped.exr");
    let mut harness = viewer();
    wait_for_picture(&mut harness);
    write_reference(&path, &shown(&harness), &Metadata::default());
    drop_file(&mut harness, &path);
    wait(&mut harness, "the score", |app| points(app) == 1);
    harness.get_by_label("against dropped.exr");

    let broken = folder.path().join("broken.exr");
    std::fs::write(&broken, "no picture").unwrap();
    compare_with(&mut harness, &broken);
    let is_told = |app: &App| app.view.error.reference_name() == Some("dropped.exr");
    wait(&mut harness, "the answer", is_told);
    let begin = Instant::now();
    while harness.query_by_label("That did not work").is_none() {
        assert!(begin.elapsed() < PATIENCE);
        harness.step();
    }
    harness.get_by_label_contains("broken.exr");
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    assert!(harness.query_by_label("That did not work").is_none());
}
