//! Meshes that instances share: the same pictures as with copies, in little memory, and edits that
//! move objects build nothing again.

mod edits;
mod pictures;
mod scenes;
