//! The ray kernel: watertight, exact against brute force, robust against bad input.
//! The names G1 … G16 are those of the list of stress tests.

mod degenerate;
mod exact;
mod instances;
mod oracle;
mod packets;
mod quads;
mod scenes;
mod selfhit;
mod structure;
mod sweep;
mod watertight;
