//! How the picture is shown; nothing here restarts a render but the choice of the view.

use eframe::egui::{self, Slider, Ui};
use softbox::display::{DisplaySettings, ToneCurve};
use softbox::settings::View;

use super::{choice, row, section};
use crate::shown::Legend;
use crate::viewer::keys::view_title;
use crate::viewer::shown::legend_color;

/// View, exposure and tone curve.
pub(in crate::viewer) fn show(
    ui: &mut Ui,
    view: &mut View,
    display: &mut DisplaySettings,
    legend: Option<&Legend>,
) {
    section(ui, "Display", true, |ui| {
        let help = "What the picture shows; keys 1 to 8.";
        choice(ui, ("View", help), view, &View::ALL, view_title);
        row(
            ui,
            "Exposure",
            "Stops: +1 doubles the light. Never restarts the render.",
            Slider::new(&mut display.exposure, -10.0..=10.0).max_decimals(2),
        );
        let help = "From radiance to the screen.";
        choice(
            ui,
            ("Tone curve", help),
            &mut display.tone_curve,
            &ToneCurve::ALL,
            ToneCurve::name,
        );
    });
    if let Some(legend) = legend {
        show_legend(ui, legend);
    }
}

fn show_legend(ui: &mut Ui, legend: &Legend) {
    const STEPS: usize = 48;
    ui.label(legend.quantity);
    let size = egui::vec2(ui.available_width().min(260.0), 12.0);
    let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
    let step = rect.width() / STEPS as f32;
    for i in 0..STEPS {
        let left = rect.left() + i as f32 * step;
        let part = egui::Rect::from_min_max(
            egui::pos2(left, rect.top()),
            egui::pos2(left + step + 0.5, rect.bottom()),
        );
        let t = (i as f32 + 0.5) / STEPS as f32;
        ui.painter()
            .rect_filled(part, egui::CornerRadius::ZERO, legend_color(legend, t));
    }
    ui.horizontal(|ui| {
        ui.set_width(size.x);
        ui.monospace(number(legend.range.0));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.monospace(number(legend.range.1));
        });
    });
}

fn number(value: f32) -> String {
    // Distances run from far to near as negative numbers.
    let value = value.abs();
    if value >= 100.0 || value == value.round() {
        format!("{value:.0}")
    } else {
        format!("{value:.3}")
    }
}
