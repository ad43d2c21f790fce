//! From a snapshot to an image for the screen, fast: light by table, numbers by colour map.

use eframe::egui::{Color32, ColorImage};
use softbox::display::{DisplaySettings, false_color, to_rgba8_fast};
use softbox::session::Snapshot;

use crate::shown::{Legend, display_of, shown_numbers};

/// The image of `snapshot` for the screen, and the legend of its colours.
pub(super) fn shown_image(
    snapshot: &Snapshot,
    display: &DisplaySettings,
) -> (ColorImage, Option<Legend>) {
    let size = [snapshot.width, snapshot.height];
    let opaque = |[r, g, b]: [u8; 3]| Color32::from_rgb(r, g, b);
    if let Some((values, legend)) = shown_numbers(snapshot, snapshot.view) {
        let colors = false_color(&values, legend.map, legend.range);
        let pixels = colors.into_iter().map(opaque).collect();
        return (ColorImage::new(size, pixels), Some(legend));
    }
    let mut bytes = Vec::new();
    let display = display_of(snapshot.view, display);
    to_rgba8_fast(&snapshot.pixels, &display, &mut bytes);
    let pixels = bytes.into_iter().map(|[r, g, b, _]| opaque([r, g, b]));
    (ColorImage::new(size, pixels.collect()), None)
}

/// The displayed colour at `t` in 0..1 of the legend's map.
pub(super) fn legend_color(legend: &Legend, t: f32) -> Color32 {
    let [r, g, b] = false_color(&[t], legend.map, (0.0, 1.0))[0];
    Color32::from_rgb(r, g, b)
}
