//! Crate `obvhs`: a binary tree and a compressed wide one, both by its medium build (PLOC and
//! reinsertion).

use std::mem::size_of_val;

use clap::ValueEnum;
use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::bvh2::{Bvh2, builder::build_bvh2_from_tris};
use obvhs::cwbvh::{CwBvh, builder::build_cwbvh_from_tris};
use obvhs::ray::RayHit;
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;
use softbox::geometry::{Hit, Shapes};
use softbox::math::Ray;

use crate::ray_bench::system::on_threads;
use crate::ray_bench::{Kind, System, Tracer};

/// Both trees.
pub(crate) fn systems() -> Vec<System> {
    let all = Kind::value_variants();
    vec![
        System::new("obvhs-bvh2", all, |shapes, threads| {
            let input = triangles(shapes);
            Box::new(on_threads(threads, move || {
                let params = BvhBuildParams::medium_build();
                let tree = build_bvh2_from_tris(&input, params, &mut Default::default());
                Box::new(Binary {
                    triangles: in_order(&input, &tree.primitive_indices),
                    tree,
                })
            }))
        }),
        System::new("obvhs-cwbvh", all, |shapes, threads| {
            let input = triangles(shapes);
            Box::new(on_threads(threads, move || {
                let params = BvhBuildParams::medium_build();
                let tree = build_cwbvh_from_tris(&input, params, &mut Default::default());
                Box::new(Wide {
                    triangles: in_order(&input, &tree.primitive_indices),
                    tree,
                })
            }))
        }),
    ]
}

fn triangles(shapes: &Shapes) -> Vec<Triangle> {
    let all = (0..shapes.triangles.len()).map(|i| {
        let [v0, v1, v2] = shapes.vertices(i).map(Vec3A::from);
        Triangle { v0, v1, v2 }
    });
    all.collect()
}

/// In the order of the leaves, so that no index is looked up for a test.
fn in_order(triangles: &[Triangle], order: &[u32]) -> Vec<RtTriangle> {
    order
        .iter()
        .map(|&i| (&triangles[i as usize]).into())
        .collect()
}

fn converted(ray: &Ray) -> obvhs::ray::Ray {
    obvhs::ray::Ray::new(
        ray.origin.into(),
        ray.direction.into(),
        ray.t_min,
        ray.t_max,
    )
}

fn hit(found: &RayHit, order: &[u32]) -> Hit {
    match found.primitive_id {
        u32::MAX => Hit::MISS,
        slot => Hit {
            t: found.t,
            primitive: order[slot as usize],
            b1: 0.0,
            b2: 0.0,
        },
    }
}

struct Binary {
    tree: Bvh2,
    triangles: Vec<RtTriangle>,
}

impl Tracer for Binary {
    fn closest_hit(&self, rays: &[Ray], hits: &mut [Hit]) {
        for (ray, out) in rays.iter().zip(hits) {
            let mut found = RayHit::none();
            let test = |ray: &obvhs::ray::Ray, slot: usize| self.triangles[slot].intersect(ray);
            self.tree.ray_traverse(converted(ray), &mut found, test);
            *out = hit(&found, &self.tree.primitive_indices);
        }
    }

    fn any_hit(&self, rays: &[Ray], occluded: &mut [bool]) {
        for (ray, out) in rays.iter().zip(occluded) {
            let test = |ray: &obvhs::ray::Ray, slot: usize| self.triangles[slot].intersect(ray);
            *out = !self.tree.ray_traverse_miss(converted(ray), test);
        }
    }

    fn bytes(&self) -> usize {
        size_of_val(&*self.tree.nodes)
            + size_of_val(&*self.tree.primitive_indices)
            + size_of_val(&*self.triangles)
    }
}

struct Wide {
    tree: CwBvh,
    triangles: Vec<RtTriangle>,
}

impl Tracer for Wide {
    fn closest_hit(&self, rays: &[Ray], hits: &mut [Hit]) {
        for (ray, out) in rays.iter().zip(hits) {
            let mut found = RayHit::none();
            let test = |ray: &obvhs::ray::Ray, slot: usize| self.triangles[slot].intersect(ray);
            self.tree.ray_traverse(converted(ray), &mut found, test);
            *out = hit(&found, &self.tree.primitive_indices);
        }
    }

    fn any_hit(&self, rays: &[Ray], occluded: &mut [bool]) {
        for (ray, out) in rays.iter().zip(occluded) {
            let test = |ray: &obvhs::ray::Ray, slot: usize| self.triangles[slot].intersect(ray);
            *out = !self.tree.ray_traverse_miss(converted(ray), test);
        }
    }

    fn bytes(&self) -> usize {
        size_of_val(&*self.tree.nodes)
            + size_of_val(&*self.tree.primitive_indices)
            + size_of_val(&*self.triangles)
    }
}
