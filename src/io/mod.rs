//! Floor 7: files in and out. Reading gives a [`crate::scene::Scene`] with a report of what was
//! read, guessed and dropped.

pub mod camera_file;
mod collada;
mod error;
mod load;
pub mod picture;
mod progress;
mod report;

pub use collada::read_collada;
pub use error::ImportError;
pub use load::{Loaded, load_scene};
pub use progress::{LoadProgress, LoadStage};
pub use report::{ImportReport, ReadCounts, ReportNote, Severity};
