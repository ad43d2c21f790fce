//! Which surfaces and light nodes of a description emit: one emitter where the course's files have
//! two.

use std::collections::HashMap;

use glam::{DMat4, DVec3};

use super::{Geometry, LightKind, Scene};
use crate::color::Rgb;

/// A light's rectangle and an emissive mesh are the same emitter when their areas differ by less.
const SAME_AREA: f64 = 0.01;
/// … and the mesh lies in the light's plane up to this fraction of the light's size.
const SAME_PLANE: f64 = 0.01;

/// Emission of one material slot of one instance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SurfaceEmission {
    pub(super) radiance: Rgb,
    pub(super) two_sided: bool,
    /// The emitting side, where a light node decides it; otherwise the front.
    pub(super) towards: Option<DVec3>,
}

/// A rectangle that emits towards `edge_u × edge_v`, world space, file units.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct EmittingRectangle {
    pub(super) name: String,
    pub(super) corner: DVec3,
    pub(super) edge_u: DVec3,
    pub(super) edge_v: DVec3,
    pub(super) radiance: Rgb,
}

/// What [`emitters`] finds.
#[derive(Debug, Default)]
pub(super) struct Emitters {
    /// Emission by (instance, material slot).
    pub(super) surfaces: HashMap<(usize, u16), SurfaceEmission>,
    /// Area lights without a mesh of their own.
    pub(super) rectangles: Vec<EmittingRectangle>,
    /// One sentence for each light node that became its mesh.
    pub(super) notes: Vec<String>,
}

/// The emitters of `scene`. With `course_compatible` light nodes and emissive meshes stay apart,
/// as in the course's program.
pub(super) fn emitters(scene: &Scene, course_compatible: bool) -> Emitters {
    let mut found = Emitters::default();
    for (index, instance) in scene.instances.iter().enumerate() {
        for (slot, &material) in instance.materials.iter().enumerate() {
            let material = &scene.materials[material];
            if material.emission.max_element() > 0.0 {
                let emission = SurfaceEmission {
                    radiance: material.emission,
                    two_sided: material.double_sided || course_compatible,
                    towards: None,
                };
                found.surfaces.insert((index, slot as u16), emission);
            }
        }
    }
    let mut candidates: Vec<FlatEmitter> = if course_compatible {
        Vec::new()
    } else {
        let mut keys: Vec<(usize, u16)> = found.surfaces.keys().copied().collect();
        keys.sort_unstable();
        keys.into_iter()
            .filter_map(|key| FlatEmitter::new(scene, key))
            .collect()
    };
    for light in &scene.lights {
        let LightKind::Area { radiance } = light.kind else {
            continue;
        };
        let rectangle = rectangle(&light.name, light.world_from_light, radiance);
        let normal = rectangle.edge_u.cross(rectangle.edge_v);
        match candidates.iter().position(|c| c.is(&rectangle)) {
            Some(at) => {
                let mesh = candidates.swap_remove(at);
                let emission = SurfaceEmission {
                    radiance,
                    two_sided: false,
                    towards: Some(normal),
                };
                found.surfaces.insert(mesh.key, emission);
                found.notes.push(format!(
                    "Area light '{}' lies on the emissive mesh '{}': the mesh emits, on the light's side only, with the light's colour.",
                    light.name, scene.instances[mesh.key.0].name
                ));
            }
            None => found.rectangles.push(rectangle),
        }
    }
    found
}

fn rectangle(name: &str, world_from_light: DMat4, radiance: Rgb) -> EmittingRectangle {
    let edge_u = world_from_light.transform_vector3(DVec3::X);
    let edge_v = world_from_light.transform_vector3(DVec3::Y);
    let center = world_from_light.transform_point3(DVec3::ZERO);
    let corner = center - 0.5 * (edge_u + edge_v);
    let faces = world_from_light.transform_vector3(DVec3::NEG_Z);
    // Swapping the edges turns the emitting side.
    let (edge_u, edge_v) = if edge_u.cross(edge_v).dot(faces) < 0.0 {
        (edge_v, edge_u)
    } else {
        (edge_u, edge_v)
    };
    EmittingRectangle {
        name: name.to_owned(),
        corner,
        edge_u,
        edge_v,
        radiance,
    }
}

/// An emissive mesh slot and its extent.
struct FlatEmitter {
    key: (usize, u16),
    area: f64,
    vertices: Vec<DVec3>,
}

impl FlatEmitter {
    fn new(scene: &Scene, key: (usize, u16)) -> Option<Self> {
        let instance = &scene.instances[key.0];
        let Geometry::Mesh(mesh) = scene.geometries[instance.geometry].as_ref() else {
            return None;
        };
        let mut emitter = Self {
            key,
            area: 0.0,
            vertices: Vec::new(),
        };
        for triangle in mesh.triangles.iter().filter(|t| t.material_slot == key.1) {
            let [a, b, c] = triangle.corners.map(|c| {
                instance
                    .world_from_object
                    .transform_point3(mesh.positions[c.position as usize])
            });
            emitter.area += 0.5 * (b - a).cross(c - a).length();
            emitter.vertices.extend([a, b, c]);
        }
        (emitter.area > 0.0).then_some(emitter)
    }

    /// True when this mesh and `light` are the same emitter.
    fn is(&self, light: &EmittingRectangle) -> bool {
        let normal = light.edge_u.cross(light.edge_v);
        let area = normal.length();
        let size = area.sqrt();
        let Some(unit) = normal.try_normalize() else {
            return false;
        };
        let center = light.corner + 0.5 * (light.edge_u + light.edge_v);
        let middle = self.vertices.iter().sum::<DVec3>() / self.vertices.len() as f64;
        (self.area / area - 1.0).abs() <= SAME_AREA
            && self
                .vertices
                .iter()
                .all(|v| (*v - center).dot(unit).abs() <= SAME_PLANE * size)
            && (middle - center).length() <= 0.5 * size
    }
}
