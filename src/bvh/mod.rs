//! Floor 2: the bounding volume hierarchy over boxes. Knows no shape: leaves are tested through a
//! trait that the caller implements.

mod settings;

pub use settings::{BvhKind, BvhSettings};
