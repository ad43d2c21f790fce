use std::f32::consts::PI;

use glam::Vec3;

use super::super::bounds::EmissionBounds;
use super::build::{Item, align};
use crate::math::Aabb;

const BINS: usize = 12;

/// What a set of parts costs: intensity × spread of directions × size (Conty Estevez and Kulla
/// 2018, section 4.3), with the spread taken from the mean axis instead of from a cone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measure {
    aabb: Aabb,
    intensity: f32,
    axes: Vec3,
    weight: f32,
}

impl Measure {
    pub(super) const EMPTY: Self = Self {
        aabb: Aabb::EMPTY,
        intensity: 0.0,
        axes: Vec3::ZERO,
        weight: 0.0,
    };

    pub(super) fn add(&mut self, bounds: &EmissionBounds) {
        self.aabb = self.aabb.union(bounds.aabb);
        self.intensity += bounds.intensity;
        // Spheres and points shine everywhere: they have no axis.
        let length = 0.5 * (1.0 + bounds.cos_normals);
        self.axes += align(bounds, Vec3::new(0.36, 0.80, 0.48)) * length;
        self.weight += 1.0;
    }

    fn union(&self, other: &Self) -> Self {
        Self {
            aabb: self.aabb.union(other.aabb),
            intensity: self.intensity + other.intensity,
            axes: self.axes + other.axes,
            weight: self.weight + other.weight,
        }
    }

    /// 0 for an empty set.
    pub(super) fn cost(&self) -> f32 {
        if self.weight == 0.0 {
            return 0.0;
        }
        let agreement = self.axes.length() / self.weight;
        let spread = PI * (4.0 - 3.0 * agreement.min(1.0));
        let extent = self.aabb.extent();
        self.intensity * spread * extent.length_squared()
    }
}

/// Orders `items`, at least two, and gives the number of those in the first of two groups; neither
/// group is empty. `halve`: groups of equal number.
pub(super) fn split(items: &mut [Item], halve: bool) -> usize {
    let centers = Aabb::from_points(items.iter().map(|item| item.bounds.center));
    let extent = centers.extent();
    let longest = extent.max_position();
    if extent[longest] <= 0.0 {
        return items.len() / 2;
    }
    if halve {
        let middle = items.len() / 2;
        items.select_nth_unstable_by(middle, |a, b| {
            let (x, y) = (a.bounds.center[longest], b.bounds.center[longest]);
            x.total_cmp(&y).then(a.part.cmp(&b.part))
        });
        return middle;
    }
    let bin = |item: &Item, axis: usize| {
        let share = (item.bounds.center[axis] - centers.min[axis]) / extent[axis];
        ((share * BINS as f32) as usize).min(BINS - 1)
    };
    let mut best = (f32::INFINITY, longest, BINS / 2);
    for axis in (0..3).filter(|&axis| extent[axis] > 0.0) {
        let mut bins = [Measure::EMPTY; BINS];
        for item in items.iter() {
            bins[bin(item, axis)].add(&item.bounds);
        }
        let mut right = [Measure::EMPTY; BINS];
        let mut sum = Measure::EMPTY;
        for i in (1..BINS).rev() {
            sum = sum.union(&bins[i]);
            right[i] = sum;
        }
        // Thin slices are split across their length.
        let slimness = extent[longest] / extent[axis];
        let mut left = Measure::EMPTY;
        for i in 1..BINS {
            left = left.union(&bins[i - 1]);
            let cost = slimness * (left.cost() + right[i].cost());
            if left.weight > 0.0 && right[i].weight > 0.0 && cost < best.0 {
                best = (cost, axis, i);
            }
        }
    }
    let (_, axis, first_right) = best;
    let middle = partition(items, |item| bin(item, axis) < first_right);
    if middle == 0 || middle == items.len() {
        items.len() / 2
    } else {
        middle
    }
}

/// Brings those that `goes_left` to the front; gives their number.
fn partition(items: &mut [Item], goes_left: impl Fn(&Item) -> bool) -> usize {
    let mut middle = 0;
    for i in 0..items.len() {
        if goes_left(&items[i]) {
            items.swap(i, middle);
            middle += 1;
        }
    }
    middle
}
