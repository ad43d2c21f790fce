//! From a snapshot to displayed bytes: tone mapping for light, colour maps for numbers. The window
//! and the files show the same.

use softbox::display::{ColorMap, DisplaySettings, ToneCurve, false_color, tone_map, value_range};
use softbox::session::{SampleCounts, Snapshot};
use softbox::settings::View;

/// What the ends of a colour map stand for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Legend {
    /// The map.
    pub(crate) map: ColorMap,
    /// Values at its first and last colour.
    pub(crate) range: (f32, f32),
    /// What is measured, with its unit.
    pub(crate) quantity: &'static str,
}

/// The exact displayed bytes of `snapshot`, for files.
pub(crate) fn shown_bytes(snapshot: &Snapshot, display: &DisplaySettings) -> Vec<[u8; 3]> {
    match shown_numbers(snapshot, snapshot.view) {
        Some((values, legend)) => false_color(&values, legend.map, legend.range),
        None => tone_map(&snapshot.pixels, &display_of(snapshot.view, display)),
    }
}

/// Exposure and tone curve belong to light; normals and albedo are shown as they are.
pub(crate) fn display_of(view: View, display: &DisplaySettings) -> DisplaySettings {
    match view {
        View::Render => *display,
        _ => DisplaySettings {
            exposure: 0.0,
            tone_curve: ToneCurve::Srgb,
        },
    }
}

/// The numbers that `view` shows of `snapshot` and how they are coloured; `None` where the view
/// shows colours.
pub(crate) fn shown_numbers(snapshot: &Snapshot, view: View) -> Option<(Vec<f32>, Legend)> {
    let scalar = || snapshot.pixels.iter().map(|p| p.x).collect::<Vec<f32>>();
    match view {
        View::Depth => Some(depth(&scalar())),
        View::Cost => {
            let quantity = "box and primitive tests of the camera ray";
            Some(from_zero(scalar(), ColorMap::Heat, quantity))
        }
        View::Samples => {
            let limit = snapshot.settings.stop.samples_per_pixel;
            let most = limit.map_or(snapshot.samples_max, |n| n.max(snapshot.samples_max));
            let range = (0.0, most.max(1) as f32);
            Some((
                samples(snapshot),
                Legend {
                    map: ColorMap::Rate,
                    range,
                    quantity: "samples per pixel",
                },
            ))
        }
        View::Noise => Some(from_zero(
            snapshot.noise.clone()?,
            ColorMap::Heat,
            "estimated relative error",
        )),
        View::Render | View::Normals | View::GeometricNormals | View::Albedo => None,
    }
}

fn samples(snapshot: &Snapshot) -> Vec<f32> {
    match &snapshot.samples {
        SampleCounts::Uniform(n) => vec![*n as f32; snapshot.pixels.len()],
        SampleCounts::PerPixel(counts) => counts.iter().map(|&n| n as f32).collect(),
    }
}

/// Near bright: the map runs from far to near.
fn depth(values: &[f32]) -> (Vec<f32>, Legend) {
    let (near, far) = value_range(values);
    let turned = values
        .iter()
        .map(|v| if v.is_finite() { -v } else { -far })
        .collect();
    let quantity = "distance from the camera, file units";
    (
        turned,
        Legend {
            map: ColorMap::Grey,
            range: (-far, -near),
            quantity,
        },
    )
}

fn from_zero(values: Vec<f32>, map: ColorMap, quantity: &'static str) -> (Vec<f32>, Legend) {
    let (_, high) = value_range(&values);
    (
        values,
        Legend {
            map,
            range: (0.0, high),
            quantity,
        },
    )
}
