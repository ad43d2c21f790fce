//! The pixel and the surface under the pointer, in places that do not move.

use eframe::egui::{self, Grid, Ui};

use crate::viewer::inspector::{PickInfo, PixelValues};

/// Half the width of a 95 % interval in deviations that nine pixels tell together.
const DEVIATIONS_95: f64 = 2.05;

/// The lines of the inspector; blanks where there is nothing.
pub(in crate::viewer) fn show(
    ui: &mut Ui,
    values: Option<&PixelValues>,
    surface: Option<&PickInfo>,
) {
    egui::CollapsingHeader::new("Under the pointer")
        .default_open(true)
        .show(ui, |ui| {
            Grid::new("pixel")
                .num_columns(2)
                .min_col_width(super::LABELS)
                .show(ui, |ui| {
                    for (name, text) in pixel_lines(values)
                        .into_iter()
                        .chain(surface_lines(surface))
                    {
                        ui.label(name);
                        ui.add(egui::Label::new(egui::RichText::new(text).monospace()).truncate());
                        ui.end_row();
                    }
                });
        });
}

fn pixel_lines(values: Option<&PixelValues>) -> [(&'static str, String); 5] {
    let text = |f: &dyn Fn(&PixelValues) -> String| values.map_or_else(String::new, f);
    [
        (
            "Pixel",
            text(&|v| format!("{}, {}", v.pixel[0], v.pixel[1])),
        ),
        (
            "Linear",
            text(&|v| format!("{:.4} {:.4} {:.4}", v.linear.x, v.linear.y, v.linear.z)),
        ),
        ("Luminance", text(&|v| format!("{:.4}", v.luminance))),
        (
            "Displayed",
            text(&|v| format!("{} {} {}", v.displayed[0], v.displayed[1], v.displayed[2])),
        ),
        (
            "Samples",
            text(&|v| {
                v.relative_error.map_or_else(
                    || v.samples.to_string(),
                    |error| {
                        let half_width = DEVIATIONS_95 * f64::from(error) * 100.0;
                        format!("{} (95 %: ±{half_width:.1} %)", v.samples)
                    },
                )
            }),
        ),
    ]
}

fn surface_lines(surface: Option<&PickInfo>) -> [(&'static str, String); 6] {
    let text = |f: &dyn Fn(&PickInfo) -> String| surface.map_or_else(String::new, f);
    let vector = |x: f64, y: f64, z: f64| format!("{x:.4} {y:.4} {z:.4}");
    [
        ("Object", text(&|s| s.object.clone())),
        ("Material", text(&|s| s.material.clone())),
        ("Point", text(&|s| vector(s.point.x, s.point.y, s.point.z))),
        ("Distance", text(&|s| format!("{:.5}", s.distance))),
        (
            "Normal",
            text(&|s| {
                let n = s.normal.as_dvec3();
                vector(n.x, n.y, n.z)
            }),
        ),
        ("Primitive", text(&|s| s.primitive.to_string())),
    ]
}
