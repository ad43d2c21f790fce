//! Floor 7: files in and out.

pub mod picture;
