use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use softbox::bvh::BvhQuality;
use softbox::math::Isa;
use softbox::session::TreeState;
use softbox::settings::{MaxDepth, Mode, View};

use super::*;
use crate::viewer::command::Command;

#[test]
fn sliders_and_ticks_change_the_job_that_is_rendered() {
    let mut harness = viewer();
    harness
        .get_by_role_and_label(Role::Slider, "Light samples")
        .set_value_accesskit(8.0);
    harness.step();
    assert_eq!(
        harness.state().document.render_job().settings.light_samples,
        8
    );
    harness
        .get_by_role_and_label(Role::Slider, "Bounces")
        .set_value_accesskit(3.0);
    harness.get_by_label("Only last bounce").click();
    harness.step();
    harness.step();
    let settings = harness.state().document.render_job().settings;
    assert_eq!(settings.max_depth, MaxDepth(3));
    wait_for_picture(&mut harness);
    let frame = harness
        .state()
        .view
        .viewport
        .frame()
        .expect("a picture")
        .clone();
    assert_eq!(frame.snapshot.settings.light_samples, 8);
    assert_eq!(frame.snapshot.settings.max_depth, MaxDepth(3));
}

#[test]
fn no_limit_of_bounces_goes_there_and_back() {
    let mut harness = viewer();
    for expected in [MaxDepth::INFINITE, MaxDepth(5)] {
        harness.get_by_label("no limit").click();
        harness.run_steps(2);
        assert_eq!(harness.state().document.settings.max_depth, expected);
    }
}

#[test]
fn the_mode_is_chosen_from_a_list() {
    let mut harness = viewer();
    harness
        .get_by_role_and_label(Role::ComboBox, "Mode")
        .click();
    harness.run_steps(2);
    harness.get_by_label("hemisphere").click();
    harness.run_steps(2);
    assert_eq!(harness.state().document.settings.mode, Mode::Hemisphere);
}

#[test]
fn the_quality_of_the_tree_is_chosen_and_its_refinement_shown() {
    let mut options = small_options();
    let settings = options.settings.as_mut().expect("small ones");
    settings.stop.samples_per_pixel = None;
    settings.bvh.quality = BvhQuality::Standard;
    let mut harness = viewer_of(small_scene(), options);
    wait(&mut harness, "samples", |app| {
        app.engine.status().samples_mean >= 1.0
    });
    assert!(harness.query_by_label_contains("tree refined").is_none());
    harness.get_by_label("Machine").click();
    harness.run_steps(2);
    harness
        .get_by_role_and_label(Role::ComboBox, "BVH quality")
        .click();
    harness.run_steps(2);
    harness.get_by_label("high").click();
    harness.run_steps(2);
    let quality = harness.state().document.settings.bvh.quality;
    assert_eq!(quality, BvhQuality::High);
    wait(&mut harness, "the better tree", |app| {
        matches!(app.engine.status().tree, TreeState::Refined { .. })
    });
    harness.step();
    harness.get_by_label("tree refined");
}

#[test]
fn a_view_is_chosen_from_the_menu_and_shown() {
    let mut harness = viewer();
    wait_for_picture(&mut harness);
    let path_traced = harness
        .state()
        .view
        .viewport
        .frame()
        .expect("a picture")
        .clone();
    harness.get_by_role_and_label(Role::Button, "View").click();
    harness.run_steps(2);
    harness.get_by_label_contains("Normals").click();
    harness.run_steps(2);
    assert_eq!(harness.state().document.settings.view, View::Normals);
    wait_for_picture(&mut harness);
    let normals = harness.state().view.viewport.frame().expect("a picture");
    assert_eq!(normals.snapshot.view, View::Normals);
    assert_ne!(*normals.image, *path_traced.image);
}

#[test]
fn the_statistics_tell_the_instruction_set() {
    let mut options = small_options();
    options.isa = Some(Isa::Portable);
    let mut harness = viewer_of(small_scene(), options);
    wait_for_picture(&mut harness);
    harness.get_by_label("Statistics").click();
    harness.run_steps(2);
    harness.get_by_label("Instruction set");
    harness.get_by_label("portable");
    let scene = harness.state().engine.prepared().expect("it is shown");
    assert_eq!(scene.aggregate().isa(), Isa::Portable);
}

#[test]
fn every_input_has_a_name() {
    let mut harness = viewer();
    wait_for_picture(&mut harness);
    let ctx = harness.ctx.clone();
    harness.state_mut().execute(&ctx, Command::ToggleBvh);
    for section in [
        "Camera",
        "Picture size",
        "Machine",
        "Error curve",
        "Statistics",
    ] {
        harness
            .get_all_by_label(section)
            .last()
            .expect("it is there")
            .click();
        harness.run_steps(2);
    }
    harness.check_accessibility();
}

#[test]
fn a_light_that_was_added_is_told_and_removed_by_one_click() {
    let mut scene = small_scene();
    scene.environment.sky = glam::Vec3::ONE;
    scene.environment.is_added = true;
    let mut harness = viewer_of(scene, small_options());
    harness.step();
    harness.get_by_label("Added light");
    harness.get_by_label("Remove").click();
    harness.run_steps(2);
    let environment = &harness.state().document.scene.environment;
    assert_eq!(environment.sky, glam::Vec3::ZERO);
    assert!(harness.query_by_label("Added light").is_none());
}
