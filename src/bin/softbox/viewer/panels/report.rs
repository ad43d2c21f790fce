//! What the reader of the file read, guessed and dropped.

use eframe::egui::{Context, ScrollArea, Window};
use softbox::io::{ImportReport, Severity};

/// Shows the report while `is_open`. `notes` are the sentences of the step from the file's
/// description to the scene that rays meet.
pub(in crate::viewer) fn show(
    ctx: &Context,
    report: Option<&ImportReport>,
    notes: &[String],
    is_open: &mut bool,
) {
    Window::new("Import report")
        .open(is_open)
        .default_size([560.0, 360.0])
        .show(ctx, |ui| {
            let Some(report) = report else {
                ui.label("The built-in scene was not read from a file.");
                return;
            };
            let worst = report.notes.iter().map(|note| note.severity).max();
            ui.label(match worst {
                None | Some(Severity::Read) => "Everything in the file was understood.",
                Some(Severity::Guessed) => "The file left something open.",
                Some(Severity::Dropped) => "Something in the file has no effect on the picture.",
                Some(Severity::Warning) => "Something in the file is wrong.",
            });
            ui.separator();
            ScrollArea::both().auto_shrink(false).show(ui, |ui| {
                ui.monospace(report.to_string());
                for note in notes {
                    ui.label(note);
                }
            });
            if ui.button("Copy").clicked() {
                ui.ctx().copy_text(report.to_string());
            }
        });
}
