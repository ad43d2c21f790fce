use eframe::egui::{Key, Modifiers};
use softbox::settings::{MaxDepth, Mode, View};

use super::*;
use crate::viewer::command::{Command, KeyPreset};
use crate::viewer::keys::bindings;

fn press(harness: &mut Harness<'_, App>, key: Key) {
    harness.key_press(key);
    harness.run_steps(2);
}

#[test]
fn the_keys_of_the_course_change_the_settings() {
    let mut harness = viewer();
    for key in [
        Key::Plus,
        Key::Equals,
        Key::CloseBracket,
        Key::Period,
        Key::H,
    ] {
        press(&mut harness, key);
    }
    let settings = &harness.state().document.settings;
    assert_eq!(settings.light_samples, 4);
    assert_eq!(settings.stop.samples_per_pixel, Some(4));
    assert_eq!(settings.max_depth, MaxDepth(6));
    assert_eq!(settings.mode, Mode::Hemisphere);
    for key in [
        Key::Minus,
        Key::OpenBracket,
        Key::Comma,
        Key::H,
        Key::L,
        Key::L,
        Key::K,
    ] {
        press(&mut harness, key);
    }
    let document = &harness.state().document;
    assert_eq!(document.settings.light_samples, 2);
    assert_eq!(document.settings.stop.samples_per_pixel, Some(2));
    assert_eq!(document.settings.max_depth, MaxDepth(5));
    assert_eq!(document.settings.mode, Mode::Best);
    assert!(document.camera.lens_radius > 0.0);
    press(&mut harness, Key::K);
    assert_eq!(harness.state().document.camera.lens_radius, 0.0);
}

#[test]
fn space_pauses_or_resets_as_the_preset_says() {
    let mut harness = viewer();
    press(&mut harness, Key::Space);
    assert!(harness.state().engine.is_paused());
    press(&mut harness, Key::P);
    assert!(!harness.state().engine.is_paused());

    let options = ViewerOptions {
        keys: Some(KeyPreset::Cs184),
        ..small_options()
    };
    let mut harness = viewer_of(small_scene(), options);
    harness.step();
    let start = harness.state().document.camera;
    harness.state_mut().document.camera.eye.x += 1.0;
    press(&mut harness, Key::Space);
    assert!(!harness.state().engine.is_paused());
    assert_eq!(harness.state().document.camera, start);
}

#[test]
fn numbers_choose_the_view_and_r_goes_back_to_the_picture() {
    let mut harness = viewer();
    press(&mut harness, Key::Num5);
    assert_eq!(harness.state().document.settings.view, View::Depth);
    press(&mut harness, Key::R);
    assert_eq!(harness.state().document.settings.view, View::Render);
}

#[test]
fn escape_ends_one_thing_at_a_time_and_never_the_program() {
    let mut harness = viewer();
    press(&mut harness, Key::F1);
    press(&mut harness, Key::V);
    assert!(harness.state().windows.shows_keys && harness.state().view.bvh.is_on);
    press(&mut harness, Key::Escape);
    assert!(!harness.state().windows.shows_keys && harness.state().view.bvh.is_on);
    press(&mut harness, Key::Escape);
    assert!(!harness.state().view.bvh.is_on);
    press(&mut harness, Key::Escape);
    harness.get_by_role_and_label(Role::Image, "Render view");
}

#[test]
fn typing_into_a_number_is_not_a_command() {
    let mut harness = viewer();
    harness
        .get_by_role_and_label(Role::SpinButton, "Seed")
        .click();
    harness.run_steps(2);
    press(&mut harness, Key::H);
    assert_eq!(harness.state().document.settings.mode, Mode::Best);
}

#[test]
fn the_camera_is_undone_and_redone() {
    let mut harness = viewer();
    harness.run_steps(3);
    let start = harness.state().document.camera;
    let from = middle(&harness);
    drag(&mut harness, from, from + Vec2::new(80.0, 10.0));
    let moved = harness.state().document.camera;
    assert_ne!(moved, start);
    let ctrl = |harness: &mut Harness<'_, App>, key| {
        harness.key_press_modifiers(Modifiers::COMMAND, key);
        harness.run_steps(2);
    };
    ctrl(&mut harness, Key::Z);
    assert_eq!(harness.state().document.camera, start);
    ctrl(&mut harness, Key::Y);
    assert_eq!(harness.state().document.camera, moved);
}

#[test]
fn the_walk_through_the_boxes_follows_the_arrows() {
    let mut harness = viewer();
    wait_for_picture(&mut harness);
    let text = |harness: &Harness<'_, App>| {
        let facts = harness.state().view.bvh.facts();
        facts.map(|facts| facts.to_string()).unwrap_or_default()
    };
    press(&mut harness, Key::V);
    assert!(
        text(&harness).starts_with("depth 0, primitives 7"),
        "{}",
        text(&harness)
    );
    press(&mut harness, Key::ArrowLeft);
    assert!(text(&harness).starts_with("depth 1"), "{}", text(&harness));
    press(&mut harness, Key::ArrowUp);
    press(&mut harness, Key::ArrowUp);
    assert!(text(&harness).starts_with("depth 0"), "{}", text(&harness));
}

#[test]
fn no_two_commands_share_a_key() {
    for preset in [KeyPreset::Standard, KeyPreset::Cs184] {
        let table = bindings(preset);
        let chords: Vec<_> = table.iter().flat_map(|b| b.chords.iter()).collect();
        for (i, chord) in chords.iter().enumerate() {
            assert!(!chords[i + 1..].contains(chord), "{chord:?} in {preset:?}");
        }
        let has = |command| table.iter().any(|b| b.command == command);
        assert!(has(Command::ResetCamera) && has(Command::TogglePause));
    }
}

#[test]
fn a_logs_every_five_hundredth_camera_ray_and_hides_them() {
    let mut harness = viewer();
    wait_for_picture(&mut harness);
    harness.key_press(Key::A);
    harness.run_steps(2);
    let (rays, hits) = harness.state().view.rays.counts();
    assert_eq!(rays, (64 * 48_usize).div_ceil(500));
    assert!(hits > 0, "the box fills most of the picture");
    harness.key_press(Key::A);
    harness.run_steps(2);
    assert!(!harness.state().view.rays.is_on());
}
