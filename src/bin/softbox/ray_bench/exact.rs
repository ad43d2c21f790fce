use glam::{DVec3, Vec3};
use rayon::prelude::*;
use softbox::bvh::{Bvh, NodeId};
use softbox::geometry::{Aggregate, Hit};
use softbox::math::{Aabb, Ray};

/// Boxes are met this much longer than they say, relative to the ray parameter.
const MARGIN: f64 = 1e-6;

/// Triangle tests in double precision by formulas of their own: says what rays hit. Slow.
///
/// Moeller and Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection". The boxes are those of
/// the library's tree; what that tree loses is lost here too, and shows up as a mismatch of all
/// other systems.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exact<'a>(pub(crate) &'a Aggregate);

impl Exact<'_> {
    /// The closest hits. `t` is rounded at the end.
    pub(crate) fn closest_hits(&self, rays: &[Ray]) -> Vec<Hit> {
        rays.par_iter()
            .map_init(Vec::new, |open, ray| self.closest_hit(ray, open))
            .collect()
    }

    fn closest_hit(&self, ray: &Ray, open: &mut Vec<(NodeId, f64)>) -> Hit {
        let bvh = self.0.bvh();
        let line = Line::new(ray);
        let mut best = Hit::MISS;
        let mut end = f64::from(ray.t_max);
        open.clear();
        open.extend(bvh.root().and_then(|root| line.entry(bvh, root)));
        while let Some((node, entry)) = open.pop() {
            if entry > end {
                continue;
            }
            let Some(children) = bvh.children(node) else {
                for primitive in self.0.primitives(node) {
                    let vertices = self.0.shapes().vertices(primitive as usize);
                    let Some((t, b1, b2)) = line.meet(vertices).filter(|(t, ..)| *t < end) else {
                        continue;
                    };
                    end = t;
                    best = Hit {
                        t: t as f32,
                        primitive,
                        b1: b1 as f32,
                        b2: b2 as f32,
                    };
                }
                continue;
            };
            let mut near = children.map(|child| line.entry(bvh, child));
            // The nearer child comes off the stack first.
            near.sort_by(|a, b| key(b).total_cmp(&key(a)));
            open.extend(near.into_iter().flatten());
        }
        best
    }
}

fn key(entry: &Option<(NodeId, f64)>) -> f64 {
    entry.map_or(f64::INFINITY, |(_, t)| t)
}

/// A ray in double precision.
struct Line {
    origin: DVec3,
    direction: DVec3,
    inverse: DVec3,
    t_min: f64,
}

impl Line {
    fn new(ray: &Ray) -> Self {
        let direction = ray.direction.as_dvec3();
        Self {
            origin: ray.origin.as_dvec3(),
            direction,
            // No zeros, so that 0 · infinity cannot arise.
            inverse: (direction + DVec3::ZERO)
                .recip()
                .clamp(DVec3::splat(-1e300), DVec3::splat(1e300)),
            t_min: f64::from(ray.t_min),
        }
    }

    fn entry(&self, bvh: &Bvh, node: NodeId) -> Option<(NodeId, f64)> {
        let Aabb { min, max } = bvh.bounds(node);
        let a = (min.as_dvec3() - self.origin) * self.inverse;
        let b = (max.as_dvec3() - self.origin) * self.inverse;
        let near = a.min(b).max_element().max(self.t_min);
        let far = a.max(b).min_element();
        (near <= far + MARGIN * far.abs()).then_some((node, near * (1.0 - MARGIN)))
    }

    /// Ray parameter and weights of the second and third vertex.
    fn meet(&self, vertices: [Vec3; 3]) -> Option<(f64, f64, f64)> {
        let [a, b, c] = vertices.map(Vec3::as_dvec3);
        let (u, v) = (b - a, c - a);
        let across = self.direction.cross(v);
        let volume = u.dot(across);
        let from = self.origin - a;
        let b1 = from.dot(across) / volume;
        let turned = from.cross(u);
        let b2 = self.direction.dot(turned) / volume;
        let t = v.dot(turned) / volume;
        let is_inside = volume != 0.0 && b1 >= 0.0 && b2 >= 0.0 && b1 + b2 <= 1.0;
        (is_inside && t > self.t_min).then_some((t, b1, b2))
    }
}
