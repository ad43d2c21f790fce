//! All ways to estimate a picture give the same picture (tests S10 to S12 of the stress list).

#[path = "../support/mod.rs"]
mod support;

mod agreement;
mod scenes;
mod sums;
mod welch;
