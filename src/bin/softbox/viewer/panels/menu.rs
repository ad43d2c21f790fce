//! The menu bar.

use std::path::PathBuf;

use eframe::egui::{Button, MenuBar, ThemePreference, Ui};
use softbox::io::builtin_names;

use crate::viewer::command::{Binding, Command, Group, KeyPreset};
use crate::viewer::keys::chord_text;
use crate::viewer::loader::file_name;

/// What the menus show and change directly.
#[derive(Debug)]
pub(in crate::viewer) struct Menu<'a> {
    /// All bindings.
    pub(in crate::viewer) bindings: &'a [Binding],
    /// Recent files.
    pub(in crate::viewer) recent: &'a [PathBuf],
    /// The meaning of Space.
    pub(in crate::viewer) keys: &'a mut KeyPreset,
    /// Whether changed files are read again.
    pub(in crate::viewer) watches_files: &'a mut bool,
    /// True when the session is paused.
    pub(in crate::viewer) is_paused: bool,
}

impl Menu<'_> {
    /// The bar with all menus.
    pub(in crate::viewer) fn show(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        MenuBar::new().ui(ui, |ui| {
            ui.menu_button("File", |ui| self.file(ui, commands));
            for group in [Group::Render, Group::Camera, Group::View] {
                ui.menu_button(group.name(), |ui| {
                    self.group(ui, group, commands);
                    if group == Group::View {
                        self.more_view(ui, commands);
                    }
                });
            }
            ui.menu_button("Help", |ui| {
                self.item(ui, &Command::ToggleKeys, commands);
                ui.separator();
                ui.radio_value(self.keys, KeyPreset::Standard, "Space pauses");
                ui.radio_value(
                    self.keys,
                    KeyPreset::Cs184,
                    "Space resets the camera (cs184)",
                );
            });
        });
    }

    fn more_view(&self, ui: &mut Ui, commands: &mut Vec<Command>) {
        ui.separator();
        self.group(ui, Group::Bvh, commands);
        ui.separator();
        ui.label("Theme");
        let mut theme = ui.ctx().options(|options| options.theme_preference);
        for (choice, text) in [
            (ThemePreference::System, "As the system"),
            (ThemePreference::Dark, "Dark"),
            (ThemePreference::Light, "Light"),
        ] {
            if ui.radio_value(&mut theme, choice, text).changed() {
                ui.ctx().set_theme(choice);
            }
        }
    }

    fn file(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        self.item(ui, &Command::Open, commands);
        self.item(ui, &Command::AskPath, commands);
        ui.add_enabled_ui(!self.recent.is_empty(), |ui| {
            ui.menu_button("Open recent", |ui| {
                for path in self.recent {
                    let button = ui.button(file_name(path));
                    if button.on_hover_text(path.display().to_string()).clicked() {
                        commands.push(Command::OpenPath(path.clone()));
                    }
                }
            });
        });
        ui.menu_button("Open built-in", |ui| {
            for name in builtin_names() {
                if ui.button(name).clicked() {
                    commands.push(Command::OpenPath(name.into()));
                }
            }
        });
        self.item(ui, &Command::Reload, commands);
        ui.checkbox(self.watches_files, "Reload when the file changes");
        if ui.button("Import report").clicked() {
            commands.push(Command::ToggleReport);
        }
        ui.separator();
        for command in [
            Command::SaveSnapshot,
            Command::CopyImage,
            Command::CopyCommandLine,
            Command::DumpCamera,
        ] {
            self.item(ui, &command, commands);
        }
        ui.separator();
        self.item(ui, &Command::Quit, commands);
    }

    fn group(&self, ui: &mut Ui, group: Group, commands: &mut Vec<Command>) {
        for binding in self.bindings.iter().filter(|b| b.group == group) {
            self.item(ui, &binding.command, commands);
        }
    }

    fn item(&self, ui: &mut Ui, command: &Command, commands: &mut Vec<Command>) {
        let Some(binding) = self.bindings.iter().find(|b| b.command == *command) else {
            return;
        };
        let text = match command {
            Command::TogglePause if self.is_paused => "Go on",
            _ => binding.text,
        };
        let mut button = Button::new(text);
        if let Some(chord) = binding.chords.first() {
            button = button.shortcut_text(chord_text(ui.ctx(), *chord));
        }
        if ui.add(button).clicked() {
            commands.push(command.clone());
        }
    }
}
