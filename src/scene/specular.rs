use std::collections::BTreeMap;

use glam::Vec3;

use super::PreparedScene;
use crate::geometry::{Instance, Sphere};
use crate::math::Aabb;

/// Spheres around the mirrors and glass of `scene`: one for each sphere, and one for each material of
/// each mesh in each place.
pub(super) fn specular_bounds(scene: &PreparedScene) -> Vec<Sphere> {
    let tables = &*scene.tables;
    let is_specular: Vec<bool> = (tables.owners.iter())
        .map(|owner| tables.materials[owner.material as usize].bsdf.is_delta())
        .collect();
    if !is_specular.contains(&true) {
        return Vec::new();
    }
    let shapes = scene.shapes();
    let (mut spheres, mut boxes) = (Vec::new(), BTreeMap::new());
    for (primitive, &owner) in tables.owner_of.iter().enumerate() {
        if !is_specular[owner as usize] {
            continue;
        }
        match shapes.sphere(primitive as u32) {
            Some(sphere) => spheres.push(*sphere),
            None => {
                let bounds: &mut Aabb = boxes.entry(owner).or_insert(Aabb::EMPTY);
                let corners = shapes.vertices(primitive);
                *bounds = corners.into_iter().fold(*bounds, Aabb::grow);
            }
        }
    }
    spheres.extend(boxes.values().filter_map(around));
    if let Some(instances) = scene.aggregate().instances() {
        for (instance, shared) in instances.list().iter().zip(&tables.shared) {
            let first = shared.first_owner as usize;
            if is_specular[first..first + usize::from(shared.slots)].contains(&true) {
                spheres.extend(around(&bounds_of(instance)));
            }
        }
    }
    spheres
}

/// A box around the corners of the box of the mesh.
fn bounds_of(instance: &Instance) -> Aabb {
    let positions = instance.mesh().shapes().positions.iter().copied();
    let bounds = Aabb::from_points(positions);
    let to_world = instance.placement().world_from_object();
    Aabb::from_points((0..8).map(|corner| {
        let pick = |axis: usize| match corner >> axis & 1 {
            0 => bounds.min[axis],
            _ => bounds.max[axis],
        };
        let corner = Vec3::new(pick(0), pick(1), pick(2));
        to_world.transform_point3(corner.as_dvec3()).as_vec3()
    }))
}

fn around(bounds: &Aabb) -> Option<Sphere> {
    let radius = 0.5 * bounds.extent().length();
    (radius > 0.0 && radius.is_finite()).then(|| Sphere {
        center: bounds.center(),
        radius,
    })
}
