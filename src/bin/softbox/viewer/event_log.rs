//! For tests with a real window: one line of state on standard error whenever something changes,
//! and an end after a given time.

use std::io::Write;
use std::time::{Duration, Instant};

use eframe::egui::{Context, ViewportCommand};
use softbox::session::{SessionState, SessionStatus};

use super::document::Document;
use super::latency::LatencySummary;

/// The last line, and when to leave.
#[derive(Debug)]
pub(super) struct EventLog {
    is_on: bool,
    last: String,
    leaves_at: Option<Instant>,
}

impl EventLog {
    /// A log that writes if `is_on`, and ends the program after `exit_after`.
    pub(super) fn new(is_on: bool, exit_after: Option<Duration>) -> Self {
        Self {
            is_on,
            last: String::new(),
            leaves_at: exit_after.map(|after| Instant::now() + after),
        }
    }

    /// Writes the state when it differs from the last one.
    pub(super) fn note(
        &mut self,
        document: &Document,
        status: &SessionStatus,
        latency: Option<LatencySummary>,
    ) {
        if !self.is_on {
            return;
        }
        let line = state_line(document, status);
        if line != self.last {
            self.say(&line);
            if let Some(latency) = latency {
                self.say(&format!("latency {latency}"));
            }
            self.last = line;
        }
    }

    /// Writes one line.
    pub(super) fn say(&self, line: &str) {
        if self.is_on {
            // A closed standard error is no reason to stop.
            drop(writeln!(std::io::stderr().lock(), "softbox: {line}"));
        }
    }

    /// Closes the window when it is time, and wakes an idle one for that.
    pub(super) fn exit_when_due(&self, ctx: &Context) {
        let Some(leaves_at) = self.leaves_at else {
            return;
        };
        let left = leaves_at.saturating_duration_since(Instant::now());
        if left.is_zero() {
            ctx.send_viewport_cmd(ViewportCommand::Close);
        } else {
            ctx.request_repaint_after(left);
        }
    }
}

fn state_line(document: &Document, status: &SessionStatus) -> String {
    let eye = document.camera.eye;
    let settings = &document.settings;
    let state = match status.state {
        SessionState::Idle => "idle",
        SessionState::Preparing { .. } => "preparing",
        SessionState::Rendering => "rendering",
        SessionState::Paused => "paused",
        SessionState::Finished(_) => "finished",
    };
    let region = settings.region.map_or_else(
        || "none".to_owned(),
        |r| format!("{},{},{},{}", r.x, r.y, r.width, r.height),
    );
    format!(
        "state scene={} state={state} view={} size={}x{} eye={:.4},{:.4},{:.4} mode={} exposure={} region={region}",
        document.name(),
        settings.view.name(),
        settings.width,
        settings.height,
        eye.x,
        eye.y,
        eye.z,
        settings.mode.name(),
        document.display.exposure,
    )
}
