use glam::Vec3;

use super::{Light, LightTree, Link};
use crate::geometry::Shapes;
use crate::sampling::Distribution1d;

/// A part of a light, chosen for sampling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightChoice {
    /// Index of the light.
    pub light: u32,
    /// Part of the light, see [`Light::part_count`].
    pub part: u32,
    /// The probability of the choice, above 0.
    pub pmf: f32,
}

/// Chooses among the parts of lights: those from infinity and all others together by power, the
/// others by what they may give at the point and on the side of the surface that asks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LightSampler {
    /// The lights from infinity, then the tree; nothing when no light shines.
    groups: Option<Distribution1d>,
    /// Indices of the lights from infinity.
    infinite: Vec<u32>,
    tree: LightTree,
    /// Light and part, for each part of the tree.
    parts: Vec<(u32, u32)>,
    /// For each light its first part in the tree.
    first: Vec<u32>,
}

/// What the sampler chooses in the first step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightGroup {
    /// A light from infinity.
    Infinite(u32),
    /// All others.
    Tree,
}

impl LightSampler {
    /// A sampler over `lights`. Lights that do not shine are never chosen, and neither are skies that
    /// are the same all over: rays that leave the scene find them better.
    ///
    /// `scene_radius` is that of a sphere around the scene, for the power of light from infinity.
    pub fn new(lights: &[Light], shapes: &Shapes, scene_radius: f32) -> Self {
        let (mut infinite, mut powers) = (Vec::new(), Vec::new());
        let (mut parts, mut first, mut bounds) = (Vec::new(), Vec::new(), Vec::new());
        let mut power_of_tree = 0.0;
        for (light, index) in lights.iter().zip(0..) {
            first.push(parts.len() as u32);
            let power = light.power(shapes, scene_radius);
            if light.is_infinite() {
                if !light.is_constant_sky() {
                    infinite.push(index);
                    powers.push(power);
                }
                continue;
            }
            power_of_tree += if power.is_finite() { power } else { 0.0 };
            for part in 0..light.part_count() {
                parts.push((index, part as u32));
                bounds.push(light.part_bounds(shapes, part));
            }
        }
        let tree = LightTree::new(bounds);
        powers.push(if tree.root().is_none() {
            0.0
        } else {
            power_of_tree
        });
        Self {
            groups: Distribution1d::new(&powers),
            infinite,
            tree,
            parts,
            first,
        }
    }

    /// The light that is always chosen, if there is only one part to choose from.
    pub fn only_light(&self) -> Option<u32> {
        match (self.tree.root(), &self.infinite[..]) {
            (Some(Link::Part(part)), []) => Some(self.parts[part].0),
            _ => None,
        }
    }

    /// The number of parts to choose from.
    pub fn choices(&self) -> usize {
        self.parts.len() + self.infinite.len()
    }

    /// True when nothing is ever chosen.
    pub fn is_empty(&self) -> bool {
        self.groups.is_none()
    }

    /// A part of a light for a surface at `point`, lit on the side of the unit `normal`; `u` in
    /// [0, 1). `None` when `u` falls on lights that give nothing there.
    pub fn sample(&self, point: Vec3, normal: Vec3, u: f32) -> Option<LightChoice> {
        let (group, pmf, u) = self.choose_group(u)?;
        match group {
            LightGroup::Infinite(light) => Some(LightChoice {
                light,
                part: 0,
                pmf,
            }),
            LightGroup::Tree => {
                let (part, in_tree) = self.tree.sample(point, normal, u)?;
                let (light, part) = self.parts[part];
                Some(LightChoice {
                    light,
                    part,
                    pmf: pmf * in_tree,
                })
            }
        }
    }

    /// The probability with which [`Self::sample`] gives `part` of `light` for the same point and
    /// normal.
    pub fn pmf(&self, point: Vec3, normal: Vec3, light: u32, part: u32) -> f32 {
        let in_group = self.group_pmf(light);
        match self.tree_part(light, part) {
            Some(part) => in_group * self.tree.pmf(point, normal, part),
            None => in_group,
        }
    }

    /// The first step of [`Self::sample`]: the group, its probability, and `u` stretched over it.
    pub fn choose_group(&self, u: f32) -> Option<(LightGroup, f32, f32)> {
        let (index, pmf, u) = self.groups.as_ref()?.sample(u);
        let infinite = self.infinite.get(index);
        let group = infinite.map_or(LightGroup::Tree, |&light| LightGroup::Infinite(light));
        Some((group, pmf, u))
    }

    /// The probability of the group that `light` belongs to; 0 when it is never chosen.
    pub fn group_pmf(&self, light: u32) -> f32 {
        let Some(groups) = &self.groups else {
            return 0.0;
        };
        if self.tree_part(light, 0).is_some() {
            return groups.pmf(self.infinite.len());
        }
        let place = self.infinite.iter().position(|&i| i == light);
        place.map_or(0.0, |place| groups.pmf(place))
    }

    /// The number in the tree of `part` of `light`; `None` when it is not among its parts.
    pub fn tree_part(&self, light: u32, part: u32) -> Option<usize> {
        let part = (self.first.get(light as usize)? + part) as usize;
        (self.parts.get(part)?.0 == light).then_some(part)
    }

    /// Light and part that are number `part` of the tree.
    pub fn part(&self, part: usize) -> (u32, u32) {
        self.parts[part]
    }

    /// The tree over all lights that have a place.
    pub fn tree(&self) -> &LightTree {
        &self.tree
    }
}
