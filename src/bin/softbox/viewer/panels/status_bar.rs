//! The line at the bottom: what is going on, how far it is, how long it takes.

use eframe::egui::{self, ProgressBar, Ui};
use softbox::io::{ImportReport, Severity};
use softbox::session::{SessionState, SessionStatus, StopReason, TreeState};

use super::statistics::count;
use crate::viewer::command::Command;
use crate::viewer::loader::LoadStatus;

/// What the line shows besides the status of the session.
#[derive(Debug)]
pub(in crate::viewer) struct StatusBar<'a> {
    /// The session.
    pub(in crate::viewer) status: &'a SessionStatus,
    /// A file being read.
    pub(in crate::viewer) loading: Option<&'a LoadStatus>,
    /// Size of the picture.
    pub(in crate::viewer) size: [u32; 2],
    /// True when softbox added a light.
    pub(in crate::viewer) has_added_light: bool,
    /// True when the light of only some of the bounces is kept, or the like.
    pub(in crate::viewer) badge: Option<&'static str>,
    /// The report of the open file.
    pub(in crate::viewer) report: Option<&'a ImportReport>,
}

impl StatusBar<'_> {
    /// The line.
    pub(in crate::viewer) fn show(&self, ui: &mut Ui, commands: &mut Vec<Command>) {
        ui.horizontal(|ui| {
            if let Some(loading) = self.loading {
                show_loading(ui, loading, commands);
                return;
            }
            self.show_pause(ui, commands);
            ui.add(
                ProgressBar::new(self.fraction())
                    .desired_width(140.0)
                    .text(state_text(&self.status.state)),
            );
            ui.monospace(self.numbers());
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                ui.monospace(format!("{}×{}", self.size[0], self.size[1]));
                if self.has_added_light {
                    show_added_light(ui, commands);
                }
                if let Some(report) = self.report {
                    show_report_badge(ui, report, commands);
                }
                show_tree(ui, self.status.tree);
                if let Some(badge) = self.badge {
                    ui.colored_label(ui.visuals().warn_fg_color, badge);
                }
            });
        });
    }

    fn show_pause(&self, ui: &mut Ui, commands: &mut Vec<Command>) {
        if matches!(self.status.state, SessionState::Preparing { .. }) {
            if ui.button("Cancel").clicked() {
                commands.push(Command::CancelLoading);
            }
            return;
        }
        let is_paused = self.status.state == SessionState::Paused;
        let text = if is_paused { "Go on" } else { "Pause" };
        let is_possible = is_paused || self.status.state == SessionState::Rendering;
        let button = egui::Button::new(text).min_size(egui::vec2(52.0, 0.0));
        if ui.add_enabled(is_possible, button).clicked() {
            commands.push(Command::TogglePause);
        }
    }

    fn fraction(&self) -> f32 {
        let status = self.status;
        match status.state {
            SessionState::Preparing { fraction, .. } => fraction,
            SessionState::Finished(_) => 1.0,
            SessionState::Idle => 0.0,
            SessionState::Rendering | SessionState::Paused => {
                match (status.samples_target, status.eta_seconds) {
                    (_, Some(eta)) if status.seconds + eta > 0.0 => {
                        (status.seconds / (status.seconds + eta)) as f32
                    }
                    (Some(target), _) => (status.samples_mean / f64::from(target.max(1))) as f32,
                    _ => 0.0,
                }
            }
        }
    }

    /// Fixed columns, so that nothing moves while the numbers grow.
    fn numbers(&self) -> String {
        let status = self.status;
        let target = status
            .samples_target
            .map_or_else(String::new, |n| format!("/{n}"));
        let error = status
            .relative_error
            .map_or_else(String::new, |e| format!("error {:>4.1}%", e * 100.0));
        let eta = status
            .eta_seconds
            .map_or_else(String::new, |s| format!("{} left", duration(s)));
        let samples = if status.samples_mean.fract() == 0.0 {
            format!("{:.0}", status.samples_mean)
        } else {
            format!("{:.1}", status.samples_mean)
        };
        format!(
            "{:>9} spp  {:>6}  {error:<11}  {:>8}/s  {eta}",
            format!("{samples}{target}"),
            duration(status.seconds),
            count(status.samples_per_second),
        )
    }
}

fn show_loading(ui: &mut Ui, loading: &LoadStatus, commands: &mut Vec<Command>) {
    if ui.button("Cancel").clicked() {
        commands.push(Command::CancelLoading);
    }
    ui.add(
        ProgressBar::new(loading.fraction)
            .desired_width(220.0)
            .text(loading.stage),
    );
    ui.label(format!("Opening {}", loading.file));
}

/// A button to the report when something in the file was wrong or lost.
fn show_report_badge(ui: &mut Ui, report: &ImportReport, commands: &mut Vec<Command>) {
    let lost = report.notes.iter();
    let lost = lost
        .filter(|note| note.severity >= Severity::Dropped)
        .count();
    if lost > 0 {
        let text = format!("{lost} in the report");
        let help = "Parts of the file were wrong or have no effect on the picture.";
        if ui.small_button(text).on_hover_text(help).clicked() {
            commands.push(Command::ToggleReport);
        }
    }
}

/// A word on a hierarchy that is being made better, and a mark when it is.
fn show_tree(ui: &mut Ui, tree: TreeState) {
    let (text, help) = match tree {
        TreeState::AsBuilt => return,
        TreeState::Refining { fraction } => (
            format!("tree {:.0} %", fraction * 100.0),
            "A better tree of boxes is in the making; the picture will go on faster with it.",
        ),
        TreeState::Refined { .. } => (
            "tree refined".to_owned(),
            "The better tree of boxes is in use.",
        ),
        TreeState::NotRefined => (
            "tree not refined".to_owned(),
            "A fault ended the making of a better tree of boxes; the picture is not affected.",
        ),
    };
    ui.weak(text).on_hover_text(help);
}

fn show_added_light(ui: &mut Ui, commands: &mut Vec<Command>) {
    let help = "The scene has no light, so softbox added a soft sky. It is not part of the file.";
    if ui.small_button("Remove").on_hover_text(help).clicked() {
        commands.push(Command::RemoveAddedLight);
    }
    ui.colored_label(ui.visuals().warn_fg_color, "Added light")
        .on_hover_text(help);
}

fn state_text(state: &SessionState) -> &'static str {
    match state {
        SessionState::Idle => "idle",
        SessionState::Preparing { stage, .. } => stage,
        SessionState::Rendering => "rendering",
        SessionState::Paused => "paused",
        SessionState::Finished(reason) => match reason {
            StopReason::Samples => "done: samples",
            StopReason::Seconds => "done: time",
            StopReason::Error => "done: error",
            StopReason::Converged => "done: converged",
            StopReason::FirstHit => "done",
        },
    }
}

/// Seconds as people say them: 3.2 s, 4:05, 1:02:03.
pub(super) fn duration(seconds: f64) -> String {
    if seconds < 60.0 {
        return format!("{seconds:.1} s");
    }
    let whole = seconds as u64;
    let (hours, minutes, rest) = (whole / 3600, whole / 60 % 60, whole % 60);
    if hours > 0 {
        format!("{hours}:{minutes:02}:{rest:02}")
    } else {
        format!("{minutes}:{rest:02}")
    }
}
