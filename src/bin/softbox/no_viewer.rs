use anyhow::anyhow;

use crate::args::WindowArgs;
use crate::exit::{Failure, Status};
use crate::job::Job;

/// Says that this build has no window.
pub(crate) fn run(_job: &Job, _window: &WindowArgs) -> Result<(), Failure> {
    Err(Failure {
        status: Status::Failed,
        error: anyhow!(
            "This build has no window. Render without one: softbox render SCENE -o OUT.png"
        ),
    })
}
