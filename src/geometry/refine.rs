use std::collections::HashMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use super::leaf::boxes;
use super::{Aggregate, Instances, Shapes};
use crate::bvh::{Bvh, BvhKind, BvhQuality, BvhSettings, LeafBlocks};

/// Largest leaf that the heuristic may choose: so large that it decides alone. On a knot of 70 000
/// triangles it never wants more than six.
const LEAF_SIZE: u32 = 16;

/// The best hierarchy over `shapes` that this program can build; reports the finished fraction
/// (0 to 1) to `progress`, which may stop it. `None` if it did.
pub(super) fn refine(
    shapes: &Shapes,
    progress: &(dyn Fn(f32) -> ControlFlow<()> + Sync),
) -> Option<(Bvh, LeafBlocks)> {
    progress(0.0).continue_value()?;
    let settings = BvhSettings {
        kind: BvhKind::Sah,
        leaf_size: LEAF_SIZE,
        quality: BvhQuality::High,
    };
    Bvh::build_with(&boxes(shapes), &settings, progress)
}

/// `aggregate`, whose instances these are, with its own shapes and every mesh under the best
/// hierarchies; progress as in [`refine`].
pub(super) fn refine_meshes(
    aggregate: &Aggregate,
    instances: &Instances,
    progress: &(dyn Fn(f32) -> ControlFlow<()> + Sync),
) -> Option<Aggregate> {
    let meshes = instances.meshes();
    let sizes = meshes.iter().map(|mesh| mesh.shapes().len());
    let total = (sizes.sum::<usize>() + aggregate.shapes().len()).max(1) as f32;
    let mut done = 0;
    let mut one = |part: &Aggregate| {
        let size = part.shapes().len();
        let refined = part
            .refined_alone(&|fraction| progress((done as f32 + fraction * size as f32) / total));
        done += size;
        refined
    };
    let own = one(aggregate)?;
    let mut refined = HashMap::new();
    for mesh in meshes {
        refined.insert(Arc::as_ptr(mesh), Arc::new(one(mesh)?));
    }
    let placed = instances.list().iter().map(|instance| {
        let mesh = &refined[&Arc::as_ptr(instance.mesh())];
        (Arc::clone(mesh), *instance.placement())
    });
    let placed = placed.collect();
    Some(own.with_instances(placed))
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::geometry::Aggregate;

    /// A sheet of 2 n² triangles.
    fn sheet(n: u32) -> Shapes {
        let positions = (0..=n)
            .flat_map(|y| (0..=n).map(move |x| glam::vec3(x as f32, y as f32, (x * y % 5) as f32)))
            .collect();
        let triangles = (0..n)
            .flat_map(|y| (0..n).map(move |x| y * (n + 1) + x))
            .flat_map(|a| [[a, a + 1, a + n + 1], [a + 1, a + n + 2, a + n + 1]])
            .collect();
        Shapes {
            positions,
            triangles,
            spheres: Vec::new(),
        }
    }

    #[test]
    fn a_refined_aggregate_shares_its_shapes_and_costs_no_more() {
        let fast = BvhSettings {
            leaf_size: 16,
            quality: BvhQuality::Fast,
            ..BvhSettings::default()
        };
        let first = Aggregate::build(sheet(60), fast);
        let refined = first
            .refined(&|_| ControlFlow::Continue(()))
            .expect("nothing stops it");
        assert!(std::ptr::eq(first.shapes(), refined.shapes()));
        let (before, after) = (first.stats(), refined.stats());
        assert_eq!(before.primitives, after.primitives);
        assert!(
            after.sah_cost < before.sah_cost,
            "{} >= {}",
            after.sah_cost,
            before.sah_cost
        );
    }

    #[test]
    fn it_stops_at_the_next_report() {
        let shapes = sheet(100);
        let all = AtomicUsize::new(0);
        let count = |_| {
            all.fetch_add(1, Ordering::Relaxed);
            ControlFlow::Continue(())
        };
        assert!(refine(&shapes, &count).is_some());
        let reports = AtomicUsize::new(0);
        let stop_at_third = |_| match reports.fetch_add(1, Ordering::Relaxed) {
            0 | 1 => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        };
        assert!(refine(&shapes, &stop_at_third).is_none());
        assert!(reports.into_inner() < all.into_inner());
    }
}
