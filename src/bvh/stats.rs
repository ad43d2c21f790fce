use std::collections::BTreeMap;

use serde::Serialize;

use super::tree::Bvh;

/// Cost of visiting an inner node of the binary tree, in units of testing one primitive.
const NODE_COST: f32 = 2.0;

/// Shape and cost of a tree.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct BvhStats {
    /// Nodes, leaves included.
    pub nodes: usize,
    /// Leaves.
    pub leaves: usize,
    /// Primitives in the tree.
    pub primitives: usize,
    /// How many of them are two triangles that share an edge.
    pub quads: usize,
    /// Primitives left out because they have no area or no finite box.
    pub excluded: usize,
    /// Depth of the deepest leaf; the root has depth 0.
    pub max_depth: usize,
    /// Mean depth of the leaves.
    pub mean_leaf_depth: f64,
    /// Expected cost of a random ray that meets the root's box, in primitive tests, by the
    /// surface-area heuristic. MacDonald and Booth 1990, "Heuristics for ray tracing using space
    /// subdivision".
    pub sah_cost: f64,
    /// Wide nodes that a random ray that meets the root's box is expected to visit.
    pub expected_nodes: f64,
    /// Blocks of primitives that it is expected to visit.
    pub expected_blocks: f64,
    /// Primitives in the largest leaf.
    pub largest_leaf: usize,
    /// Number of leaves by number of primitives.
    pub leaf_histogram: BTreeMap<usize, usize>,
    /// Memory in bytes.
    pub bytes: usize,
    /// Memory in bytes by shape; a quad is two.
    pub bytes_per_shape: f64,
    /// Wall-clock time of the build in seconds.
    pub build_seconds: f64,
}

impl BvhStats {
    /// With this memory.
    pub fn set_bytes(&mut self, bytes: usize) {
        self.bytes = bytes;
        let shapes = self.primitives + self.quads;
        self.bytes_per_shape = bytes as f64 / shapes.max(1) as f64;
    }
}

impl Bvh {
    /// Walks the tree, which knows nothing of quads.
    pub fn stats(&self) -> BvhStats {
        let mut stats = BvhStats {
            nodes: self.node_count(),
            primitives: self.primitive_count(),
            excluded: self.excluded(),
            bytes: self.bytes(),
            build_seconds: self.build_time().as_secs_f64(),
            ..BvhStats::default()
        };
        let Some(root) = self.root() else {
            return stats;
        };
        (stats.expected_nodes, stats.expected_blocks) = self.expected_visits();
        stats.set_bytes(stats.bytes);
        let mut depth_sum = 0;
        let mut cost = 0.0;
        let mut open = vec![(root, 0)];
        while let Some((node, depth)) = open.pop() {
            let area = f64::from(self.bounds(node).half_area());
            if let Some(children) = self.children(node) {
                cost += area * f64::from(NODE_COST);
                open.extend(children.map(|c| (c, depth + 1)));
            } else {
                let size = self.primitives_below(node);
                cost += area * size as f64;
                depth_sum += depth;
                stats.leaves += 1;
                stats.max_depth = stats.max_depth.max(depth);
                stats.largest_leaf = stats.largest_leaf.max(size);
                *stats.leaf_histogram.entry(size).or_default() += 1;
            }
        }
        stats.mean_leaf_depth = depth_sum as f64 / stats.leaves as f64;
        stats.sah_cost = cost / f64::from(self.bounds(root).half_area());
        stats
    }
}
