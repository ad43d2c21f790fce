//! Floor 7: files in and out.

pub mod camera_file;
pub mod picture;
