//! The choice of a part of a light, in double precision: the same tree, with angles in place of
//! products of sines and cosines.

use std::f64::consts::PI;

use glam::DVec3;

use crate::light::{LightCluster, LightGroup, LightSampler, LightTree, Link};

/// Light, part and the probability with which `u` chooses them for a surface at `point`, lit on the
/// side of `normal`.
pub(super) fn choose(
    sampler: &LightSampler,
    (point, normal): (DVec3, DVec3),
    u: f32,
) -> Option<(u32, usize, f64)> {
    let (group, pmf, u) = sampler.choose_group(u)?;
    let (mut pmf, mut u) = (f64::from(pmf), f64::from(u));
    let mut link = match group {
        LightGroup::Infinite(light) => return Some((light, 0, pmf)),
        LightGroup::Tree => sampler.tree().root()?,
    };
    while let Link::Node(node) = link {
        let shares = shares(sampler.tree(), node, point, normal)?;
        let lit = shares.iter().filter(|(share, _)| *share > 0.0);
        let mut end = 0.0;
        let edges = lit.map(|(share, child)| {
            end += share;
            (end - share, share, child)
        });
        let (start, share, child) = edges.take_while(|edge| edge.0 <= u).last()?;
        u = (u - start) / share;
        pmf *= share;
        link = *child;
    }
    let Link::Part(part) = link else { return None };
    let (light, part) = sampler.part(part);
    Some((light, part as usize, pmf))
}

/// The probability of [`choose`] for `part` of `light`.
pub(super) fn pmf(
    sampler: &LightSampler,
    (point, normal): (DVec3, DVec3),
    light: u32,
    part: usize,
) -> f64 {
    let pmf = f64::from(sampler.group_pmf(light));
    let Some(part) = sampler.tree_part(light, part as u32) else {
        return pmf;
    };
    let tree = sampler.tree();
    let (Some(mut link), Some(trail)) = (tree.root(), tree.trail(part)) else {
        return 0.0;
    };
    let mut in_tree = 1.0;
    for place in trail {
        let Link::Node(node) = link else { break };
        let Some(shares) = shares(tree, node, point, normal) else {
            return 0.0;
        };
        in_tree *= shares[place].0;
        link = shares[place].1;
    }
    pmf * in_tree
}

/// The children of a node, each with its share of the importance of all; `None` when none has any.
fn shares(tree: &LightTree, node: usize, point: DVec3, normal: DVec3) -> Option<Vec<(f64, Link)>> {
    let children: Vec<_> = tree
        .clusters(node)
        .map(|cluster| (importance(&cluster, point, normal), cluster.link))
        .collect();
    let total: f64 = children.iter().map(|child| child.0).sum();
    let share = |(importance, link): (f64, Link)| (importance / total, link);
    (total > 0.0).then(|| children.into_iter().map(share).collect())
}

/// Intensity · cos θ′ · cos θᵢ′ / d² (Conty Estevez and Kulla 2018, section 4.2), each cosine mixed
/// from its bound and that of the middle.
fn importance(cluster: &LightCluster, point: DVec3, normal: DVec3) -> f64 {
    let to_light = cluster.center.as_dvec3() - point;
    let radius2 = f64::from(cluster.radius).powi(2);
    let distance2 = to_light
        .length_squared()
        .max(f64::from(LightCluster::LEAST_DISTANCE2));
    let distance = distance2.sqrt();
    let angle = |cos: f64| cos.clamp(-1.0, 1.0).acos();
    let subtended = if distance2 <= radius2 * f64::from(LightCluster::INSIDE) {
        PI
    } else {
        (radius2.sqrt() / distance).min(1.0).asin()
    };
    let along_axis = -cluster.axis.as_dvec3().dot(to_light) / distance;
    let from_axis = if cluster.two_sided {
        angle(along_axis.abs())
    } else {
        angle(along_axis)
    };
    let normals = angle(f64::from(cluster.cos_normals));
    let from_normals = (from_axis - normals).max(0.0);
    let at_light = (from_normals - subtended).max(0.0).cos();
    let to_normal = angle(normal.dot(to_light) / distance);
    let at_surface = (to_normal - subtended).max(0.0).cos();
    let edge = f64::from(LightCluster::EDGE);
    if at_surface <= 0.0 || at_light <= f64::from(cluster.cos_emission) - edge {
        return 0.0;
    }
    let middle = f64::from(LightCluster::MIDDLE);
    let mixed = |bound: f64, cos: f64| (1.0 - middle) * bound + middle * cos.max(0.0).min(bound);
    let cosines =
        mixed(at_light.max(edge), from_normals.cos()) * mixed(at_surface, to_normal.cos());
    f64::from(cluster.intensity) * cosines / distance2.max(radius2)
}
