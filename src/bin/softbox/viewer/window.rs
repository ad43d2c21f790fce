//! Opening the window, with one drawing interface or the other.

use std::sync::Arc;

use anyhow::{Result, anyhow};
use eframe::egui::ViewportBuilder;
use eframe::{NativeOptions, Renderer};
use softbox::scene::Scene;

use super::app::App;
use super::options::{Backend, ViewerOptions};

/// Identifies the window to the desktop and names the folder of the stored preferences.
const APP_ID: &str = "softbox";

/// Opens the viewer with `scene` until it is closed.
///
/// # Errors
/// When no drawing interface works; the sentence names the way without a window.
pub(crate) fn run(scene: &Arc<Scene>, options: &ViewerOptions) -> Result<()> {
    let mut failures = Vec::new();
    for renderer in renderers(options.backend) {
        let scene = Arc::clone(scene);
        let for_app = options.clone();
        let result = eframe::run_native(
            APP_ID,
            native_options(renderer),
            Box::new(move |cc| Ok(Box::new(App::new(cc, scene, for_app)?))),
        );
        match result {
            Ok(()) => return Ok(()),
            Err(error) => failures.push(format!("{renderer}: {error}")),
        }
    }
    Err(anyhow!(
        "The window cannot be opened ({}). Render without one: softbox render SCENE -o OUT.png",
        failures.join("; ")
    ))
}

/// The compiled renderers, the preferred one first.
fn renderers(preferred: Backend) -> Vec<Renderer> {
    let mut renderers = Vec::new();
    #[cfg(feature = "glow")]
    renderers.push((Backend::Glow, Renderer::Glow));
    #[cfg(feature = "wgpu")]
    renderers.push((Backend::Wgpu, Renderer::Wgpu));
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
