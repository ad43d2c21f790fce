use std::fs::File;
use std::io::Write;
use std::path::Path;

use anyhow::{Context, anyhow};
use softbox::io::picture::check_writable;

use crate::args::Reporting;
use crate::command_line::command_line;
use crate::exit::{Failure, Status};
use crate::job::Job;

/// Renders a job into its files.
pub(crate) fn run(job: &Job, reporting: &Reporting) -> Result<(), Failure> {
    check_outputs(job)?;
    if let Some(scene) = &job.scene {
        check_readable(scene)?;
    }
    if reporting.verbose {
        let mut stderr = std::io::stderr().lock();
        writeln!(stderr, "{}", command_line(job)).map_err(Status::Failed.because())?;
    }
    Err(Failure {
        status: Status::Failed,
        error: anyhow!("This build cannot render yet."),
    })
}

/// Finds outputs that cannot be written before any time is spent on the picture.
fn check_outputs(job: &Job) -> Result<(), Failure> {
    for output in job.outputs.iter().chain(&job.rate_picture) {
        check_writable(output).map_err(Status::Output.because())?;
    }
    Ok(())
}

/// Finds scene files that cannot be opened.
pub(crate) fn check_readable(scene: &Path) -> Result<(), Failure> {
    let is_folder = scene.is_dir();
    let opened = File::open(scene).map_err(anyhow::Error::from);
    let opened = opened.and_then(|_| match is_folder {
        true => Err(anyhow!("it is a folder")),
        false => Ok(()),
    });
    opened
        .with_context(|| format!("Cannot read the scene '{}'", scene.display()))
        .map_err(Status::Scene.because())
}
