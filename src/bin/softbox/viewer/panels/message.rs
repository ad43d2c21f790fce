//! Sentences for the user: errors stay until they are closed, news fade by themselves.

use eframe::egui::{self, Align2, Color32, Context, Frame, RichText, Window};

/// Seconds for which news are shown.
const NEWS: f64 = 4.0;

/// What is being said.
#[derive(Debug, Default)]
pub(in crate::viewer) struct Messages {
    error: Option<String>,
    news: Option<(String, f64)>,
    relayed: Option<String>,
}

impl Messages {
    /// Shows an error until it is closed.
    pub(in crate::viewer) fn fail(&mut self, sentence: impl Into<String>) {
        self.error = Some(sentence.into());
    }

    /// Shows a lasting state of another part as an error, once.
    pub(in crate::viewer) fn relay(&mut self, sentence: Option<&str>) {
        if sentence != self.relayed.as_deref() {
            self.relayed = sentence.map(str::to_owned);
            if let Some(sentence) = sentence {
                self.fail(sentence);
            }
        }
    }

    /// Shows a short confirmation; `now` in seconds.
    pub(in crate::viewer) fn tell(&mut self, sentence: impl Into<String>, now: f64) {
        self.news = Some((sentence.into(), now + NEWS));
    }

    /// Closes the error. True when there was one.
    pub(in crate::viewer) fn close(&mut self) -> bool {
        self.error.take().is_some()
    }

    /// Draws both.
    pub(in crate::viewer) fn show(&mut self, ctx: &Context) {
        self.show_error(ctx);
        let now = ctx.time();
        let Some((text, until)) = &self.news else {
            return;
        };
        let left = until - now;
        if left <= 0.0 {
            self.news = None;
            return;
        }
        ctx.request_repaint_after_secs(left as f32);
        egui::Area::new(egui::Id::unique("news"))
            .anchor(Align2::CENTER_TOP, [0.0, 36.0])
            .interactable(false)
            .show(ctx, |ui| {
                Frame::popup(ui.style()).show(ui, |ui| ui.label(text));
            });
    }

    fn show_error(&mut self, ctx: &Context) {
        let Some(sentence) = self.error.clone() else {
            return;
        };
        let mut is_open = true;
        let mut is_closed = false;
        Window::new("That did not work")
            .open(&mut is_open)
            .collapsible(false)
            .resizable(false)
            .anchor(Align2::CENTER_TOP, [0.0, 60.0])
            .show(ctx, |ui| {
                ui.set_max_width(460.0);
                let red = if ui.visuals().dark_mode {
                    Color32::from_rgb(255, 140, 120)
                } else {
                    Color32::from_rgb(160, 30, 20)
                };
                ui.label(RichText::new(sentence).color(red));
                is_closed = ui.button("Close").clicked();
            });
        if !is_open || is_closed {
            self.error = None;
        }
    }
}
