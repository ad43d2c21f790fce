use eframe::egui::{
    Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, TouchPhase,
};
use softbox::image::Region;

use super::*;

fn click(harness: &mut Harness<'_, App>, at: Pos2, button: PointerButton, modifiers: Modifiers) {
    harness.hover_at(at);
    harness.step();
    for pressed in [true, false] {
        let event = Event::PointerButton {
            pos: at,
            button,
            pressed,
            modifiers,
        };
        harness.event_modifiers(event, modifiers);
        harness.step();
    }
}

#[test]
fn a_left_drag_orbits_at_constant_distance() {
    let mut harness = viewer();
    harness.step();
    let before = harness.state().document.camera;
    let from = middle(&harness);
    drag(&mut harness, from, from + Vec2::new(100.0, -30.0));
    let after = harness.state().document.camera;
    assert_eq!(after.target, before.target);
    let distance = |camera: softbox::camera::Camera| camera.eye.distance(camera.target);
    assert!((distance(after) - distance(before)).abs() < 1e-9);
    assert!(after.eye.distance(before.eye) > 0.1);
    // The scene follows the hand: the eye goes left and down.
    assert!(after.eye.x < before.eye.x && after.eye.y < before.eye.y);
    wait_for_picture(&mut harness);
}

#[test]
fn a_region_is_dragged_kept_and_cleared() {
    let mut harness = viewer();
    wait_for_picture(&mut harness);
    let camera = harness.state().document.camera;
    harness.key_press(Key::C);
    harness.run_steps(2);
    let from = middle(&harness);
    drag(&mut harness, from, from + Vec2::new(100.0, 80.0));
    let region = harness.state().document.settings.region.expect("a region");
    assert!(
        region.contains(33, 25) && !region.contains(20, 20),
        "{region:?}"
    );
    assert!(region.clipped(64, 48) == Some(region), "{region:?}");
    assert_eq!(harness.state().document.camera, camera);
    drag(&mut harness, from, from + Vec2::new(30.0, 0.0));
    assert_eq!(harness.state().document.settings.region, Some(region));
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    assert_eq!(harness.state().document.settings.region, None::<Region>);
}

#[test]
fn the_wheel_moves_towards_what_is_under_the_pointer() {
    let mut harness = viewer();
    wait_for_picture(&mut harness);
    let before = harness.state().document.camera;
    let at = middle(&harness);
    harness.hover_at(at);
    harness.step();
    harness.event(Event::MouseWheel {
        source: MouseWheelSource::Wheel,
        unit: MouseWheelUnit::Point,
        delta: Vec2::new(0.0, 100.0),
        phase: TouchPhase::Move,
        modifiers: Modifiers::NONE,
    });
    harness.run_steps(40);
    let after = harness.state().document.camera;
    assert!(after.eye.z < before.eye.z - 0.1, "{after:?}");
    assert!(after.eye.z > 0.3, "not into the ball: {after:?}");
}

#[test]
fn the_inspector_names_what_is_under_the_pointer() {
    let mut harness = viewer();
    wait_for_picture(&mut harness);
    let at = middle(&harness);
    harness.hover_at(at);
    harness.run_steps(2);
    harness.get_by_label("ball");
    harness.get_by_label("ball white");
    harness.get_by_label("32, 24");
}

#[test]
fn ctrl_and_right_click_focuses_on_the_surface() {
    let mut harness = viewer();
    wait_for_picture(&mut harness);
    let at = middle(&harness);
    click(
        &mut harness,
        at,
        PointerButton::Secondary,
        Modifiers::COMMAND,
    );
    let camera = harness.state().document.camera;
    let to_ball = camera.eye.z - 0.3;
    assert!((camera.focal_distance - to_ball).abs() < 0.02, "{camera:?}");
}

#[test]
fn a_double_click_makes_the_point_the_pivot() {
    let mut harness = viewer();
    wait_for_picture(&mut harness);
    let at = middle(&harness) + Vec2::new(0.0, 20.0);
    for _ in 0..2 {
        harness.hover_at(at);
        harness.drag_at(at);
        harness.drop_at(at);
    }
    harness.run_steps(2);
    let target = harness.state().document.camera.target;
    let center = DVec3::new(0.0, 0.75, 0.0);
    assert!((target.distance(center) - 0.3).abs() < 1e-3, "{target}");
}
