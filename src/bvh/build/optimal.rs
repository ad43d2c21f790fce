use super::binary::BinaryNode;
use super::bins::blocks;
use crate::bvh::node::WIDTH;

/// Subtrees with more primitives are worked on in parallel.
pub(super) const SERIAL: usize = 8192;

/// Cost of a wide node, in units of testing a block.
const NODE_COST: f32 = 1.0;

/// A binary tree depth first: the left child stands behind its parent, the right one behind all
/// that is below the left.
#[derive(Debug)]
pub(super) struct DepthFirst {
    pub(super) nodes: Vec<BinaryNode>,
    /// Primitives below each node.
    pub(super) counts: Vec<u32>,
    /// Nodes above the deepest leaf.
    pub(super) depth: usize,
}

impl DepthFirst {
    /// Takes a tree with its root first and the others anywhere.
    pub(super) fn new(tree: &[BinaryNode]) -> Self {
        let mut nodes = Vec::with_capacity(tree.len());
        let mut depth = 0;
        let mut open = vec![(0, 0)];
        while let Some((index, above)) = open.pop() {
            let node = tree[index as usize];
            nodes.push(node);
            depth = depth.max(above);
            if let Some([left, right]) = node.children() {
                open.extend([(right, above + 1), (left, above + 1)]);
            }
        }
        // Backwards, children come before their parents.
        let mut counts = vec![1; nodes.len()];
        for i in (0..nodes.len()).rev() {
            if nodes[i].children().is_some() {
                let left = counts[i + 1];
                counts[i] = left + counts[i + 2 * left as usize];
            }
        }
        Self {
            nodes,
            counts,
            depth,
        }
    }
}

/// What becomes of a node, for each number of places that it is given in a wide node above.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Choice {
    /// Places that the left child gets of i + 2 places; 0: the node takes one place less.
    left: [u8; WIDTH - 1],
    /// Alone in its place: a leaf, not a wide node.
    pub(super) is_leaf: bool,
}

impl Choice {
    /// How many the left child gets of how many of `places`; `None` if the node takes one for
    /// itself.
    pub(super) fn left(&self, mut places: usize) -> Option<(usize, usize)> {
        places = places.min(WIDTH - 1);
        while places > 1 {
            match self.left[places - 2] {
                0 => places -= 1,
                left => return Some((left.into(), places)),
            }
        }
        None
    }

    /// How many of the eight places of its own wide node the left child gets.
    pub(super) fn left_of_all(&self) -> usize {
        self.left[WIDTH - 2].into()
    }
}

/// Costs of a subtree that is given 1, 2, … 7 places in a wide node above.
type Costs = [f32; WIDTH - 1];

/// Chooses for each node of a subtree what makes its expected cost least, given that leaves hold up
/// to `leaf_size` primitives.
///
/// Ylitie, Karras, Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
/// BVHs", section 3.1.
pub(super) fn choose(
    nodes: &[BinaryNode],
    counts: &[u32],
    choices: &mut [Choice],
    leaf_size: u32,
) -> Costs {
    let (count, area) = (counts[0], nodes[0].bounds().half_area());
    let as_leaf = if count <= leaf_size {
        area * blocks(count, 2)
    } else {
        f32::INFINITY
    };
    let (choice, below) = choices.split_first_mut().expect("a subtree is not empty");
    if count == 1 {
        choice.is_leaf = true;
        return [as_leaf; WIDTH - 1];
    }
    let left_nodes = 2 * counts[1] as usize - 1;
    let (left_nodes, right_nodes) = nodes[1..].split_at(left_nodes);
    let (left_counts, right_counts) = counts[1..].split_at(left_nodes.len());
    let (left_choices, right_choices) = below.split_at_mut(left_nodes.len());
    let mut halves = [
        (left_nodes, left_counts, left_choices),
        (right_nodes, right_counts, right_choices),
    ];
    let [l, r] = &mut halves;
    let (left, right) = if count as usize > SERIAL {
        rayon::join(
            || choose(l.0, l.1, l.2, leaf_size),
            || choose(r.0, r.1, r.2, leaf_size),
        )
    } else {
        (
            choose(l.0, l.1, l.2, leaf_size),
            choose(r.0, r.1, r.2, leaf_size),
        )
    };
    let best = |places: usize| {
        let mut best = (f32::INFINITY, 1);
        for to_left in 1..places {
            let cost = left[to_left - 1] + right[places - to_left - 1];
            if cost < best.0 {
                best = (cost, to_left);
            }
        }
        best
    };
    let (all, to_left) = best(WIDTH);
    choice.left[WIDTH - 2] = to_left as u8;
    let as_node = all + area * NODE_COST;
    choice.is_leaf = as_leaf <= as_node;
    let mut costs = [as_leaf.min(as_node); WIDTH - 1];
    for places in 2..WIDTH {
        let (cost, to_left) = best(places);
        costs[places - 1] = costs[places - 2];
        if cost < costs[places - 2] {
            costs[places - 1] = cost;
            choice.left[places - 2] = to_left as u8;
        }
    }
    costs
}
