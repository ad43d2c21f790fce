//! Floor 3: how far pictures are from the truth for the time they took, with the doubt that is
//! left: curves of error against processor time, their slopes, intervals and verdicts.
//!
//! Runs differ by their seed only. Nothing here renders or knows a clock.

mod bootstrap;
mod curve;
mod power_law;
mod quantile;
mod reference;
#[cfg(test)]
mod synthetic;
mod verdict;

pub use bootstrap::{FEWEST_RUNS, bootstrap_interval};
pub use curve::{Curve, Level, LevelFigures, Run};
pub use power_law::{PowerLaw, Reach, WeightedPoint};
pub use quantile::student_975;
pub use reference::Reference;
pub use verdict::{Outcome, Verdict};
