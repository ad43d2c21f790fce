use std::collections::HashMap;
use std::sync::Arc;

use super::quads::LeafPrimitives;
use super::{Aggregate, Instances};
use crate::bvh::{Bvh, BvhKind, BvhQuality, BvhSettings, LeafBlocks, Progress};

/// The best hierarchy over `primitives` that this program can build; reports the finished fraction
/// (0 to 1) to `progress`, which may stop it. `None` if it did.
pub(super) fn refine(
    primitives: &LeafPrimitives<'_>,
    leaf_size: u32,
    progress: &Progress<'_>,
) -> Option<(Bvh, LeafBlocks)> {
    let settings = BvhSettings {
        kind: BvhKind::Sah,
        leaf_size,
        quality: BvhQuality::High,
    };
    primitives.build(&settings, progress)
}

/// `aggregate`, whose instances these are, with its own shapes and every mesh under the best
/// hierarchies; progress as in [`refine`].
pub(super) fn refine_meshes(
    aggregate: &Aggregate,
    instances: &Instances,
    progress: &Progress<'_>,
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
    use std::ops::ControlFlow;
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::bvh::BvhStats;
    use crate::geometry::{Aggregate, Shapes};
    use crate::math::Isa;

    /// A sheet of 2 n² triangles.
    fn sheet(n: u32) -> Shapes {
        let positions = (0..=n)
            .flat_map(|y| (0..=n).map(move |x| glam::vec3(x as f32, y as f32, (x * y % 5) as f32)))
            .collect();
        let triangles = (0..n)
            .flat_map(|y| (0..n).map(move |x| y * (n + 1) + x))
            .flat_map(|a| [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]])
            .collect();
        Shapes {
            positions,
            triangles,
            spheres: Vec::new(),
        }
    }

    #[test]
    fn a_refined_aggregate_shares_its_shapes_and_costs_no_more() {
        let standard = BvhSettings {
            quality: BvhQuality::Standard,
            ..BvhSettings::default()
        };
        let first = Aggregate::build(sheet(60), standard).with_isa(Isa::Portable);
        let refined = first
            .refined(&|_| ControlFlow::Continue(()))
            .expect("nothing stops it");
        assert!(std::ptr::eq(first.shapes(), refined.shapes()));
        assert_eq!(refined.isa(), Isa::Portable);
        let (before, after) = (first.stats(), refined.stats());
        assert_eq!(before.primitives, after.primitives);
        let visits = |stats: &BvhStats| stats.expected_nodes + stats.expected_blocks;
        let (before, after) = (visits(&before), visits(&after));
        assert!(after <= before, "{after} > {before}");
    }

    #[test]
    fn it_stops_at_the_next_report() {
        let shapes = sheet(100);
        let primitives = LeafPrimitives::new(&shapes, BvhKind::Sah);
        let all = AtomicUsize::new(0);
        let count = |_| {
            all.fetch_add(1, Ordering::Relaxed);
            ControlFlow::Continue(())
        };
        assert!(refine(&primitives, 4, &count).is_some());
        let reports = AtomicUsize::new(0);
        let stop_at_third = |_| match reports.fetch_add(1, Ordering::Relaxed) {
            0 | 1 => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        };
        assert!(refine(&primitives, 4, &stop_at_third).is_none());
        assert!(reports.into_inner() < all.into_inner());
    }
}
