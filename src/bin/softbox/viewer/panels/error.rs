//! The error of the picture against its processor time.

use eframe::egui::{self, DragValue, TextEdit, Ui};
use egui_plot::{HLine, Line, Plot, PlotPoints, Points};
use softbox::study::PowerLaw;

use super::optional;
use crate::viewer::command::Command;
use crate::viewer::error_curve::ErrorCurve;

const HEIGHT: f32 = 200.0;
const FIRST_TARGET: f64 = 1e-3;

/// The section; while it is folded nothing is measured.
pub(in crate::viewer) fn show(ui: &mut Ui, curve: &mut ErrorCurve, commands: &mut Vec<Command>) {
    let header = egui::CollapsingHeader::new("Error curve")
        .open(curve.take_wish())
        .show(ui, |ui| {
            reference(ui, curve, commands);
            egui::Grid::new("error target")
                .num_columns(2)
                .min_col_width(super::LABELS)
                .show(ui, |ui| target(ui, curve));
            facts(ui, curve);
            plot(ui, curve);
        });
    curve.set_on(header.body_returned.is_some());
}

fn reference(ui: &mut Ui, curve: &mut ErrorCurve, commands: &mut Vec<Command>) {
    let help = "A finished picture of the same view, linear (.exr, .hdr, .pfm). Without one, the \
                error is estimated from the spread of the samples.";
    ui.horizontal(|ui| {
        let name = ui.label("Reference").on_hover_text(help);
        let edit = TextEdit::singleline(&mut curve.path)
            .desired_width(150.0)
            .hint_text("reference.exr");
        let response = ui.add(edit).labelled_by(name.id).on_hover_text(help);
        let is_entered = response.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
        let is_clicked = ui.button("Compare").clicked();
        let path = curve.path.trim();
        if (is_entered || is_clicked) && !path.is_empty() {
            commands.push(Command::ReadReference(path.into()));
        }
        if ui.button("Browse…").clicked() {
            commands.push(Command::ChooseReference);
        }
    });
    let shown = curve.reference_name().map(str::to_owned);
    ui.horizontal(|ui| match shown {
        Some(name) => {
            ui.label(format!("against {name}"));
            if ui.button("Forget").clicked() {
                commands.push(Command::ForgetReference);
            }
        }
        None => {
            ui.label("estimated from the spread of the samples");
        }
    });
    if let Some(sentence) = curve.misfit() {
        ui.colored_label(ui.visuals().warn_fg_color, sentence);
    }
}

fn target(ui: &mut Ui, curve: &mut ErrorCurve) {
    let help = "The relMSE to be reached; a line in the picture.";
    let first = FIRST_TARGET;
    optional(
        ui,
        ("Target", help),
        &mut curve.target,
        first,
        |ui, value| {
            let speed = *value * 0.02;
            ui.add(
                DragValue::new(value)
                    .range(1e-9..=10.0)
                    .speed(speed)
                    .custom_formatter(|value, _| format!("{value:.2e}")),
            )
            .accessible_name("Target relMSE")
        },
    );
}

fn facts(ui: &mut Ui, curve: &ErrorCurve) {
    let Some(last) = curve.points().last() else {
        ui.weak("no error yet");
        return;
    };
    let mut text = format!(
        "relMSE {:.2e} after {:.2} cpu s",
        last.rel_mse, last.cpu_seconds
    );
    if let Some(law) = curve.power_law() {
        text += &format!(", slope {:.2}", law.slope);
        text += &reached(&law, curve.target, (last.cpu_seconds, last.rel_mse));
    }
    ui.monospace(text);
}

/// When the target is reached, or since when.
fn reached(law: &PowerLaw, target: Option<f64>, (now, error): (f64, f64)) -> String {
    let Some(target) = target else {
        return String::new();
    };
    match law.reach(target, (error, f64::INFINITY)) {
        Some(reach) if error <= target => format!(", target after {:.2} cpu s", reach.cpu_seconds),
        Some(reach) => format!(
            ", target in {:.2} cpu s",
            (reach.cpu_seconds - now).max(0.0)
        ),
        None => String::new(),
    }
}

fn plot(ui: &mut Ui, curve: &ErrorCurve) {
    let points: Vec<[f64; 2]> = curve
        .points()
        .iter()
        .map(|p| [p.cpu_seconds.log10(), p.rel_mse.log10()])
        .collect();
    let (line_color, target_color) = (ui.visuals().hyperlink_color, ui.visuals().warn_fg_color);
    let target = curve.target;
    let plot = Plot::new("error against time")
        .height(HEIGHT)
        .allow_scroll(false)
        .x_axis_label("processor seconds")
        .y_axis_label("relMSE")
        .x_axis_formatter(|mark, _| number(mark.value))
        .y_axis_formatter(|mark, _| number(mark.value))
        .y_axis_min_width(48.0);
    let response = plot.show(ui, |plot| {
        let line = Line::new("relMSE", PlotPoints::from(points.clone()));
        plot.line(line.color(line_color).width(2.0));
        plot.points(
            Points::new("relMSE", PlotPoints::from(points))
                .color(line_color)
                .radius(2.5),
        );
        if let Some(target) = target {
            plot.hline(HLine::new("target", target.log10()).color(target_color));
        }
    });
    response.response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::accesskit::Role::Image, true, "Error against time")
    });
}

/// Ten to the power of `exponent`, short.
fn number(exponent: f64) -> String {
    let value = 10_f64.powf(exponent);
    if (0.01..1000.0).contains(&value) {
        let digits = (1.0 - exponent.floor()).clamp(0.0, 3.0) as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.0e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_and_targets_are_short() {
        assert_eq!(
            (number(0.0).as_str(), number(-1.0).as_str()),
            ("1.0", "0.10")
        );
        assert_eq!(
            (number(2.0).as_str(), number(-4.0).as_str()),
            ("100", "1e-4")
        );
        let law = PowerLaw {
            slope: -1.0,
            slope_error: None,
            intercept: 0.0,
        };
        assert_eq!(reached(&law, None, (1.0, 1.0)), "");
        assert_eq!(
            reached(&law, Some(0.1), (4.0, 0.25)),
            ", target in 6.00 cpu s"
        );
        assert_eq!(
            reached(&law, Some(0.5), (4.0, 0.25)),
            ", target after 2.00 cpu s"
        );
    }
}
