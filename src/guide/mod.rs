//! Floor 4: where lights are seen through mirrors and glass. Light paths leave [`Photon`]s where they
//! arrive; a grid of cells over the surfaces keeps for each a few spheres on mirrors and glass
//! ([`Lobes`]) through which most of that light comes, so that scattered rays can be aimed at them.
//! Positions are in the normalised space of the prepared scene.
//!
//! After Jensen 1995, "Importance Driven Path Tracing using the Photon Map"; the directions of a cell
//! are kept as places, so that they turn with the point that looks.

mod build;
mod bundles;
mod cells;
mod cone;
mod lobes;
#[cfg(test)]
mod tests;

use glam::Vec3;

pub use build::Photon;
pub use cone::Cone;
pub use lobes::{LOBES, LobeSphere, Lobes};

use cells::CellTable;

/// Where to aim scattered rays so that they meet lights through mirrors and glass.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    cells: CellTable,
    lobes: Vec<Lobes>,
}

impl Guide {
    /// The lobes for a surface at `point`, lit on the side of the unit `normal`; `None` where no such
    /// light has arrived.
    #[inline]
    pub fn at(&self, point: Vec3, normal: Vec3) -> Option<&Lobes> {
        let cell = self.cells.find(point, normal)?;
        Some(&self.lobes[cell as usize])
    }

    /// The number of cells.
    pub fn len(&self) -> usize {
        self.lobes.len()
    }

    /// Always false: a guide has a cell.
    pub fn is_empty(&self) -> bool {
        false
    }
}
