use std::fs::OpenOptions;
use std::io::Write;
use std::path::Path;

use anyhow::Context;

use super::report::{Method, SceneReport, TARGETS};
use super::table;
use crate::exit::{Failure, Status};

/// Finds out before any time is spent whether lines can be appended.
pub(super) fn check(path: &Path) -> Result<(), Failure> {
    let existed = path.exists();
    open(path)?;
    if !existed {
        // Only tried; an empty file would be left behind by a run that ends early.
        std::fs::remove_file(path).map_err(Status::Output.because())?;
    }
    Ok(())
}

fn open(path: &Path) -> Result<std::fs::File, Failure> {
    OpenOptions::new()
        .append(true)
        .create(true)
        .open(path)
        .with_context(|| format!("Cannot write '{}'", path.display()))
        .map_err(Status::Output.because())
}

/// Appends a line for each method of `report`, in a new file after a line of headings.
pub(super) fn append(path: &Path, report: &SceneReport) -> Result<(), Failure> {
    let mut file = open(path)?;
    let is_new = file.metadata().is_ok_and(|data| data.len() == 0);
    let mut text = String::new();
    if is_new {
        text.push_str(&headings());
    }
    for method in &report.methods {
        text.push_str(&row(report, method).unwrap_or_default());
    }
    file.write_all(text.as_bytes())
        .with_context(|| format!("Cannot write '{}'", path.display()))
        .map_err(Status::Output.because())
}

fn headings() -> String {
    let mut line = format!(
        "# {:<20} {:<16} {:>4} {:>2} {:>9} {:>7} {:>9} {:>9} {:>7} {:>9} {:>9} {:>9} {:>14}",
        "scene",
        "mode",
        "spp",
        "n",
        "cpu s",
        "Mray/s",
        "relMSE",
        "trimmed",
        "mean",
        "effic.",
        "low",
        "high",
        "slope"
    );
    for target in TARGETS {
        line += &format!(" {:>10}", format!("s to {target:.0e}"));
    }
    line + "  command\n"
}

/// The figures of the most samples; `None` for a method without any.
fn row(report: &SceneReport, method: &Method) -> Option<String> {
    let level = method.levels.last()?;
    let number = |value: Option<f64>| value.map_or("-".to_owned(), |v| format!("{v:.2}"));
    let [low, high] = match level.efficiency_interval {
        Some(interval) => interval.map(Some),
        None => [None, None],
    };
    let slope = method
        .power_law
        .map_or("-".to_owned(), |law| table::slope(&law).replace(' ', ""));
    let mut line = format!(
        "  {:<20} {:<16} {:>4} {:>2} {:>9.4} {:>7.2} {:>9.3e} {:>9.3e} {:>7.4} {:>9} {:>9} {:>9} {slope:>14}",
        report.scene,
        method.mode,
        level.samples_per_pixel,
        level.seeds,
        level.cpu_seconds,
        level.rays / level.cpu_seconds.max(1e-9) * 1e-6,
        level.rel_mse,
        level.rel_mse_trimmed,
        level.mean_ratio,
        number(level.efficiency),
        number(low),
        number(high),
    );
    for target in TARGETS {
        let reach = method.seconds_to.iter().find(|r| r.rel_mse == target);
        let text = reach.map_or("-".to_owned(), |r| {
            let mark = if r.is_extrapolated { "~" } else { "" };
            format!("{mark}{:.3}", r.cpu_seconds)
        });
        line += &format!(" {text:>10}");
    }
    Some(format!("{line}  {}\n", report.command))
}
