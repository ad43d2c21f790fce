use anyhow::anyhow;

use crate::args::WindowArgs;
use crate::command_line::command_line;
use crate::exit::{Failure, Status};
use crate::job::Job;

/// Opens the window.
pub(crate) fn run(job: &Job, options: &WindowArgs) -> Result<(), Failure> {
    let renderer = options.renderer.as_deref().unwrap_or("glow");
    Err(Failure {
        status: Status::Failed,
        error: anyhow!(
            "This build has no {renderer} window yet; asked for: {}",
            command_line(job)
        ),
    })
}
