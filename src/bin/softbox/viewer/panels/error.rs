//! The error of the picture against its processor time.

use eframe::egui::{self, DragValue, TextEdit, Ui};
use egui_plot::{GridInput, GridMark, HLine, Line, Plot, PlotPoints, Points};
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
            .desired_width(ui.available_width() - 16.0)
            .hint_text("reference.exr");
        let response = ui.add(edit).labelled_by(name.id).on_hover_text(help);
        let is_entered = response.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
        if is_entered {
            ask(curve, commands);
        }
    });
    ui.horizontal(|ui| {
        if ui.button("Compare").clicked() {
            ask(curve, commands);
        }
        if ui.button("Browse…").clicked() {
            commands.push(Command::ChooseReference);
        }
        if curve.reference_name().is_some() && ui.button("Forget").clicked() {
            commands.push(Command::ForgetReference);
        }
    });
    match curve.reference_name() {
        Some(name) => ui.label(format!("against {name}")),
        None => ui.label("estimated from the spread of the samples"),
    };
    if let Some(sentence) = curve.misfit() {
        ui.colored_label(ui.visuals().warn_fg_color, sentence);
    }
}

/// Asks for the picture whose path is typed.
fn ask(curve: &ErrorCurve, commands: &mut Vec<Command>) {
    let path = curve.path.trim();
    if !path.is_empty() {
        commands.push(Command::ReadReference(path.into()));
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
    ui.monospace(format!(
        "relMSE {:.2e} after {:.2} cpu s",
        last.rel_mse, last.cpu_seconds
    ));
    if let Some(law) = curve.power_law() {
        let now = (last.cpu_seconds, last.rel_mse);
        let target = reached(&law, curve.target, now);
        ui.monospace(format!("slope {:.2}{target}", law.slope));
    }
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
        .x_grid_spacer(decades)
        .y_grid_spacer(decades)
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

/// One to nine times each power of ten, the more important ones with more room around them.
fn decades(input: GridInput) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    if !(high - low).is_finite() || high - low > 40.0 {
        return Vec::new();
    }
    let powers = low.floor() as i32..=high.ceil() as i32;
    powers
        .flat_map(|power| (1..=9).map(move |digit| (power, digit)))
        .map(|(power, digit)| GridMark {
            value: f64::from(power) + f64::from(digit).log10(),
            step_size: match digit {
                1 => 1.0,
                2 | 5 => 0.3,
                _ => 0.08,
            },
        })
        .filter(|mark| (low..=high).contains(&mark.value))
        .collect()
}

/// Ten to the power of `exponent`, with one digit.
fn number(exponent: f64) -> String {
    let value = 10_f64.powf(exponent);
    match (exponent + 1e-6).floor() as i32 {
        decimals @ -2..0 => format!("{value:.0$}", decimals.unsigned_abs() as usize),
        0..3 => format!("{value:.0}"),
        _ => format!("{value:.0e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_grid_has_nine_lines_in_each_decade() {
        let marks = decades(GridInput {
            bounds: (-2.5, 0.5),
            base_step_size: 0.1,
        });
        assert_eq!(marks.len(), 6 + 9 + 9 + 3);
        let tens: Vec<f64> = marks
            .iter()
            .filter(|mark| mark.step_size == 1.0)
            .map(|mark| mark.value)
            .collect();
        assert_eq!(tens, [-2.0, -1.0, 0.0]);
        let endless = GridInput {
            bounds: (f64::NEG_INFINITY, 1.0),
            base_step_size: 0.1,
        };
        assert!(decades(endless).is_empty());
    }

    #[test]
    fn ticks_and_targets_are_short() {
        assert_eq!((number(0.0).as_str(), number(-1.0).as_str()), ("1", "0.1"));
        assert_eq!(
            (number(2.0).as_str(), number(-4.0).as_str()),
            ("100", "1e-4")
        );
        assert_eq!(number(0.02_f64.log10()), "0.02");
        assert_eq!(number(0.01_f64.log10()), "0.01");
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
