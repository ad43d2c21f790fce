//! The small windows over the picture and which of them are open.

use eframe::egui::{self, Context, Window};

use super::command::Command;
use super::panels::message::Messages;

/// Open windows and pending messages.
#[derive(Debug, Default)]
pub(super) struct Windows {
    /// The key sheet.
    pub(super) shows_keys: bool,
    /// The import report.
    pub(super) shows_report: bool,
    /// The text of "Open path…", when it is open.
    path: Option<String>,
    /// Errors and news.
    pub(super) messages: Messages,
}

impl Windows {
    /// Opens the box for typing a path.
    pub(super) fn ask_path(&mut self) {
        self.path.get_or_insert_default();
    }

    /// Closes the foremost window. True when there was one.
    pub(super) fn close_one(&mut self) -> bool {
        self.messages.close()
            || self.path.take().is_some()
            || std::mem::take(&mut self.shows_keys)
            || std::mem::take(&mut self.shows_report)
    }

    /// The box for typing a path.
    pub(super) fn show_path(&mut self, ctx: &Context, commands: &mut Vec<Command>) {
        let Some(text) = &mut self.path else { return };
        let mut is_open = true;
        let mut is_done = false;
        Window::new("Open path")
            .open(&mut is_open)
            .collapsible(false)
            .anchor(egui::Align2::CENTER_CENTER, [0.0, 0.0])
            .show(ctx, |ui| {
                let name = ui.label("Path of a scene");
                let edit = egui::TextEdit::singleline(text)
                    .desired_width(420.0)
                    .hint_text("scene.dae");
                let response = ui.add(edit).labelled_by(name.id);
                let is_entered =
                    response.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
                if !is_entered && ui.memory(|memory| memory.focused().is_none()) {
                    response.request_focus();
                }
                let is_clicked = ui.button("Open").clicked();
                if (is_entered || is_clicked) && !text.trim().is_empty() {
                    commands.push(Command::OpenPath(text.trim().into()));
                    is_done = true;
                }
            });
        if !is_open || is_done {
            self.path = None;
        }
    }
}
