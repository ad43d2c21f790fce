use std::ops::Range;

use glam::Vec3;

use super::node::{LEAF, Part, WIDTH};
use super::tree::{BLOCK, Bvh};

impl Bvh {
    /// Number of wide nodes and blocks in whose boxes `point` lies although its primitive is not
    /// below them. `is_own` tells whether some of these places, as in [`Self::leaves`], hold the
    /// primitive.
    ///
    /// The mean over points spread evenly on the surfaces is the end-point overlap. Aila, Karras,
    /// Laine 2013, "On Quality Metrics of Bounding Volume Hierarchies".
    pub fn overlap_at(&self, point: Vec3, is_own: &impl Fn(Range<usize>) -> bool) -> usize {
        let mut overlap = 0;
        if !self.nodes().is_empty() && !self.add_overlap(0, point, is_own, &mut overlap) {
            // The root itself.
            overlap += 1;
        }
        overlap
    }

    /// Adds what is below wide node `index`; returns whether the primitive is there.
    fn add_overlap(
        &self,
        index: usize,
        point: Vec3,
        is_own: &impl Fn(Range<usize>) -> bool,
        overlap: &mut usize,
    ) -> bool {
        let node = &self.nodes()[index];
        let mut found = false;
        for slot in 0..WIDTH {
            let reference = node.children[slot];
            let bounds = node.bounds(slot as Part);
            let inside = point.cmpge(bounds.min) & point.cmple(bounds.max);
            if reference == 0 || !inside.all() {
                continue;
            }
            let (own, cost) = if reference & LEAF == 0 {
                let own = self.add_overlap(reference as usize, point, is_own, overlap);
                (own, 1)
            } else {
                let places = node.places(slot as Part);
                let count = places.len().div_ceil(BLOCK);
                (is_own(places), count)
            };
            found |= own;
            *overlap += if own { 0 } else { cost };
        }
        found
    }
}
