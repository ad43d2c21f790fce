use std::io::{IsTerminal, Write};

use crate::args::Reporting;

/// Seconds between two updates of the bar.
const BAR_INTERVAL: f64 = 0.1;
/// Seconds between two lines where there is no terminal.
const LINE_INTERVAL: f64 = 5.0;
/// Cells of the bar.
const BAR_CELLS: usize = 24;

/// How far a render is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Standing {
    /// Mean samples of each pixel so far.
    pub(crate) samples: f64,
    /// Samples at which it ends, if that ends it.
    pub(crate) target_samples: Option<u32>,
    /// Part of the work that is done, 0..1, by the rule that will end the render.
    pub(crate) fraction: Option<f64>,
    /// Seconds of rendering so far.
    pub(crate) seconds: f64,
    /// Estimated relative error of the picture, once there is one.
    pub(crate) relative_error: Option<f64>,
    /// Seconds left, once that can be told.
    pub(crate) seconds_left: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Style {
    Off,
    Bar,
    Lines,
}

/// Shows the standing of a render: a bar that is drawn over itself on a terminal, a line every few
/// seconds elsewhere when asked for by `-v`, else nothing.
#[derive(Debug)]
pub(crate) struct Progress<W> {
    out: W,
    style: Style,
    last_shown: Option<f64>,
    last_width: usize,
}

impl Progress<std::io::Stderr> {
    /// Shows on standard error.
    pub(crate) fn on_stderr(reporting: &Reporting) -> Self {
        let out = std::io::stderr();
        let is_terminal = out.is_terminal();
        Self::new(out, style(reporting, is_terminal))
    }
}

fn style(reporting: &Reporting, is_terminal: bool) -> Style {
    if reporting.quiet || reporting.no_progress {
        Style::Off
    } else if is_terminal {
        Style::Bar
    } else if reporting.verbose {
        Style::Lines
    } else {
        Style::Off
    }
}

impl<W: Write> Progress<W> {
    fn new(out: W, style: Style) -> Self {
        Self {
            out,
            style,
            last_shown: None,
            last_width: 0,
        }
    }

    /// Shows the standing unless the last one is too recent. A stream that refuses is not an error:
    /// the picture matters more.
    pub(crate) fn update(&mut self, standing: &Standing) {
        let interval = match self.style {
            Style::Off => return,
            Style::Bar => BAR_INTERVAL,
            Style::Lines => LINE_INTERVAL,
        };
        if self
            .last_shown
            .is_some_and(|at| standing.seconds < at + interval)
        {
            return;
        }
        self.last_shown = Some(standing.seconds);
        if self.style == Style::Lines {
            let _ = writeln!(self.out, "{}", text(standing));
            return;
        }
        let line = format!("{} {}", bar(standing.fraction), text(standing));
        let width = line.chars().count();
        let padding = self.last_width.saturating_sub(width);
        self.last_width = width;
        let _ = write!(self.out, "\r{line}{:padding$}", "");
        let _ = self.out.flush();
    }

    /// Removes the bar, so that the next message starts on an empty line. What is shown after that
    /// has a clock of its own.
    pub(crate) fn finish(&mut self) {
        self.last_shown = None;
        if self.last_width > 0 {
            let _ = write!(self.out, "\r{:1$}\r", "", self.last_width);
            let _ = self.out.flush();
            self.last_width = 0;
        }
    }
}

fn bar(fraction: Option<f64>) -> String {
    let full = (fraction.unwrap_or(0.0).clamp(0.0, 1.0) * BAR_CELLS as f64) as usize;
    format!("[{}{}]", "#".repeat(full), "-".repeat(BAR_CELLS - full))
}

fn text(standing: &Standing) -> String {
    let mut text = match standing.fraction {
        Some(fraction) => format!("{:3.0} %  ", 100.0 * fraction.clamp(0.0, 1.0)),
        None => String::new(),
    };
    text.push_str(&format!("{:.1}", standing.samples));
    if let Some(target) = standing.target_samples {
        text.push_str(&format!(" of {target}"));
    }
    text.push_str(&format!(" samples  {}", duration(standing.seconds)));
    if let Some(error) = standing.relative_error {
        text.push_str(&format!("  error {:.2} %", 100.0 * error));
    }
    if let Some(left) = standing.seconds_left {
        text.push_str(&format!("  {} left", duration(left)));
    }
    text
}

/// Seconds as `12.3 s`, `4:05 min` or `2:03:07 h`.
fn duration(seconds: f64) -> String {
    let whole = seconds.max(0.0).round() as u64;
    let (hours, minutes, rest) = (whole / 3600, whole / 60 % 60, whole % 60);
    if whole < 60 {
        format!("{seconds:.1} s")
    } else if hours == 0 {
        format!("{minutes}:{rest:02} min")
    } else {
        format!("{hours}:{minutes:02}:{rest:02} h")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(seconds: f64) -> Standing {
        Standing {
            samples: 4.0 * seconds,
            target_samples: Some(64),
            fraction: Some(seconds / 16.0),
            seconds,
            relative_error: (seconds > 1.0).then_some(0.0312),
            seconds_left: (seconds > 1.0).then_some(16.0 - seconds),
        }
    }

    fn shown(style: Style) -> String {
        let mut bytes = Vec::new();
        let mut progress = Progress::new(&mut bytes, style);
        for step in 0..=80 {
            progress.update(&at(f64::from(step) * 0.2));
        }
        progress.finish();
        String::from_utf8(bytes).unwrap()
    }

    #[test]
    fn without_a_terminal_lines_come_every_few_seconds() {
        let text = shown(Style::Lines);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 4, "{text}");
        assert_eq!(lines[0], "  0 %  0.0 of 64 samples  0.0 s");
        assert_eq!(
            lines[1],
            " 31 %  20.0 of 64 samples  5.0 s  error 3.12 %  11.0 s left"
        );
        assert!(!text.contains('\r'));
    }

    #[test]
    fn the_bar_is_drawn_over_itself_and_leaves_an_empty_line() {
        let text = shown(Style::Bar);
        assert!(!text.contains('\n'));
        let frames: Vec<&str> = text.split('\r').collect();
        assert!(frames.contains(&"[############------------]  50 %  32.0 of 64 samples  8.0 s  error 3.12 %  8.0 s left"), "{text}");
        assert!(text.ends_with(" \r"));
        // Every frame covers the one before it.
        let widths: Vec<usize> = frames.iter().map(|f| f.trim_end().len()).collect();
        for (frame, before) in frames[2..].iter().zip(&widths[1..]) {
            assert!(frame.is_empty() || frame.len() >= *before, "{text}");
        }
    }

    #[test]
    fn work_that_begins_after_the_end_is_shown_at_once() {
        let mut bytes = Vec::new();
        let mut progress = Progress::new(&mut bytes, Style::Lines);
        progress.update(&at(12.0));
        progress.finish();
        progress.update(&at(0.0));
        let text = String::from_utf8(bytes).unwrap();
        assert_eq!(text.lines().count(), 2, "{text}");
    }

    #[test]
    fn a_quiet_run_shows_nothing_on_standard_error() {
        let reporting = Reporting {
            quiet: true,
            ..Reporting::default()
        };
        assert_eq!(Progress::on_stderr(&reporting).style, Style::Off);
    }

    #[test]
    fn silence_is_kept_where_it_is_asked_for() {
        assert_eq!(shown(Style::Off), "");
        let reporting = |quiet, no_progress, verbose| Reporting {
            json: false,
            quiet,
            no_progress,
            verbose,
        };
        assert_eq!(style(&reporting(true, false, false), true), Style::Off);
        assert_eq!(style(&reporting(false, true, true), true), Style::Off);
        assert_eq!(style(&reporting(false, false, false), true), Style::Bar);
        assert_eq!(style(&reporting(false, false, false), false), Style::Off);
        assert_eq!(style(&reporting(false, false, true), false), Style::Lines);
    }

    #[test]
    fn durations_are_short() {
        assert_eq!(duration(59.4), "59.4 s");
        assert_eq!(duration(59.97), "1:00 min");
        assert_eq!(duration(7387.0), "2:03:07 h");
    }
}
