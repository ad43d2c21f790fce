use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::Context;

use crate::exit::{Failure, Status};

/// Becomes true when Ctrl+C is pressed; `on_first` is called then. The second time the program ends
/// at once. Once in a process.
pub(crate) fn on_interrupt(
    on_first: impl Fn() + Send + 'static,
) -> Result<Arc<AtomicBool>, Failure> {
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&interrupted);
    ctrlc::set_handler(move || {
        if flag.swap(true, Ordering::Relaxed) {
            // The second time there is no waiting for files.
            std::process::exit(i32::from(Status::Interrupted as u8));
        }
        on_first();
    })
    .context("Cannot listen for Ctrl+C")
    .map_err(Status::Failed.because())?;
    Ok(interrupted)
}
