//! The panels: what they show is borrowed, what they change is the document, what they ask for is
//! a list of commands. They know neither threads nor sampling.

pub(super) mod bvh;
pub(super) mod camera;
pub(super) mod display;
pub(super) mod error;
pub(super) mod key_sheet;
pub(super) mod menu;
pub(super) mod message;
pub(super) mod pixel;
pub(super) mod render;
pub(super) mod report;
pub(super) mod statistics;
pub(super) mod status_bar;
pub(super) mod stop;

use eframe::egui::{self, ComboBox, Response, Ui, Widget};

/// Width of the column of labels, the same in all sections.
pub(super) const LABELS: f32 = 112.0;

/// A section that can be folded.
pub(super) fn section(ui: &mut Ui, title: &str, is_open: bool, content: impl FnOnce(&mut Ui)) {
    egui::CollapsingHeader::new(title)
        .default_open(is_open)
        .show(ui, |ui| {
            egui::Grid::new(title)
                .num_columns(2)
                .spacing([8.0, 5.0])
                .min_col_width(LABELS)
                .show(ui, content);
        });
}

/// One line of a section: a label and the widget that it names.
pub(super) fn row(ui: &mut Ui, label: &str, help: &str, widget: impl Widget) -> Response {
    let name = ui.label(label).on_hover_text(help);
    let response = ui.add(widget).labelled_by(name.id).on_hover_text(help);
    ui.end_row();
    response
}

/// A line with a choice. Returns true when it changed.
pub(super) fn choice<T: Copy + PartialEq>(
    ui: &mut Ui,
    (label, help): (&str, &str),
    value: &mut T,
    options: &[T],
    name: impl Fn(T) -> &'static str,
) -> bool {
    let label_response = ui.label(label).on_hover_text(help);
    let before = *value;
    ComboBox::from_id_salt(label)
        .width(150.0)
        .selected_text(name(*value))
        .show_ui(ui, |ui| {
            for &option in options {
                ui.selectable_value(value, option, name(option));
            }
        })
        .response
        .labelled_by(label_response.id)
        .on_hover_text(help);
    ui.end_row();
    *value != before
}

/// A line with a tick and, when it is ticked, a value. `first` is the value a fresh tick gives.
pub(super) fn optional<T: Clone>(
    ui: &mut Ui,
    (label, help): (&str, &str),
    value: &mut Option<T>,
    first: T,
    widget: impl FnOnce(&mut Ui, &mut T) -> Response,
) {
    let mut is_on = value.is_some();
    let tick = ui.checkbox(&mut is_on, label).on_hover_text(help);
    if tick.changed() {
        *value = is_on.then_some(first);
    }
    match value {
        Some(value) => {
            widget(ui, value).on_hover_text(help);
        }
        None => {
            ui.weak("off");
        }
    }
    ui.end_row();
}
