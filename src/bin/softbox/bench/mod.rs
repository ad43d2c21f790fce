//! `softbox bench`: error against processor time, of any scene in any mode.
//!
//! - A picture goes on from one number of samples to the next; nothing is rendered twice.
//! - Modes take turns at every number of samples, so that what disturbs the machine disturbs all.
//! - Time is processor time of the workers. Building, refining the hierarchy (as a render would in the
//!   background) and scoring are not part of it.
//! - The reference comes from another estimator and other seeds, in two halves whose difference
//!   tells its noise, which is subtracted; or from a file.

mod measure;
mod plot;
mod reference;
mod report;
mod results_file;
mod scene;
mod table;

use std::io::Write;
use std::path::PathBuf;
use std::sync::atomic::Ordering;

use anyhow::{Context, anyhow};
use softbox::io::builtin_names;
use softbox::io::picture::{Metadata, check_writable, write_png};

use crate::bench_args::BenchArgs;
use crate::exit::{Failure, Status};
use crate::interrupt;
use crate::progress::Progress;
use report::SceneReport;

/// Measures and prints the figures on standard output.
pub(crate) fn run(args: &BenchArgs) -> Result<(), Failure> {
    if let Some(path) = &args.plot {
        check_plot(path)?;
    }
    if let Some(path) = &args.append {
        results_file::check(path)?;
    }
    let mut scenes = args.scenes.clone();
    if scenes.is_empty() {
        scenes.extend(builtin_names().map(PathBuf::from));
    }
    let interrupted = interrupt::on_interrupt(|| {})?;
    let stop = || interrupted.load(Ordering::Relaxed);
    let mut progress = Progress::on_stderr(&args.reporting);
    let mut reports: Vec<SceneReport> = Vec::new();
    let mut failure = None;
    for path in scenes {
        if stop() {
            break;
        }
        match scene::measure(args, path, &mut progress, &stop) {
            Ok(Some(report)) => {
                progress.finish();
                tell(args, &report)?;
                reports.push(report);
            }
            Ok(None) => break,
            Err(error) => {
                failure = Some(error);
                break;
            }
        }
    }
    progress.finish();
    write_all(args, &reports)?;
    match failure {
        Some(failure) => Err(failure),
        None if stop() => Err(Status::Interrupted.because()(anyhow!(
            if reports.is_empty() {
                "Interrupted before anything was measured."
            } else {
                "Interrupted; what there was is written."
            }
        ))),
        None => Ok(()),
    }
}

/// What is told of a scene as soon as it is done.
fn tell(args: &BenchArgs, report: &SceneReport) -> Result<(), Failure> {
    if let (Some(warning), false) = (report.warning(), args.reporting.quiet) {
        writeln!(std::io::stderr().lock(), "{warning}").map_err(Status::Failed.because())?;
    }
    if !args.reporting.json {
        table::write(&mut std::io::stdout().lock(), report)
            .context("Cannot write to standard output")
            .map_err(Status::Failed.because())?;
    }
    if let Some(path) = &args.append {
        results_file::append(path, report)?;
    }
    Ok(())
}

/// What is told at the end of all scenes.
fn write_all(args: &BenchArgs, reports: &[SceneReport]) -> Result<(), Failure> {
    if args.reporting.json {
        let print = || -> std::io::Result<()> {
            let mut out = std::io::stdout().lock();
            serde_json::to_writer_pretty(&mut out, reports)?;
            writeln!(out)
        };
        print()
            .context("Cannot write to standard output")
            .map_err(Status::Failed.because())?;
    }
    let Some(path) = args.plot.as_ref().filter(|_| !reports.is_empty()) else {
        return Ok(());
    };
    let (width, height) = plot::SIZE;
    let pixels = plot::draw(reports).map_err(Status::Failed.because())?;
    write_png(path, width, height, &pixels, &Metadata::default()).map_err(Status::Output.because())
}

fn check_plot(path: &std::path::Path) -> Result<(), Failure> {
    if path
        .extension()
        .is_none_or(|e| !e.eq_ignore_ascii_case("png"))
    {
        return Err(Status::Output.because()(anyhow!(
            "Cannot write '{}': curves are drawn into .png files only.",
            path.display()
        )));
    }
    check_writable(path).map_err(Status::Output.because())
}

#[cfg(test)]
mod tests;
