//! From a snapshot to displayed colours: tone mapping for light, colour maps for numbers.

use eframe::egui::{Color32, ColorImage};
use softbox::color::Rgb;
use softbox::display::{
    ColorMap, DisplaySettings, ToneCurve, false_color, to_rgba8_fast, value_range,
};
use softbox::session::{SampleCounts, Snapshot};
use softbox::settings::View;

/// What the ends of a colour map stand for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Legend {
    /// The map.
    pub(super) map: ColorMap,
    /// Values at its first and last colour.
    pub(super) range: (f32, f32),
    /// What is measured, with its unit.
    pub(super) quantity: &'static str,
}

impl Legend {
    /// The displayed colour at `t` in 0..1 of the map.
    pub(super) fn color(&self, t: f32) -> Color32 {
        let [r, g, b] = false_color(&[t], self.map, (0.0, 1.0))[0];
        Color32::from_rgb(r, g, b)
    }
}

/// The image of `snapshot` for the screen, and the legend of its colours.
pub(super) fn shown_image(
    snapshot: &Snapshot,
    display: &DisplaySettings,
) -> (ColorImage, Option<Legend>) {
    let size = [snapshot.width, snapshot.height];
    match numbers(snapshot) {
        Some((values, legend)) => {
            let colors = false_color(&values, legend.map, legend.range);
            let pixels = colors
                .into_iter()
                .map(|[r, g, b]| Color32::from_rgb(r, g, b))
                .collect();
            (ColorImage::new(size, pixels), Some(legend))
        }
        None => {
            let mut bytes = Vec::new();
            to_rgba8_fast(
                &snapshot.pixels,
                &display_of(snapshot.view, display),
                &mut bytes,
            );
            let pixels = bytes
                .into_iter()
                .map(|[r, g, b, _]| Color32::from_rgb(r, g, b))
                .collect();
            (ColorImage::new(size, pixels), None)
        }
    }
}

/// Exposure and tone curve belong to light; normals and albedo are shown as they are.
pub(super) fn display_of(view: View, display: &DisplaySettings) -> DisplaySettings {
    match view {
        View::Render => *display,
        _ => DisplaySettings {
            exposure: 0.0,
            tone_curve: ToneCurve::Srgb,
        },
    }
}

fn numbers(snapshot: &Snapshot) -> Option<(Vec<f32>, Legend)> {
    let scalar = || {
        snapshot
            .pixels
            .iter()
            .map(|p: &Rgb| p.x)
            .collect::<Vec<f32>>()
    };
    match snapshot.view {
        View::Depth => {
            let values = scalar();
            let (near, far) = value_range(&values);
            // Near bright: the map runs from far to near.
            let turned = values
                .iter()
                .map(|v| if v.is_finite() { -v } else { -far })
                .collect();
            let legend = Legend {
                map: ColorMap::Grey,
                range: (-far, -near),
                quantity: "distance from the camera, file units",
            };
            Some((turned, legend))
        }
        View::Cost => {
            let values = scalar();
            let (_, high) = value_range(&values);
            let legend = Legend {
                map: ColorMap::Heat,
                range: (0.0, high),
                quantity: "box and primitive tests of the camera ray",
            };
            Some((values, legend))
        }
        View::Samples => {
            let values = match &snapshot.samples {
                SampleCounts::Uniform(n) => vec![*n as f32; snapshot.pixels.len()],
                SampleCounts::PerPixel(counts) => counts.iter().map(|&n| n as f32).collect(),
            };
            let most = snapshot
                .settings
                .stop
                .samples_per_pixel
                .map_or(snapshot.samples_max, |n| n.max(snapshot.samples_max));
            let legend = Legend {
                map: ColorMap::Rate,
                range: (0.0, most.max(1) as f32),
                quantity: "samples per pixel",
            };
            Some((values, legend))
        }
        View::Noise => {
            let values = snapshot.noise.clone()?;
            let (_, high) = value_range(&values);
            let legend = Legend {
                map: ColorMap::Heat,
                range: (0.0, high),
                quantity: "estimated relative error",
            };
            Some((values, legend))
        }
        View::Render | View::Normals | View::GeometricNormals | View::Albedo => None,
    }
}
