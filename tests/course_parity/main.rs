//! The course's program and ours: the same brightness where its picture is asked for.

#[path = "../beside/mod.rs"]
mod beside;

mod files;
mod lights;
