//! A hierarchy over the parts of all lights that have a place: chooses one by about what it gives
//! at a surface point, one random number for all levels.

mod build;
mod node;
mod split;
#[cfg(test)]
mod tests;

use glam::Vec3;

use super::bounds::EmissionBounds;
use crate::sampling::ONE_MINUS_EPSILON;
use build::{Item, build};
use node::{Node, WIDTH};

pub use node::{LightCluster, Link};

/// Trail of a part that is not in the tree.
const ABSENT: u64 = u64::MAX;

/// A hierarchy over parts of lights, numbered from 0; each node has up to 8 children.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LightTree {
    /// `None` when there is no part.
    root: Option<Link>,
    nodes: Vec<Node>,
    /// For each part its places in the nodes from the root down, three bits each.
    trails: Vec<u64>,
}

impl LightTree {
    /// The tree over the parts that have bounds; others are never chosen.
    pub(super) fn new(parts: impl IntoIterator<Item = Option<EmissionBounds>>) -> Self {
        let mut items = Vec::new();
        let mut trails = Vec::new();
        for (bounds, part) in parts.into_iter().zip(0..) {
            trails.push(ABSENT);
            items.extend(bounds.map(|bounds| Item { part, bounds }));
        }
        let (root, nodes) = match items.as_slice() {
            [] => (None, Vec::new()),
            [item] => {
                trails[item.part as usize] = 0;
                (Some(Link::Part(item.part as usize)), Vec::new())
            }
            _ => {
                let nodes = build(items, |part, trail| trails[part as usize] = trail);
                (Some(Link::Node(0)), nodes)
            }
        };
        Self {
            root,
            nodes,
            trails,
        }
    }

    /// Where every choice starts; `None` when there is nothing to choose.
    pub fn root(&self) -> Option<Link> {
        self.root
    }

    /// A part that may light a surface at `point` on the side of the unit `normal`, and the
    /// probability of that choice, which is above 0; `u` in [0, 1). `None` when `u` falls on
    /// parts of which none lights the surface.
    pub fn sample(&self, point: Vec3, normal: Vec3, u: f32) -> Option<(usize, f32)> {
        let (mut link, mut u, mut pmf) = (self.root?, u, 1.0);
        loop {
            let node = match link {
                Link::Part(part) => return (pmf > 0.0).then_some((part, pmf)),
                Link::Node(node) => &self.nodes[node],
            };
            let importance = node.importance(point, normal);
            let ends = running_sums(&importance);
            if ends[WIDTH - 1] <= 0.0 {
                return None;
            }
            let child;
            (child, u) = choose(&importance, &ends, u);
            pmf *= importance[child] / ends[WIDTH - 1];
            link = node.link(child);
        }
    }

    /// The probability with which [`Self::sample`] gives `part` for the same point and normal.
    pub fn pmf(&self, point: Vec3, normal: Vec3, part: usize) -> f32 {
        let (Some(mut link), Some(mut trail)) = (self.root, self.trail(part)) else {
            return 0.0;
        };
        let mut pmf = 1.0;
        while let (Link::Node(node), Some(child)) = (link, trail.next()) {
            let node = &self.nodes[node];
            let importance = node.importance(point, normal);
            if importance[child] <= 0.0 {
                return 0.0;
            }
            pmf *= importance[child] / running_sums(&importance)[WIDTH - 1];
            link = node.link(child);
        }
        pmf
    }

    /// The places in the nodes, from the root down, that lead to `part`, and zeros for ever after;
    /// `None` when the part is not in the tree.
    pub fn trail(&self, part: usize) -> Option<impl Iterator<Item = usize> + use<>> {
        let trail = *self.trails.get(part).filter(|&&trail| trail != ABSENT)?;
        let rests = std::iter::successors(Some(trail), |rest| Some(rest >> 3));
        Some(rests.map(|rest| (rest & 7) as usize))
    }

    /// The children of node `index`, in order.
    pub fn clusters(&self, index: usize) -> impl Iterator<Item = LightCluster> + '_ {
        (0..WIDTH).filter_map(move |i| self.nodes[index].cluster(i))
    }
}

/// The sums of the first one, two and so on, which never fall.
fn running_sums(importance: &[f32; WIDTH]) -> [f32; WIDTH] {
    let [a, b, c, d, e, f, g, h] = *importance;
    let (ab, ef) = (a + b, e + f);
    let abcd = ab + (c + d);
    [
        a,
        ab,
        ab + c,
        abcd,
        abcd + e,
        abcd + ef,
        abcd + (ef + g),
        abcd + (ef + (g + h)),
    ]
}

/// The child that `u` in [0, 1) falls on, and `u` stretched over it, in [0, 1) again. A child of
/// importance 0 is never chosen if there is another.
fn choose(importance: &[f32; WIDTH], ends: &[f32; WIDTH], u: f32) -> (usize, f32) {
    // Less than the last sum even when rounded, because `u` is at most 1 − 2⁻²⁴.
    let target = u.min(ONE_MINUS_EPSILON) * ends[WIDTH - 1];
    let passed = ends[..WIDTH - 1]
        .iter()
        .map(|&end| usize::from(target >= end));
    let chosen: usize = passed.sum();
    let start = if chosen == 0 { 0.0 } else { ends[chosen - 1] };
    let remapped = (target - start) / importance[chosen];
    (chosen, remapped.clamp(0.0, ONE_MINUS_EPSILON))
}
