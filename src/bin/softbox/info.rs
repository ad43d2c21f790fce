use anyhow::anyhow;

use crate::args::InfoArgs;
use crate::exit::{Failure, Status};
use crate::render::check_readable;

/// Prints what a scene file holds.
pub(crate) fn run(args: &InfoArgs) -> Result<(), Failure> {
    check_readable(&args.scene)?;
    let form = if args.json { "JSON" } else { "text" };
    Err(Failure {
        status: Status::Failed,
        error: anyhow!("This build cannot describe scenes as {form} yet."),
    })
}
