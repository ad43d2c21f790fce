//! Crate `bvh`: a binary tree, walked by its unordered iterator, which measured faster than its
//! ordered ones. The crate has no triangle test that respects the bounds of a ray; this is one.

use std::mem::{size_of, size_of_val};

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::{Bvh, BvhNode};
use clap::ValueEnum;
use glam::Vec3;
use nalgebra::{Point3, Vector3};
use softbox::geometry::{Hit, Shapes};
use softbox::math::Ray;

use crate::ray_bench::system::on_threads;
use crate::ray_bench::{Kind, System, Tracer};

/// The tree.
pub(crate) fn system() -> System {
    System::new("bvh", Kind::value_variants(), |shapes, threads| {
        let mut triangles = triangles(shapes);
        Box::new(on_threads(threads, move || {
            let tree = if threads > 1 {
                Bvh::build_with_executor(&mut triangles, bvh::bvh::rayon_executor)
            } else {
                Bvh::build(&mut triangles)
            };
            Box::new(Binary { tree, triangles })
        }))
    })
}

fn triangles(shapes: &Shapes) -> Vec<Triangle> {
    let all = (0..shapes.triangles.len()).map(|i| Triangle {
        vertices: shapes.vertices(i),
        node: 0,
        id: i as u32,
    });
    all.collect()
}

struct Triangle {
    vertices: [Vec3; 3],
    node: usize,
    id: u32,
}

impl Bounded<f32, 3> for Triangle {
    fn aabb(&self) -> Aabb<f32, 3> {
        let points = self.vertices.map(|v| Point3::from(v.to_array()));
        points
            .iter()
            .fold(Aabb::empty(), |bounds, point| bounds.grow(point))
    }
}

impl BHShape<f32, 3> for Triangle {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

impl Triangle {
    /// Moeller and Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection".
    #[inline(always)]
    fn meet(&self, ray: &Ray, end: f32) -> Option<Hit> {
        let [a, b, c] = self.vertices;
        let (u, v) = (b - a, c - a);
        let across = ray.direction.cross(v);
        let inverse = 1.0 / u.dot(across);
        let from = ray.origin - a;
        let b1 = from.dot(across) * inverse;
        let turned = from.cross(u);
        let b2 = ray.direction.dot(turned) * inverse;
        let t = v.dot(turned) * inverse;
        let is_met = b1 >= 0.0 && b2 >= 0.0 && b1 + b2 <= 1.0 && t > ray.t_min && t < end;
        is_met.then_some(Hit {
            t,
            primitive: self.id,
            b1,
            b2,
        })
    }
}

struct Binary {
    tree: Bvh<f32, 3>,
    triangles: Vec<Triangle>,
}

fn converted(ray: &Ray) -> bvh::ray::Ray<f32, 3> {
    bvh::ray::Ray::new(
        Point3::from(ray.origin.to_array()),
        Vector3::from(ray.direction.to_array()),
    )
}

impl Tracer for Binary {
    fn closest_hit(&self, rays: &[Ray], hits: &mut [Hit]) {
        for (ray, out) in rays.iter().zip(hits) {
            let (mut best, mut end) = (Hit::MISS, ray.t_max);
            for triangle in self
                .tree
                .traverse_iterator(&converted(ray), &self.triangles)
            {
                if let Some(hit) = triangle.meet(ray, end) {
                    (best, end) = (hit, hit.t);
                }
            }
            *out = best;
        }
    }

    fn any_hit(&self, rays: &[Ray], occluded: &mut [bool]) {
        for (ray, out) in rays.iter().zip(occluded) {
            let query = converted(ray);
            let mut met = self.tree.traverse_iterator(&query, &self.triangles);
            *out = met.any(|triangle| triangle.meet(ray, ray.t_max).is_some());
        }
    }

    fn bytes(&self) -> usize {
        self.tree.nodes.len() * size_of::<BvhNode<f32, 3>>() + size_of_val(&*self.triangles)
    }
}
