use super::node::{LEAF, Part, WIDTH};
use super::tree::{BLOCK, Bvh};

impl Bvh {
    /// Wide nodes and blocks that a random ray through the root's box is expected to meet, by the
    /// surface-area heuristic.
    ///
    /// MacDonald and Booth 1990, "Heuristics for ray tracing using space subdivision".
    pub fn expected_visits(&self) -> (f64, f64) {
        let Some(root) = self.root() else {
            return (0.0, 0.0);
        };
        let all = f64::from(self.bounds(root).half_area());
        let (mut nodes, mut blocks) = (all, 0.0);
        for node in self.nodes() {
            for slot in 0..WIDTH {
                let reference = node.children[slot];
                if reference == 0 {
                    continue;
                }
                let area = f64::from(node.bounds(slot as Part).half_area());
                if reference & LEAF == 0 {
                    nodes += area;
                } else {
                    let count = node.leaf_primitives(slot as Part).div_ceil(BLOCK);
                    blocks += area * count as f64;
                }
            }
        }
        if all > 0.0 {
            (nodes / all, blocks / all)
        } else {
            (1.0, 1.0)
        }
    }
}
