use std::sync::Arc;

use glam::{DMat4, DVec3};

use super::{
    FieldOfView, FileCamera, Geometry, Instance, LightKind, LightNode, Material, Scene, Surface,
};
use crate::camera::Camera;
use crate::color::Rgb;
use crate::geometry::{Corner, Mesh, MeshTriangle};

/// Puts a scene together piece by piece: procedural scenes and tests.
///
/// ```
/// use softbox::color::Rgb;
/// use softbox::scene::{SceneBuilder, Surface};
/// use glam::DVec3;
///
/// let mut builder = SceneBuilder::new("one sphere");
/// let grey = builder.diffuse("grey", Rgb::splat(0.5));
/// builder.sphere("ball", DVec3::ZERO, 1.0, grey);
/// assert!(!builder.finish().has_light());
/// ```
#[derive(Clone, Debug, Default)]
pub struct SceneBuilder {
    scene: Scene,
}

impl SceneBuilder {
    /// An empty scene called `name`.
    pub fn new(name: &str) -> Self {
        Self {
            scene: Scene {
                name: name.to_owned(),
                metres_per_unit: 1.0,
                ..Scene::default()
            },
        }
    }

    /// The scene.
    pub fn finish(self) -> Scene {
        self.scene
    }

    /// The scene so far, for what has no method of its own.
    pub fn scene_mut(&mut self) -> &mut Scene {
        &mut self.scene
    }

    /// Adds a material; returns its index.
    pub fn material(&mut self, material: Material) -> usize {
        self.scene.materials.push(material);
        self.scene.materials.len() - 1
    }

    /// Adds a surface that does not emit.
    pub fn surface(&mut self, name: &str, surface: Surface) -> usize {
        self.material(Material {
            name: name.to_owned(),
            surface,
            ..Material::default()
        })
    }

    /// Adds a Lambertian material.
    pub fn diffuse(&mut self, name: &str, reflectance: Rgb) -> usize {
        self.surface(name, Surface::Diffuse { reflectance })
    }

    /// Adds a material that emits `radiance` from its front and reflects nothing.
    pub fn emitter(&mut self, name: &str, radiance: Rgb) -> usize {
        self.material(Material {
            name: name.to_owned(),
            surface: Surface::Diffuse {
                reflectance: Rgb::ZERO,
            },
            emission: radiance,
            double_sided: false,
        })
    }

    /// Adds a sphere.
    pub fn sphere(&mut self, name: &str, center: DVec3, radius: f64, material: usize) {
        let geometry = Geometry::Sphere {
            name: name.to_owned(),
            radius,
        };
        self.place(name, geometry, DMat4::from_translation(center), material);
    }

    /// Adds the parallelogram `corner`, `corner + u`, `corner + u + v`, `corner + v`, whose front
    /// is the side of u × v.
    pub fn quad(&mut self, name: &str, corner: DVec3, u: DVec3, v: DVec3, material: usize) {
        let positions = vec![corner, corner + u, corner + u + v, corner + v];
        self.mesh(name, positions, &[[0, 1, 2], [0, 2, 3]], material);
    }

    /// Adds triangles in world coordinates, without normals.
    pub fn mesh(
        &mut self,
        name: &str,
        positions: Vec<DVec3>,
        triangles: &[[u32; 3]],
        material: usize,
    ) {
        let corner = |position| Corner {
            position,
            normal: Corner::NO_NORMAL,
        };
        let triangles = triangles
            .iter()
            .map(|t| MeshTriangle {
                corners: t.map(corner),
                material_slot: 0,
            })
            .collect();
        let mesh = Mesh {
            name: name.to_owned(),
            positions,
            normals: Vec::new(),
            triangles,
        };
        self.place(name, Geometry::Mesh(mesh), DMat4::IDENTITY, material);
    }

    fn place(&mut self, name: &str, geometry: Geometry, world_from_object: DMat4, material: usize) {
        self.scene.geometries.push(Arc::new(geometry));
        self.scene.instances.push(Instance {
            name: name.to_owned(),
            geometry: self.scene.geometries.len() - 1,
            world_from_object,
            materials: vec![material],
        });
    }

    /// Adds a light node.
    pub fn light(&mut self, name: &str, kind: LightKind, world_from_light: DMat4) {
        self.scene.lights.push(LightNode {
            name: name.to_owned(),
            kind,
            world_from_light,
        });
    }

    /// Adds a camera at `eye` that looks at `target`, y up.
    pub fn camera(&mut self, eye: DVec3, target: DVec3, fov_x: f64) {
        self.scene.cameras.push(FileCamera {
            name: "camera".to_owned(),
            world_from_camera: looking_at(eye, target),
            fov: FieldOfView {
                x: Some(fov_x),
                y: None,
                aspect: None,
            },
        });
    }
}

fn looking_at(eye: DVec3, target: DVec3) -> DMat4 {
    let camera = Camera {
        eye,
        target,
        ..Camera::default()
    };
    let (right, up, back) = camera.basis();
    DMat4::from_cols(
        right.extend(0.0),
        up.extend(0.0),
        back.extend(0.0),
        eye.extend(1.0),
    )
}
