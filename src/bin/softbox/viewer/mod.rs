//! The window. `App` composes: the document says what is open, the engine renders it, panels show
//! and change it, keys and menus make commands that are carried out in one place.
//!
//! ```text
//!  keys, menus, panels ─ commands ─> execute ─> document ─ job every frame ─> session
//!  viewport <─ mailbox <─ presenter (tone mapping) <─ snapshot <─────────────────┘
//! ```

mod adjust;
mod app;
mod bvh_view;
mod command;
mod document;
mod engine;
mod error_curve;
mod event_log;
mod execute;
mod files;
mod history;
mod inspector;
mod keys;
mod latency;
mod letterbox;
mod loader;
mod navigation;
mod options;
mod orbit;
mod panels;
mod preferences;
mod presenter;
mod probe;
mod projection;
mod provenance;
mod ray_log;
mod reference_picture;
mod scorer;
mod shown;
mod snapshot_file;
#[cfg(test)]
mod tests;
mod viewport;
mod watcher;
mod window;
mod windows;

pub(crate) use window::run;
