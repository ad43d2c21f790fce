//! Shared by the tests that render.
#![expect(unreachable_pub, reason = "shared by several test crates")]

pub mod measure;
pub mod scenes;
