use std::ops::Range;

use glam::Vec3;

use super::super::bounds::EmissionBounds;
use super::node::{Link, Node, WIDTH};
use super::split::{Measure, split};
use crate::math::Aabb;

/// From this level on ranges are halved, so that a trail has room in 64 bits.
const HALVED_AFTER: u32 = 12;

/// A part to be put in the tree.
#[derive(Clone, Debug)]
pub(super) struct Item {
    pub(super) part: u32,
    pub(super) bounds: EmissionBounds,
}

/// A node whose children are still to be found.
struct Task {
    node: usize,
    items: Range<usize>,
    trail: u64,
    level: u32,
}

/// The nodes over `items`, the root first; tells `place` the trail of every part.
pub(super) fn build(mut items: Vec<Item>, mut place: impl FnMut(u32, u64)) -> Vec<Node> {
    let intensities = items.iter().map(|item| item.bounds.intensity);
    let brightest = f64::from(intensities.fold(0.0, f32::max));
    let mut nodes = vec![Node::EMPTY];
    let mut tasks = vec![Task {
        node: 0,
        items: 0..items.len(),
        trail: 0,
        level: 0,
    }];
    while let Some(task) = tasks.pop() {
        let ranges = children(&mut items, task.items.clone(), task.level);
        for (i, range) in ranges.into_iter().enumerate() {
            let trail = task.trail | (i as u64) << (3 * task.level);
            let members = &items[range.clone()];
            if let [item] = members {
                let link = Link::Part(item.part as usize);
                nodes[task.node].set(i, &item.bounds, brightest, link);
                place(item.part, trail);
                continue;
            }
            let node = nodes.len();
            nodes.push(Node::EMPTY);
            nodes[task.node].set(i, &around(members), brightest, Link::Node(node));
            tasks.push(Task {
                node,
                items: range,
                trail,
                level: task.level + 1,
            });
        }
    }
    nodes
}

/// Up to [`WIDTH`] ranges: always the costliest is split next.
fn children(items: &mut [Item], all: Range<usize>, level: u32) -> Vec<Range<usize>> {
    let cost = |items: &[Item], range: &Range<usize>| {
        if range.len() == 1 {
            return 0.0;
        }
        let mut measure = Measure::EMPTY;
        let members = items[range.clone()].iter();
        members.for_each(|item| measure.add(&item.bounds));
        // Ranges of one place still have to be split.
        measure.cost().max(f32::MIN_POSITIVE)
    };
    let mut ranges = vec![(cost(items, &all), all)];
    while ranges.len() < WIDTH {
        let (widest, _) = ranges
            .iter()
            .enumerate()
            .fold(
                (0, 0.0),
                |best, (i, (cost, _))| {
                    if *cost > best.1 { (i, *cost) } else { best }
                },
            );
        let (cost_of_it, range) = ranges[widest].clone();
        if cost_of_it == 0.0 {
            break;
        }
        let halve = level >= HALVED_AFTER;
        let middle = range.start + split(&mut items[range.clone()], halve);
        let (left, right) = (range.start..middle, middle..range.end);
        ranges[widest] = (cost(items, &left), left);
        ranges.insert(widest + 1, (cost(items, &right), right));
    }
    ranges.into_iter().map(|(_, range)| range).collect()
}

/// Bounds of all `items` together, at least two.
fn around(items: &[Item]) -> EmissionBounds {
    let first = &items[0].bounds;
    let two_sided = items.iter().any(|item| item.bounds.two_sided);
    let aligned = |bounds: &EmissionBounds| align(bounds, first.axis);
    let mut aabb = Aabb::EMPTY;
    let (mut sum, mut intensity, mut cos_emission) = (Vec3::ZERO, 0.0_f64, 1.0_f32);
    for Item { bounds, .. } in items {
        aabb = aabb.union(bounds.aabb);
        sum += aligned(bounds);
        intensity += f64::from(bounds.intensity);
        cos_emission = cos_emission.min(bounds.cos_emission);
    }
    let center = aabb.center();
    let axis = sum.normalize_or(first.axis);
    let (mut radius, mut cos_normals) = (0.0_f32, 1.0_f32);
    for Item { bounds, .. } in items {
        radius = radius.max(center.distance(bounds.center) + bounds.radius);
        cos_normals = cos_normals.min(widened(axis.dot(aligned(bounds)), bounds.cos_normals));
    }
    EmissionBounds {
        center,
        radius: radius.min(0.5 * aabb.extent().length()),
        aabb,
        axis,
        cos_normals,
        cos_emission,
        two_sided,
        intensity: intensity as f32,
    }
}

/// The axis of `bounds`; of its two axes, if it shines both ways, that on the side of `reference`.
pub(super) fn align(bounds: &EmissionBounds, reference: Vec3) -> Vec3 {
    if bounds.two_sided && bounds.axis.dot(reference) < 0.0 {
        -bounds.axis
    } else {
        bounds.axis
    }
}

/// cos(a + b) of two angles in 0..=π given by their cosines; −1 when they add to more than π.
fn widened(cos_a: f32, cos_b: f32) -> f32 {
    if cos_a <= -cos_b {
        return -1.0;
    }
    let sine = |cos: f32| (1.0 - cos * cos).max(0.0).sqrt();
    (cos_a * cos_b - sine(cos_a) * sine(cos_b)).max(-1.0)
}
