//! When a render is finished.

use eframe::egui::{DragValue, Ui};
use softbox::settings::StopRule;

use super::render::parse_percent;
use super::{optional, section};

/// The stop rules; whichever comes first.
pub(in crate::viewer) fn show(ui: &mut Ui, stop: &mut StopRule) {
    section(ui, "Stop after", true, |ui| {
        let help = "Samples per pixel; with adaptive sampling the most of them, or their mean for least error.";
        let samples = &mut stop.samples_per_pixel;
        optional(ui, ("Samples", help), samples, 256, |ui, samples| {
            ui.add(DragValue::new(samples).range(1..=u32::MAX).speed(1.0))
                .accessible_name("Samples per pixel")
        });
        let help = "Seconds of rendering.";
        optional(
            ui,
            ("Seconds", help),
            &mut stop.seconds,
            60.0,
            |ui, seconds| {
                ui.add(DragValue::new(seconds).range(0.1..=1e7).suffix(" s"))
                    .accessible_name("Seconds of rendering")
            },
        );
        let help = "Estimated relative error of the whole picture.";
        let error = &mut stop.relative_error;
        optional(ui, ("Error", help), error, 0.01, |ui, error| {
            ui.add(
                DragValue::new(error)
                    .range(1e-5..=1.0)
                    .speed(0.0005)
                    .custom_formatter(|value, _| format!("{:.2} %", value * 100.0))
                    .custom_parser(parse_percent),
            )
            .accessible_name("Relative error")
        });
    });
}
