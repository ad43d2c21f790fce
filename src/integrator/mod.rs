//! Floor 6: what one path carries back to the camera.
//!
//! `path` holds the steps of a path, each a few lines; `reference` takes them for one path at a
//! time and is the teaching text and the oracle; `wavefront` takes the same steps for a batch of
//! paths, stage by stage. Both draw the same random numbers and give the same bits.
//! `reuse` is how paths of neighbouring pixels lend each other their light.
//! `double` is the reference once more in double precision, with formulas of its own.
//! `first_hit` answers the views that need no light. Nothing here knows threads, films or clocks.

mod counts;
mod direct;
mod double;
mod first_hit;
mod furnace;
mod guided;
mod path;
mod reference;
mod reuse;
mod wavefront;

pub use counts::PathCounts;
pub use direct::DirectPlan;
pub use double::reference_f64;
pub use first_hit::first_hit;
pub use path::{Path, PathId, PathSettings, PathTracer};
pub use reference::{reference, reference_cluster};
pub use reuse::MAX_CLUSTER;
pub use wavefront::{BATCH_SIZE, Wavefront};
