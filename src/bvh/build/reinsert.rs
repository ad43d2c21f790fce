use rayon::prelude::*;

use super::binary::BinaryNode;
use super::primitive::Bounds;
use super::watch::Watch;

/// The index of the root, which never moves.
const ROOT: u32 = 0;

/// Nodes searched between two looks at the watch.
const BATCH: usize = 1024;

/// A binary tree whose subtrees move to where they make less area.
///
/// Bittner, Hapala, Havran 2013, "Fast Insertion-Based Optimization of Bounding Volume
/// Hierarchies"; the search is that of Meister and Bittner 2018, "Parallel Reinsertion for Bounding
/// Volume Hierarchy Optimization". Searches run in parallel, moves one after the other in the order
/// of what they save, so that the result does not depend on the number of threads.
#[derive(Debug)]
pub(super) struct Reinsertion {
    nodes: Vec<BinaryNode>,
    parents: Vec<u32>,
}

/// A subtree, the node beside which it shall stand, and the half area that saves.
#[derive(Clone, Copy, Debug)]
struct Move {
    saving: f32,
    node: u32,
    target: u32,
}

impl Reinsertion {
    /// Takes a tree whose root is the first of `nodes`.
    pub(super) fn new(nodes: Vec<BinaryNode>) -> Self {
        let mut parents = vec![ROOT; nodes.len()];
        for (parent, node) in nodes.iter().enumerate() {
            for child in node.children().into_iter().flatten() {
                parents[child as usize] = parent as u32;
            }
        }
        Self { nodes, parents }
    }

    pub(super) fn into_nodes(self) -> Vec<BinaryNode> {
        self.nodes
    }

    /// Sum of the half areas of all inner nodes.
    pub(super) fn area(&self) -> f64 {
        let inner = self.nodes.iter().filter(|node| node.children().is_some());
        inner.map(|node| f64::from(node.bounds().half_area())).sum()
    }

    /// Looks for better places for the `count` largest nodes, and moves them; returns the half area
    /// saved, as far as known before the moves. `None` when `watch` says so.
    pub(super) fn improve(&mut self, count: usize, watch: &Watch<'_>) -> Option<f64> {
        let candidates = self.largest(count);
        let batches: Option<Vec<Vec<Move>>> = candidates
            .par_chunks(BATCH)
            .map(|batch| {
                watch.advance(0)?;
                let mut open = Vec::new();
                let found = batch
                    .iter()
                    .filter_map(|&node| self.search(node, &mut open));
                Some(found.collect())
            })
            .collect();
        let mut moves = batches?.concat();
        moves.par_sort_unstable_by(|a, b| b.saving.total_cmp(&a.saving).then(a.node.cmp(&b.node)));
        let mut moved = vec![false; self.nodes.len()];
        let mut saved = 0.0;
        for batch in moves.chunks(BATCH) {
            watch.advance(0)?;
            for &one in batch {
                if self.carry_out(one, &mut moved) {
                    saved += f64::from(one.saving);
                }
            }
        }
        Some(saved)
    }

    /// The nodes with the largest boxes that may move; the order does not matter.
    fn largest(&self, count: usize) -> Vec<u32> {
        let nodes = self.nodes.par_iter().zip(&self.parents).enumerate();
        let mut all: Vec<(f32, u32)> = nodes
            .filter(|(_, (_, parent))| **parent != ROOT)
            .map(|(index, (node, _))| (node.bounds().half_area(), index as u32))
            .collect();
        if count < all.len() {
            all.select_nth_unstable_by(count, |a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            all.truncate(count);
        }
        all.into_iter().map(|(_, index)| index).collect()
    }

    fn sibling(&self, node: u32) -> u32 {
        let parent = &self.nodes[self.parents[node as usize] as usize];
        let [left, right] = parent.children().expect("a parent is an inner node");
        if left == node { right } else { left }
    }

    /// The place for `node` that saves most area, `None` if it stands best where it is.
    ///
    /// Goes up from the node; at each step goes down into what lies on the other side, as long as
    /// the best that can still come saves more than the best so far.
    fn search(&self, node: u32, open: &mut Vec<(f32, u32)>) -> Option<Move> {
        let bounds = self.nodes[node as usize].bounds();
        let area = bounds.half_area();
        let parent = self.parents[node as usize];
        let own_sibling = self.sibling(node);
        let mut best = Move {
            saving: 0.0,
            node,
            target: ROOT,
        };
        // What the way from `parent` to here saves without the node, and what is left of it.
        let mut freed = self.nodes[parent as usize].bounds().half_area();
        let mut rest = Bounds::EMPTY;
        let (mut at, mut aside) = (parent, own_sibling);
        loop {
            open.push((freed, aside));
            while let Some((freed, target)) = open.pop() {
                if freed - area <= best.saving {
                    continue;
                }
                let there = &self.nodes[target as usize];
                let saving = freed - there.bounds().union(&bounds).half_area();
                if saving > best.saving && target != own_sibling {
                    (best.saving, best.target) = (saving, target);
                }
                if let Some(children) = there.children() {
                    let freed = saving + there.bounds().half_area();
                    if freed - area > best.saving {
                        open.extend(children.map(|child| (freed, child)));
                    }
                }
            }
            rest = rest.union(&self.nodes[aside as usize].bounds());
            if at != parent {
                freed += self.nodes[at as usize].bounds().half_area() - rest.half_area();
            }
            if at == ROOT {
                break;
            }
            (aside, at) = (self.sibling(at), self.parents[at as usize]);
        }
        (best.target != ROOT && best.target != parent).then_some(best)
    }

    /// Moves a subtree if nothing around it or its target has `moved` before; returns whether.
    fn carry_out(&mut self, one: Move, moved: &mut [bool]) -> bool {
        let Move { node, target, .. } = one;
        let parent = self.parents[node as usize];
        let (above, beside) = (self.parents[parent as usize], self.sibling(node));
        let above_target = self.parents[target as usize];
        let touched = [node, parent, above, beside, target, above_target].map(|i| i as usize);
        if parent == ROOT || touched.iter().any(|&i| moved[i]) || self.is_below(target, node) {
            return false;
        }
        touched.iter().for_each(|&i| moved[i] = true);
        self.replace(above, parent, beside);
        self.fit(above);
        // `above` may have been the target's parent; now `parent` takes the target's place.
        let above_target = self.parents[target as usize];
        self.replace(above_target, target, parent);
        self.link(parent, [target, node]);
        self.fit(parent);
        true
    }

    fn is_below(&self, mut node: u32, above: u32) -> bool {
        while node != ROOT {
            if node == above {
                return true;
            }
            node = self.parents[node as usize];
        }
        false
    }

    /// Puts `new` in the place of the child `old`.
    fn replace(&mut self, parent: u32, old: u32, new: u32) {
        let children = self.nodes[parent as usize].children();
        let children = children.expect("a parent is an inner node");
        self.link(parent, children.map(|c| if c == old { new } else { c }));
    }

    fn link(&mut self, parent: u32, children: [u32; 2]) {
        let bounds = self.nodes[parent as usize].bounds();
        self.nodes[parent as usize] = BinaryNode::inner(&bounds, children);
        for child in children {
            self.parents[child as usize] = parent;
        }
    }

    /// Fits the boxes from `node` to the root to their children.
    fn fit(&mut self, mut node: u32) {
        loop {
            let children = self.nodes[node as usize].children();
            let children = children.expect("only inner nodes are fitted");
            let [left, right] = children.map(|child| self.nodes[child as usize].bounds());
            self.nodes[node as usize] = BinaryNode::inner(&left.union(&right), children);
            if node == ROOT {
                return;
            }
            node = self.parents[node as usize];
        }
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use glam::Vec3;

    use super::super::primitive::PrimitiveRef;
    use super::*;
    use crate::math::Aabb;

    /// A tree in which the boxes hang one below the other in the order given.
    fn chain(boxes: &[Aabb]) -> Reinsertion {
        let refs: Vec<_> = (0..)
            .zip(boxes)
            .map(|(i, b)| PrimitiveRef::new(i, b))
            .collect();
        let mut nodes = Vec::new();
        for (i, r) in refs.iter().enumerate() {
            let rest = refs[i..].iter().map(PrimitiveRef::bounds);
            let rest = rest.reduce(|a, b| a.union(&b)).expect("not empty");
            let at = nodes.len() as u32;
            if i + 1 < refs.len() {
                nodes.push(BinaryNode::inner(&rest, [at + 1, at + 2]));
            }
            nodes.push(BinaryNode::leaf(r));
        }
        Reinsertion::new(nodes)
    }

    /// Boxes in two far groups, taken from both in turn.
    fn mixed() -> Vec<Aabb> {
        let corner = |i: usize| {
            let side = (i % 2 * 1000) as f32;
            Vec3::new(
                side + (i * 7 % 10) as f32,
                (i * 3 % 11) as f32,
                (i % 5) as f32,
            )
        };
        let boxes = (0..40).map(|i| Aabb::from_points([corner(i), corner(i) + Vec3::ONE]));
        boxes.collect()
    }

    #[test]
    fn a_search_finds_the_best_of_all_places() {
        let tree = chain(&mixed());
        let area = tree.area();
        let mut found = 0;
        for node in 1..tree.nodes.len() as u32 {
            if tree.parents[node as usize] == ROOT {
                continue;
            }
            let mut best = 0.0_f64;
            for target in 1..tree.nodes.len() as u32 {
                let mut tried = Reinsertion::new(tree.nodes.clone());
                let one = Move {
                    saving: 0.0,
                    node,
                    target,
                };
                let is_around = target == tree.parents[node as usize];
                if !is_around && tried.carry_out(one, &mut vec![false; tree.nodes.len()]) {
                    best = best.max(area - tried.area());
                }
            }
            let saving = tree
                .search(node, &mut Vec::new())
                .map_or(0.0, |one| one.saving);
            assert!(
                (f64::from(saving) - best).abs() < 1e-4 * area,
                "{node}: {saving} {best}"
            );
            found += usize::from(saving > 0.0);
        }
        assert!(found > 20, "{found}");
    }

    #[test]
    fn rounds_of_moves_undo_a_bad_tree_and_lose_nothing() {
        let boxes = mixed();
        let mut tree = chain(&boxes);
        let go = |_| ControlFlow::Continue(());
        let watch = Watch::new(1, &go);
        let before = tree.area();
        for _ in 0..10 {
            let area = tree.area();
            let saved = tree.improve(1000, &watch).expect("not stopped");
            assert!(saved >= 0.0 && tree.area() <= area * 1.001);
        }
        assert!(tree.area() < 0.2 * before, "{} {before}", tree.area());
        let mut seen = vec![false; boxes.len()];
        let mut open = vec![ROOT];
        while let Some(index) = open.pop() {
            let node = &tree.nodes[index as usize];
            match node.children() {
                None => seen[node.primitive() as usize] = true,
                Some(children) => {
                    let [l, r] = children.map(|c| tree.nodes[c as usize].bounds());
                    assert_eq!(l.union(&r).aabb(), node.bounds().aabb());
                    assert_eq!(children.map(|c| tree.parents[c as usize]), [index; 2]);
                    open.extend(children);
                }
            }
        }
        assert!(seen.into_iter().all(|s| s));
        let stop = |_| ControlFlow::Break(());
        assert!(tree.improve(1000, &Watch::new(1, &stop)).is_none());
    }
}
