use glam::{Vec2, Vec3};

use super::super::bounds::EmissionBounds;
use super::*;
use crate::sampling::{PathSampler, Slot, uniform_sphere};

fn random(i: u32, slot: u32) -> Vec2 {
    PathSampler::new(77, [i, slot], 0).get_2d(0, Slot::Scatter)
}

fn direction(i: u32, slot: u32) -> Vec3 {
    uniform_sphere(random(i, slot))
}

fn place(i: u32, slot: u32) -> Vec3 {
    let (a, b) = (random(i, slot), random(i, slot + 1000));
    Vec3::new(a.x, a.y, b.x) * 2.0 - 1.0
}

/// Part `i` of a mixture of all kinds of parts, some of which emit nothing.
fn part(i: u32) -> Option<EmissionBounds> {
    let (at, axis, u) = (place(i, 1), direction(i, 2), random(i, 3));
    let intensity = 10.0_f32.powf(4.0 * u.x - 2.0);
    let edges = [direction(i, 4), direction(i, 5)].map(|e| 0.1 * u.y * e);
    let normal = edges[0].cross(edges[1]).normalize();
    match i % 7 {
        0 => EmissionBounds::round(at, 0.0, intensity),
        1 => EmissionBounds::round(at, 0.2 * u.y, intensity),
        2 => EmissionBounds::cone(at, axis, u.y, intensity),
        3 => None,
        kind => {
            let corners = [at, at + edges[0], at + edges[1]];
            EmissionBounds::flat(&corners, normal, intensity, kind == 4)
        }
    }
}

fn mixture(count: u32) -> LightTree {
    LightTree::new((0..count).map(part))
}

fn surfaces(count: u32) -> impl Iterator<Item = (Vec3, Vec3)> {
    (0..count).map(|i| (1.3 * place(i, 6), direction(i, 7)))
}

/// On a lattice of numbers every part is found as often as its probability says, to a step or two at
/// each edge, and what is found carries its own probability.
#[test]
fn frequencies_are_the_probabilities() {
    for count in [1, 2, 5, 9, 60, 700] {
        let tree = mixture(count);
        for (point, normal) in surfaces(12) {
            let n = 40_000_u16;
            let mut found = vec![0_u32; count as usize];
            let mut lost = 0_u32;
            for i in 0..n {
                match tree.sample(point, normal, (f32::from(i) + 0.5) / f32::from(n)) {
                    Some((part, pmf)) => {
                        assert_eq!(pmf, tree.pmf(point, normal, part));
                        found[part] += 1;
                    }
                    None => lost += 1,
                }
            }
            let mut sum = f64::from(lost) / f64::from(n);
            for (part, &found) in found.iter().enumerate() {
                let pmf = f64::from(tree.pmf(point, normal, part));
                let expected = pmf * f64::from(n);
                assert!(
                    (f64::from(found) - expected).abs() < 2.0,
                    "{found} {expected}"
                );
                sum += pmf;
            }
            // What is lost is only known to the step.
            let steps = if lost > 0 { 30.0 } else { 1.0 };
            assert!(
                (sum - 1.0).abs() < steps / f64::from(n),
                "{count}: {sum}, {lost}"
            );
        }
    }
}

/// A part has probability 0 only where it gives nothing: no corner of it and the surface are in
/// front of each other.
#[test]
fn what_gives_light_can_be_chosen() {
    let count = 300;
    let tree = mixture(count);
    let (mut gives, mut gives_not) = (0, 0);
    for (point, normal) in surfaces(400) {
        for i in (0..count).filter(|i| i % 7 != 1) {
            let Some(bounds) = part(i) else { continue };
            let to_light = bounds.center - point;
            let cos = -bounds.axis.dot(to_light.normalize());
            let cos = if bounds.two_sided { cos.abs() } else { cos };
            let is_lit = cos > bounds.cos_emission || bounds.cos_normals < 0.0;
            let pmf = tree.pmf(point, normal, i as usize);
            if is_lit && to_light.dot(normal) > 0.0 {
                assert!(pmf > 0.0, "{bounds:?} {point} {normal}");
                gives += 1;
            } else if pmf == 0.0 {
                gives_not += 1;
            }
        }
    }
    assert!(gives > 1000 && gives_not > 10_000, "{gives} {gives_not}");
}

/// Far away, the probability is the share of the irradiance.
#[test]
fn small_lights_are_chosen_by_their_irradiance() {
    let lamp = |x: f32, intensity: f32| {
        let corners = [0.0, 1e-3].map(|d| Vec3::new(x + d, 1.0, d));
        EmissionBounds::flat(&corners, Vec3::NEG_Y, intensity, false)
    };
    let lamps = [(0.0, 1.0), (1.0, 1.0), (0.5, 4.0), (-2.0, 3.0)];
    let tree = LightTree::new(lamps.map(|(x, intensity)| lamp(x, intensity)));
    // cos · cos / d² at the origin is 1 / d⁴, d² = 1 + x².
    let irradiance = lamps.map(|(x, intensity)| intensity / (1.0 + x * x).powi(2));
    let total: f32 = irradiance.iter().sum();
    for (i, e) in irradiance.iter().enumerate() {
        let pmf = tree.pmf(Vec3::ZERO, Vec3::Y, i);
        assert!((pmf / (e / total) - 1.0).abs() < 0.01, "{i}: {pmf}");
        assert_eq!(tree.pmf(Vec3::ZERO, Vec3::NEG_Y, i), 0.0);
    }
}

/// Every trail ends at its part, and every node holds its children.
#[test]
fn a_hundred_thousand_triangles() {
    let count = 100_000;
    let corners = |i: u32| [0, 1, 2].map(|k| direction(i, 1) + 1e-3 * direction(i, 2 + k));
    let triangle = |i: u32| EmissionBounds::flat(&corners(i), direction(i, 1), 1.0, false);
    let tree = LightTree::new((0..count).map(triangle));
    let mut deepest = 0;
    for part in 0..count {
        let trail = tree.trail(part as usize).expect("all triangles shine");
        let mut link = tree.root().expect("not empty");
        let mut depth = 0;
        let bounds = triangle(part).expect("it shines");
        for place in trail {
            let Link::Node(node) = link else { break };
            let cluster = tree.clusters(node).nth(place).expect("the trail is right");
            for corner in corners(part) {
                assert!(cluster.center.distance(corner) <= cluster.radius * 1.0001);
            }
            assert!(cluster.axis.dot(bounds.axis) >= cluster.cos_normals - 1e-4);
            link = cluster.link;
            depth += 1;
        }
        assert_eq!(link, Link::Part(part as usize));
        deepest = deepest.max(depth);
    }
    assert!(deepest <= 12, "{deepest}");
    assert!(
        tree.nodes.len() < count as usize / 3,
        "{}",
        tree.nodes.len()
    );
}

#[test]
fn lights_in_one_place_and_extreme_lights() {
    let at = Vec3::splat(0.25);
    let crowd = LightTree::new((0..1000).map(|_| EmissionBounds::round(at, 0.0, 1.0)));
    // Each half as far from the origin as the one before, far more than 21 levels of halving.
    let shrinking = LightTree::new(
        (0..120).map(|i| EmissionBounds::round(Vec3::X * 0.5_f32.powi(i), 0.0, 1.0)),
    );
    let powers = [1e-38, 1e-30, 1.0, 1e30, f32::MAX];
    let uneven = LightTree::new(powers.map(|p| EmissionBounds::round(Vec3::X * p.log10(), 0.0, p)));
    for (tree, count) in [(crowd, 1000), (shrinking, 120), (uneven, 5)] {
        for point in [at, at + 1e-3, Vec3::ZERO, Vec3::splat(-30.0)] {
            for normal in [Vec3::Y, Vec3::NEG_Y, Vec3::ZERO, Vec3::X] {
                let pmf = |part| tree.pmf(point, normal, part);
                let sum: f32 = (0..count).map(pmf).sum();
                assert!(sum.is_finite() && sum < 1.0001, "{sum}");
                for u in [0.0, 0.3, ONE_MINUS_EPSILON] {
                    if let Some((part, p)) = tree.sample(point, normal, u) {
                        assert!(p > 0.0 && p == pmf(part));
                    }
                }
            }
            assert!(tree.sample(point, Vec3::X, 0.5).is_some() || point.x > 0.0);
        }
    }
}

#[test]
fn what_does_not_shine_is_not_in_the_tree() {
    let dark = [0.0, -1.0, f32::NAN, f32::INFINITY];
    let dark = dark.map(|intensity| EmissionBounds::round(Vec3::ZERO, 0.1, intensity));
    assert!(LightTree::new(dark).root().is_none());
    let one = EmissionBounds::round(Vec3::ZERO, 0.1, 2.0);
    let tree = LightTree::new([None, one, None]);
    // Nothing to choose: not even the cosine is asked for.
    assert_eq!(tree.sample(Vec3::Y, Vec3::Y, 0.7), Some((1, 1.0)));
    let pmfs = [0, 1, 2, 3].map(|part| tree.pmf(Vec3::Y, Vec3::Y, part));
    assert_eq!(pmfs, [0.0, 1.0, 0.0, 0.0]);
}
