//! The tree itself: its order, its bounds, its statistics, and how it is built.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use softbox::bvh::{
    Bvh, BvhKind, BvhQuality, BvhSettings, LeafBlocks, NO_PRIMITIVE, NodeId, Progress, padded,
};
use softbox::geometry::{Aggregate, TraceCounts};
use softbox::math::Aabb;

use crate::scenes::{self, settings};

fn boxes(n: usize) -> Vec<Aabb> {
    let shapes = scenes::random_soup(n, 0.1, 8);
    (0..n)
        .map(|i| Aabb::from_points(shapes.vertices(i)))
        .collect()
}

fn build_with(
    boxes: &[Aabb],
    settings: &BvhSettings,
    quality: BvhQuality,
    progress: &Progress<'_>,
) -> Option<(Bvh, LeafBlocks)> {
    let bounds = |id: u32| boxes[id as usize];
    let settings = BvhSettings {
        quality,
        ..*settings
    };
    Bvh::build_with(boxes.len(), &bounds, &settings, progress)
}

fn build(boxes: &[Aabb], settings: &BvhSettings, quality: BvhQuality) -> (Bvh, LeafBlocks) {
    build_with(boxes, settings, quality, &|_| ControlFlow::Continue(())).expect("not stopped")
}

const QUALITIES: [BvhQuality; 3] = [BvhQuality::Fast, BvhQuality::Standard, BvhQuality::High];

/// Kinds with the qualities that make a difference.
fn trees() -> impl Iterator<Item = (BvhKind, BvhQuality)> {
    let sah = QUALITIES.map(|quality| (BvhKind::Sah, quality));
    let others = [BvhKind::None, BvhKind::Median].map(|kind| (kind, BvhQuality::High));
    others.into_iter().chain(sah)
}

fn contains(outer: Aabb, inner: Aabb) -> bool {
    outer.union(inner) == outer
}

/// All nodes below and including `node`, depth first.
fn nodes(bvh: &Bvh, node: NodeId, out: &mut Vec<NodeId>) {
    out.push(node);
    for child in bvh.children(node).into_iter().flatten() {
        nodes(bvh, child, out);
    }
}

#[test]
fn every_node_holds_its_children_and_every_primitive_is_in_one_leaf() {
    let boxes = boxes(5_000);
    for (kind, quality) in trees() {
        for leaf_size in [1, 3, 4, 16, 255] {
            let (bvh, blocks) = build(&boxes, &settings(kind, leaf_size), quality);
            let root = bvh.root().expect("not empty");
            let mut all = Vec::new();
            nodes(&bvh, root, &mut all);
            assert_eq!(all.len(), bvh.node_count());
            let mut in_leaves = 0;
            for &node in &all {
                let bounds = bvh.bounds(node);
                let ids = blocks[bvh.blocks(node)].iter().flatten();
                let ids: Vec<_> = ids.copied().filter(|&id| id != NO_PRIMITIVE).collect();
                assert_eq!(ids.len(), bvh.primitives_below(node));
                for &id in &ids {
                    assert!(contains(bounds, padded(boxes[id as usize])));
                }
                let Some(children) = bvh.children(node) else {
                    assert!(kind == BvhKind::None || ids.len() <= leaf_size as usize);
                    in_leaves += ids.len();
                    continue;
                };
                for child in children {
                    assert!(contains(bounds, bvh.bounds(child)));
                    assert_eq!(bvh.parent(child), Some(node));
                    assert_eq!(bvh.depth(child), bvh.depth(node) + 1);
                }
            }
            assert_eq!(
                (in_leaves, bvh.parent(root), bvh.depth(root)),
                (5_000, None, 0)
            );
            let mut ids = blocks.concat();
            ids.retain(|&id| id != NO_PRIMITIVE);
            ids.sort_unstable();
            assert!(ids.into_iter().eq(0..5_000));
        }
    }
}

#[test]
fn statistics_describe_the_tree() {
    let boxes = boxes(5_000);
    let cost = |kind| {
        let stats = Bvh::build(&boxes, &settings(kind, 4)).0.stats();
        assert_eq!(stats.primitives, 5_000);
        assert_eq!(
            stats
                .leaf_histogram
                .iter()
                .map(|(size, n)| size * n)
                .sum::<usize>(),
            5_000
        );
        assert_eq!(stats.leaf_histogram.values().sum::<usize>(), stats.leaves);
        assert_eq!(
            stats.leaf_histogram.keys().last(),
            Some(&stats.largest_leaf)
        );
        assert_eq!(stats.nodes, 2 * stats.leaves - 1);
        assert!(stats.mean_leaf_depth <= stats.max_depth as f64);
        // A node of 256 bytes stands for at most seven inner nodes.
        assert!(stats.bytes >= (stats.nodes - stats.leaves).div_ceil(7) * 256);
        stats.sah_cost
    };
    let (none, median, sah) = (
        cost(BvhKind::None),
        cost(BvhKind::Median),
        cost(BvhKind::Sah),
    );
    assert_eq!(none, 5_000.0);
    assert!(sah < median && median < 0.1 * none, "{sah} {median} {none}");
}

#[test]
fn the_tree_does_not_depend_on_the_number_of_threads() {
    // Large enough for parallel scans and several parallel splits.
    let boxes = boxes(80_000);
    for (kind, quality) in trees() {
        let build = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let (bvh, blocks) = pool
                .expect("threads")
                .install(|| build(&boxes, &settings(kind, 4), quality));
            let mut all = Vec::new();
            nodes(&bvh, bvh.root().expect("not empty"), &mut all);
            let nodes: Vec<_> = all
                .into_iter()
                .map(|n| (bvh.bounds(n), bvh.blocks(n)))
                .collect();
            (blocks, nodes)
        };
        let one = build(1);
        assert!(one == build(2) && one == build(3), "{kind:?} {quality:?}");
    }
}

#[test]
fn a_build_reports_its_progress_and_can_be_stopped() {
    let boxes = boxes(60_000);
    for (kind, quality) in trees() {
        let calls = AtomicUsize::new(0);
        let finished = AtomicUsize::new(0);
        let built = build_with(&boxes, &settings(kind, 4), quality, &|done| {
            assert!((0.0..=1.0).contains(&done));
            calls.fetch_add(1, Ordering::Relaxed);
            finished.fetch_add(usize::from(done == 1.0), Ordering::Relaxed);
            ControlFlow::Continue(())
        });
        assert!(built.is_some());
        let calls = calls.into_inner();
        assert_eq!(finished.into_inner(), 1);
        for stop_at in [0, calls / 2, calls - 1] {
            let seen = AtomicUsize::new(0);
            let built = build_with(&boxes, &settings(kind, 4), quality, &|_| {
                if seen.fetch_add(1, Ordering::Relaxed) >= stop_at {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            });
            assert!(
                built.is_none(),
                "{kind:?} {quality:?} at {stop_at} of {calls}"
            );
        }
    }
}

#[test]
fn empty_and_tiny_trees_have_a_sensible_shape() {
    let (empty, _) = Bvh::build(&[], &BvhSettings::default());
    assert_eq!(
        (empty.node_count(), empty.root(), empty.stats().leaves),
        (0, None, 0)
    );
    let (one, _) = Bvh::build(&boxes(1), &BvhSettings::default());
    assert_eq!(
        (one.node_count(), one.stats().leaves, one.stats().max_depth),
        (1, 1, 0)
    );
    // A leaf size of 0 means 1.
    let (two, _) = Bvh::build(&boxes(2), &settings(BvhKind::Median, 0));
    assert_eq!((two.node_count(), two.stats().largest_leaf), (3, 1));
}

/// Centres that halve their distance each time: the heuristic alone would peel off one by one.
#[test]
fn the_depth_is_bounded_for_centres_in_geometric_progression() {
    let boxes: Vec<_> = (0..250)
        .map(|i| {
            let x = 2.0_f32.powi(120 - i);
            Aabb::from_points([glam::Vec3::splat(x), glam::Vec3::splat(x * 1.01)])
        })
        .collect();
    for quality in QUALITIES {
        let (bvh, _) = build(&boxes, &settings(BvhKind::Sah, 1), quality);
        let stats = bvh.stats();
        assert!(stats.max_depth <= 100, "{stats:?}");
    }
}

#[test]
fn hits_do_not_depend_on_the_quality() {
    let rays = scenes::random_rays(5_000, 17);
    for shapes in [scenes::mixed(500), scenes::spiky_sphere()] {
        let brute = scenes::brute_force(shapes.clone());
        let want = scenes::closest(&brute, &rays);
        for (kind, quality) in trees() {
            for leaf_size in [1, 4, 7] {
                let settings = BvhSettings {
                    quality,
                    ..settings(kind, leaf_size)
                };
                let tree = Aggregate::build(shapes.clone(), settings);
                let got = scenes::closest(&tree, &rays);
                for (got, want) in got.iter().zip(&want) {
                    assert_eq!(scenes::bits(got), scenes::bits(want), "{settings:?}");
                }
            }
        }
    }
}

#[test]
fn equal_and_absurd_boxes_have_a_tree_of_every_quality() {
    let one = Aabb::from_points([glam::Vec3::ZERO, glam::Vec3::ONE]);
    let huge = Aabb::from_points([glam::Vec3::splat(-3e38), glam::Vec3::splat(3e38)]);
    let mut mixed = vec![one; 900];
    mixed.extend([huge, Aabb::EMPTY, huge]);
    mixed.extend(vec![one; 100]);
    for quality in QUALITIES {
        let (bvh, blocks) = build(&mixed, &settings(BvhKind::Sah, 4), quality);
        assert_eq!((bvh.primitive_count(), bvh.excluded()), (1_002, 1));
        assert!(bvh.stats().max_depth <= 100);
        let mut ids = blocks.concat();
        ids.retain(|&id| id != NO_PRIMITIVE);
        ids.sort_unstable();
        assert!(ids.into_iter().eq((0..1_003).filter(|&id| id != 901)));
    }
}

/// A fine sphere in a box of twelve large triangles.
#[test]
fn large_triangles_around_a_mesh_do_not_spoil_its_boxes() {
    let mut shapes = scenes::closed_sphere(60, |i, j| 0.5 + 0.1 * ((i * j) as f32).sin());
    let walls = scenes::cube();
    let first = shapes.positions.len() as u32;
    let alone = Aggregate::build(shapes.clone(), BvhSettings::default()).stats();
    shapes.positions.extend(walls.positions);
    let moved = walls.triangles.iter().map(|t| t.map(|i| i + first));
    shapes.triangles.extend(moved);
    let room = Aggregate::build(shapes, BvhSettings::default()).stats();
    // A ray through the room meets the sphere's box, of a third of the side, one time in six.
    assert!(
        room.expected_nodes < 1.5 + 0.4 * alone.expected_nodes,
        "{room:?} {alone:?}"
    );
}

#[test]
fn a_better_quality_expects_less_work_and_says_so() {
    let boxes = boxes(20_000);
    let cost = |quality| {
        let stats = build(&boxes, &settings(BvhKind::Sah, 4), quality).0.stats();
        assert!((stats.bytes_per_shape * 20_000.0 - stats.bytes as f64).abs() < 1.0);
        stats.expected_nodes + stats.expected_blocks
    };
    let (standard, high) = (cost(BvhQuality::Standard), cost(BvhQuality::High));
    assert!(high < 0.99 * standard, "{high} {standard}");
    let fast = cost(BvhQuality::Fast);
    assert!(fast < 1.3 * standard, "{fast} {standard}");
    let one_leaf = Bvh::build(&boxes, &settings(BvhKind::None, 4)).0.stats();
    assert_eq!(
        (one_leaf.expected_nodes, one_leaf.expected_blocks),
        (1.0, 5_000.0)
    );
}

#[test]
fn the_end_point_overlap_is_that_of_the_boxes_around_the_points() {
    // Two triangles side by side: each in its own box, or both in one. Without common vertices: as
    // quads, the faces of a cube overlap nowhere.
    let cube = scenes::cube();
    let shapes = scenes::soup((0..12).map(|triangle| cube.vertices(triangle)));
    let overlap = |leaf_size| {
        Aggregate::build(shapes.clone(), settings(BvhKind::Sah, leaf_size)).end_point_overlap(1_000)
    };
    let (fine, coarse) = (overlap(1), overlap(12));
    assert!(
        (0.5..4.0).contains(&fine) && coarse < fine,
        "{fine} {coarse}"
    );
    let quads = Aggregate::build(cube, BvhSettings::default());
    assert!(quads.end_point_overlap(1_000) < 0.1 * fine);
    let none = Aggregate::build(scenes::soup([]), BvhSettings::default());
    assert_eq!(none.end_point_overlap(1_000), 0.0);
}

#[test]
fn traversal_counts_its_work_and_the_tree_saves_most_of_it() {
    let rays = scenes::random_rays(2_000, 7);
    let shapes = scenes::random_soup(5_000, 0.05, 3);
    let work = |kind| {
        let aggregate = Aggregate::build(shapes.clone(), settings(kind, 4));
        let mut counts = TraceCounts::default();
        let mut hits = vec![softbox::geometry::Hit::MISS; rays.len()];
        aggregate.closest_hit(&rays, &mut hits, &mut counts);
        assert_eq!(counts.rays, 2_000);
        assert!(counts.box_tests >= 2_000);
        counts.primitive_tests
    };
    let (none, median, sah) = (
        work(BvhKind::None),
        work(BvhKind::Median),
        work(BvhKind::Sah),
    );
    assert!(none > 4_000 * 1_000, "{none}");
    assert!(sah * 50 < none && sah < median, "{sah} {median} {none}");
}
