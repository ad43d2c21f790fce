use std::sync::Arc;

use glam::Vec3;

use super::Aggregate;
use super::leaf::bounds;
use super::sweep::Sweep;

impl Aggregate {
    /// Moves the vertices of the triangles without building the hierarchy anew; hits are those of a
    /// new one, bit for bit. Returns the expected cost of a ray in nodes and blocks: when it has
    /// grown much, building anew pays. `None`, and nothing is changed, if the hierarchy lacks a
    /// primitive that can now be hit: it was left out because it had no area or was not finite.
    ///
    /// # Panics
    /// If there are not as many positions as before.
    pub fn refit(&mut self, positions: Vec<Vec3>) -> Option<f64> {
        assert_eq!(positions.len(), self.shapes().positions.len());
        let moved = &mut Arc::make_mut(&mut self.shapes).positions;
        let before = std::mem::replace(moved, positions);
        if self.bvh.excluded() > 0 {
            let can_be_hit = |&id: &u32| !bounds(&self.shapes, id).is_empty();
            let all = (0..self.shapes.len() as u32).filter(can_be_hit).count();
            let root = self.bvh.root();
            let inside = root.map_or(0, |root| self.primitives(root).filter(can_be_hit).count());
            if inside < all {
                Arc::make_mut(&mut self.shapes).positions = before;
                return None;
            }
        }
        self.is_refined = false;
        if self.sweep.is_some() {
            self.sweep = Sweep::new(&self.shapes).map(Arc::new);
        }
        let leaves = Arc::make_mut(&mut self.leaves);
        Some(leaves.refit(Arc::make_mut(&mut self.bvh), &self.shapes))
    }

    /// Nodes and blocks that a random ray is expected to visit, by the surface-area heuristic.
    pub fn expected_visits(&self) -> f64 {
        let (nodes, blocks) = self.bvh.expected_visits();
        nodes + blocks
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Hit, Shapes, Sphere, TraceCounts};
    use super::*;
    use crate::bvh::BvhSettings;
    use crate::math::Ray;

    /// A sheet of triangles in waves, with a sphere above it.
    fn shapes(n: usize, phase: f32) -> Shapes {
        let at = |i: usize| i as f32 / n as f32 * 2.0 - 1.0;
        let height = |x: f32, z: f32| 0.2 * (5.0 * x + phase).sin() * (4.0 * z - phase).cos();
        let positions = (0..n * n).map(|i| {
            let (x, z) = (at(i % n), at(i / n));
            Vec3::new(x, height(x, z), z)
        });
        let quads = (0..n - 1).flat_map(|i| (0..n - 1).map(move |j| (i * n + j) as u32));
        let n = n as u32;
        let triangles = quads.flat_map(|i| [[i, i + 1, i + n + 1], [i, i + n + 1, i + n]]);
        Shapes {
            positions: positions.collect(),
            triangles: triangles.collect(),
            spheres: vec![Sphere {
                center: Vec3::Y * 0.5,
                radius: 0.1,
            }],
        }
    }

    fn hits(aggregate: &Aggregate) -> Vec<[u32; 4]> {
        let rays: Vec<_> = (0..2_000)
            .map(|i| {
                let turn = i as f32 * 2.4;
                let origin = Vec3::new(turn.sin(), 0.6, turn.cos()) * (0.2 + i as f32 * 4e-4);
                let aim = Vec3::new((turn * 1.7).sin(), 0.0, (turn * 3.1).cos()) * 0.9;
                Ray::new(origin, aim - origin)
            })
            .collect();
        let mut hits = vec![Hit::MISS; rays.len()];
        aggregate.closest_hit(&rays, &mut hits, &mut TraceCounts::default());
        let bits = |h: Hit| [h.t.to_bits(), h.primitive, h.b1.to_bits(), h.b2.to_bits()];
        hits.into_iter().map(bits).collect()
    }

    #[test]
    fn hits_after_a_refit_are_those_of_a_new_tree() {
        for leaf_size in [1, 4, 16] {
            let settings = BvhSettings {
                leaf_size,
                ..BvhSettings::default()
            };
            let mut aggregate = Aggregate::build(shapes(40, 0.0), settings);
            let before = hits(&aggregate);
            for phase in [0.5, 2.0] {
                let moved = shapes(40, phase);
                let cost = aggregate
                    .refit(moved.positions.clone())
                    .expect("all are in");
                let new = Aggregate::build(moved, settings);
                assert_eq!(hits(&aggregate), hits(&new));
                assert_ne!(hits(&aggregate), before);
                let (nodes, blocks) = new.bvh().expected_visits();
                assert!(cost > 0.8 * (nodes + blocks) && cost < 3.0 * (nodes + blocks));
            }
            aggregate
                .refit(shapes(40, 0.0).positions)
                .expect("all are in");
            assert_eq!(hits(&aggregate), before);
        }
    }

    #[test]
    fn triangles_may_lose_their_area_but_not_gain_one() {
        let settings = BvhSettings::default();
        let (good, mut bad) = (shapes(20, 0.0), shapes(20, 0.0));
        for position in &mut bad.positions[30..60] {
            *position = Vec3::splat(0.3);
        }
        bad.positions[77] = Vec3::NAN;
        let mut aggregate = Aggregate::build(good.clone(), settings);
        assert!(aggregate.refit(bad.positions.clone()).is_some());
        let mut new = Aggregate::build(bad, settings);
        assert!(new.bvh().excluded() > 30);
        assert_eq!(hits(&aggregate), hits(&new));
        let before = hits(&new);
        assert_eq!(new.refit(good.positions), None);
        assert_eq!(hits(&new), before);
    }
}
