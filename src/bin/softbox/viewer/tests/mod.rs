//! The complete application, driven by labels, keys and pointer, without a display.

mod display;
mod error_curve;
mod files;
mod keys;
mod panels;
mod pointer;

use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::{Pos2, Vec2, accesskit::Role, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use softbox::scene::{Scene, cornell_box};
use softbox::session::SessionState;
use softbox::settings::{RenderSettings, StopRule};

use super::app::App;
use super::options::ViewerOptions;

/// Longer than anything takes on a busy machine; reached only by a fault.
const PATIENCE: Duration = Duration::from_secs(60);

/// A box with a ball: few primitives, a surface under the middle of the picture.
fn small_scene() -> Scene {
    let mut builder = cornell_box("box");
    let white = builder.diffuse("ball white", glam::Vec3::splat(0.7));
    builder.sphere("ball", DVec3::new(0.0, 0.75, 0.0), 0.3, white);
    builder.finish()
}

/// 64 × 48 pixels, two samples, one thread.
fn small_settings() -> RenderSettings {
    RenderSettings {
        width: 64,
        height: 48,
        threads: 1,
        stop: StopRule {
            samples_per_pixel: Some(2),
            ..StopRule::default()
        },
        ..RenderSettings::default()
    }
}

fn small_options() -> ViewerOptions {
    ViewerOptions {
        settings: Some(small_settings()),
        has_fixed_size: true,
        ..ViewerOptions::default()
    }
}

fn viewer_of(scene: Scene, options: ViewerOptions) -> Harness<'static, App> {
    Harness::builder()
        .with_size(Vec2::new(1100.0, 1000.0))
        .with_step_dt(1.0 / 60.0)
        .build_eframe(move |cc| {
            App::new(cc, Arc::new(scene), options).expect("threads can be started")
        })
}

fn viewer() -> Harness<'static, App> {
    viewer_of(small_scene(), small_options())
}

/// Steps until `is_done`.
fn wait(harness: &mut Harness<'_, App>, what: &str, is_done: impl Fn(&App) -> bool) {
    let begin = Instant::now();
    loop {
        harness.step();
        if is_done(harness.state()) {
            return;
        }
        assert!(begin.elapsed() < PATIENCE, "still waiting for {what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// True when the picture of the present job is complete and on the screen.
fn is_shown(app: &App) -> bool {
    let is_finished = matches!(app.engine.status().state, SessionState::Finished(_));
    let job = app.document.render_job();
    is_finished
        && app.view.viewport.frame().is_some_and(|frame| {
            let snapshot = &frame.snapshot;
            !snapshot.is_preview
                && snapshot.camera == job.camera
                && snapshot.settings == job.settings
                && (snapshot.view.is_first_hit() || snapshot.samples_max == 2)
        })
}

fn wait_for_picture(harness: &mut Harness<'_, App>) {
    wait(harness, "the picture", is_shown);
}

/// The middle of the picture.
fn middle(harness: &Harness<'_, App>) -> Pos2 {
    harness
        .get_by_role_and_label(Role::Image, "Render view")
        .rect()
        .center()
}

/// Presses, moves in steps, and lets go.
fn drag(harness: &mut Harness<'_, App>, from: Pos2, to: Pos2) {
    harness.hover_at(from);
    harness.step();
    harness.drag_at(from);
    harness.step();
    for i in 1..=4 {
        let t = i as f32 / 4.0;
        harness.hover_at(pos2(
            from.x + (to.x - from.x) * t,
            from.y + (to.y - from.y) * t,
        ));
        harness.step();
    }
    harness.drop_at(to);
    harness.step();
}
