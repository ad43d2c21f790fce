//! Opening the window, with one drawing interface or the other.

use std::sync::Arc;

use anyhow::anyhow;
use eframe::egui::ViewportBuilder;
use eframe::{NativeOptions, Renderer};
use softbox::io::camera_file::read_camera_file;
use softbox::scene::Scene;

use super::app::App;
use super::options::{Backend, ViewerOptions};
use crate::args::WindowArgs;
use crate::exit::{Failure, Status};
use crate::job::Job;
use crate::open::{open, open_path};
use crate::render::check_readable;

/// Identifies the window to the desktop and names the folder of the stored preferences.
const APP_ID: &str = "softbox";

/// Opens the window on `job` until it is closed.
///
/// # Errors
/// When the scene or the camera file cannot be opened, or when no drawing interface works; the
/// sentence then names the way without a window.
pub(crate) fn run(job: &Job, window: &WindowArgs) -> Result<(), Failure> {
    if let Some(file) = &job.camera.file {
        read_camera_file(file).map_err(Status::Scene.because())?;
    }
    let scene = Arc::new(first_scene(job)?);
    let options = &ViewerOptions::new(job, window);
    let mut failures = Vec::new();
    for renderer in renderers(options.backend) {
        let scene = Arc::clone(&scene);
        let for_app = options.clone();
        let result = eframe::run_native(
            APP_ID,
            native_options(renderer),
            Box::new(move |cc| Ok(Box::new(App::new(cc, scene, for_app)?))),
        );
        match result {
            Ok(()) => return Ok(()),
            Err(error) => failures.push(format!("{renderer}: {}", reason(&error.to_string()))),
        }
    }
    Err(Status::Failed.because()(anyhow!(
        "The window cannot be opened ({}). Render without one: softbox render SCENE -o OUT.png",
        failures.join("; ")
    )))
}

/// The words of an error of the window system without the place in its source.
fn reason(error: &str) -> &str {
    let after_place = error
        .rsplit_once(".rs:")
        .and_then(|(_, rest)| rest.split_once(": "));
    after_place
        .map_or(error, |(_, words)| words)
        .trim_end_matches('.')
}

/// What is shown until the window has read the file: nothing, or the built-in scene for good.
fn first_scene(job: &Job) -> Result<Scene, Failure> {
    match &job.scene {
        None => open(job).map(|loaded| loaded.scene),
        Some(path) if path.exists() => check_readable(path).map(|()| Scene::default()),
        // A built-in scene, or the error that there is no such file.
        Some(path) => open_path(path).map(|_| Scene::default()),
    }
}

/// The compiled renderers, the preferred one first.
fn renderers(preferred: Backend) -> Vec<Renderer> {
    let mut renderers = vec![
        #[cfg(feature = "glow")]
        (Backend::Glow, Renderer::Glow),
        #[cfg(feature = "wgpu")]
        (Backend::Wgpu, Renderer::Wgpu),
    ];
    renderers.sort_by_key(|(backend, _)| *backend != preferred);
    renderers
        .into_iter()
        .map(|(_, renderer)| renderer)
        .collect()
}

fn native_options(renderer: Renderer) -> NativeOptions {
    NativeOptions {
        renderer,
        viewport: ViewportBuilder::default()
            .with_title("softbox")
            .with_app_id(APP_ID)
            .with_inner_size([1280.0, 820.0])
            .with_min_inner_size([640.0, 400.0])
            .with_drag_and_drop(true),
        ..NativeOptions::default()
    }
}

#[cfg(test)]
mod tests {
    use super::reason;

    #[test]
    fn reasons_name_no_source_files() {
        let error = "winit EventLoopError: os error at /some/where/mod.rs:788: No X server.";
        assert_eq!(reason(error), "No X server");
        assert_eq!(reason("no adapter: none"), "no adapter: none");
    }
}
