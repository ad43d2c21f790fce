use std::path::PathBuf;
use std::sync::Arc;

use glam::{DMat4, DVec3};

use crate::color::Rgb;
use crate::geometry::Mesh;
use crate::image::Image;

/// Radiance of the sky that a scene without light gets.
const ADDED_SKY: Rgb = Rgb::splat(0.8);

/// A scene as a file describes it: plain data with indices, large parts shared, double precision.
///
/// All matrices and points are in the file's units, after conversion to a Y-up world.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Scene {
    /// Shown name: the file's stem or the built-in scene's name.
    pub name: String,
    /// The file it was read from, `None` for built-in scenes.
    pub path: Option<PathBuf>,
    /// Which rules the file's camera and normals follow.
    pub dialect: Dialect,
    /// The up axis that the file declared (already converted to Y up).
    pub up_axis: UpAxis,
    /// Metres per unit as the file declares; reported, never applied.
    pub metres_per_unit: f64,
    /// Shared geometry.
    pub geometries: Vec<Arc<Geometry>>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Placed geometry.
    pub instances: Vec<Instance>,
    /// Placed lights that are not emissive surfaces.
    pub lights: Vec<LightNode>,
    /// Light from infinity.
    pub environment: Environment,
    /// Cameras, in file order.
    pub cameras: Vec<FileCamera>,
}

/// Whose dialect of COLLADA a file speaks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dialect {
    /// Profile CGL or CMU462 anywhere in the file: the course's camera rule applies.
    Course,
    /// Any other exporter.
    #[default]
    Plain,
}

/// The up axis of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UpAxis {
    /// x up.
    X,
    /// y up, as in softbox.
    #[default]
    Y,
    /// z up.
    Z,
}

/// What an instance places.
#[derive(Clone, Debug, PartialEq)]
pub enum Geometry {
    /// Triangles.
    Mesh(Mesh),
    /// An analytic sphere around the origin of object space; `name` and radius in file units.
    Sphere {
        /// Name or id in the file.
        name: String,
        /// Radius, positive.
        radius: f64,
    },
}

/// A placed geometry.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// Name or id of the node.
    pub name: String,
    /// Index into [`Scene::geometries`].
    pub geometry: usize,
    /// point_in_world = world_from_object · point_in_object. A negative determinant mirrors.
    pub world_from_object: DMat4,
    /// Index into [`Scene::materials`] for each material slot of the mesh (one for a sphere).
    pub materials: Vec<usize>,
}

/// A named surface description.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name or id in the file.
    pub name: String,
    /// How it scatters light.
    pub surface: Surface,
    /// Radiance it emits; black for most.
    pub emission: Rgb,
    /// Emits from both sides; otherwise from the front side only.
    pub double_sided: bool,
}

impl Default for Material {
    /// Grey 0.5 diffuse, the course's fallback.
    fn default() -> Self {
        Self {
            name: "default".to_owned(),
            surface: Surface::Diffuse {
                reflectance: Rgb::splat(0.5),
            },
            emission: Rgb::ZERO,
            double_sided: false,
        }
    }
}

/// The scattering models of the course.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Surface {
    /// Lambertian.
    Diffuse {
        /// Albedo, 0..1.
        reflectance: Rgb,
    },
    /// Perfect mirror.
    Mirror {
        /// Reflectance, 0..1.
        reflectance: Rgb,
    },
    /// Smooth dielectric that transmits only (total reflection where it must).
    Refraction {
        /// Tint of transmitted light, 0..1.
        transmittance: Rgb,
        /// Absolute index of refraction.
        ior: f32,
    },
    /// Smooth dielectric, Fresnel-weighted reflection and transmission.
    Glass {
        /// Tint of reflected light, 0..1.
        reflectance: Rgb,
        /// Tint of transmitted light, 0..1.
        transmittance: Rgb,
        /// Absolute index of refraction.
        ior: f32,
    },
    /// Rough conductor: Beckmann distribution.
    Microfacet {
        /// Beckmann width.
        alpha: f32,
        /// Real part of the index of refraction per channel.
        eta: Rgb,
        /// Imaginary part per channel.
        k: Rgb,
    },
}

/// A light that a node places.
#[derive(Clone, Debug, PartialEq)]
pub struct LightNode {
    /// Name or id of the node.
    pub name: String,
    /// What shines.
    pub kind: LightKind,
    /// Placement: the light looks along its local −z.
    pub world_from_light: DMat4,
}

/// The kinds of placed lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// The square [−½, ½]² in the node's xy plane, emitting towards local −z.
    Area {
        /// Radiance.
        radiance: Rgb,
    },
    /// Intensity in all directions, falls with 1/r² (r in file units).
    Point {
        /// Radiant intensity.
        intensity: Rgb,
    },
    /// A point light inside a cone about local −z.
    Spot {
        /// Radiant intensity on the axis.
        intensity: Rgb,
        /// Full opening angle of the cone in radians, (0, π].
        cone_angle: f64,
        /// Exponent of cos(angle to the axis); 0 = even inside the cone.
        exponent: f64,
    },
    /// Parallel light along local −z.
    Directional {
        /// Irradiance on a surface that faces the light.
        irradiance: Rgb,
    },
}

/// Light from infinity.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Environment {
    /// Constant radiance of the upper (world +y) hemisphere that the camera does not see (the
    /// course's ambient light).
    pub ambient: Rgb,
    /// Constant radiance of the whole sphere, seen by the camera too.
    pub sky: Rgb,
    /// A picture of the whole sphere; it takes the place of `sky`.
    pub map: Option<EnvironmentMap>,
    /// True when softbox added `sky` because the scene had no light at all.
    pub is_added: bool,
}

/// A latitude-longitude picture of radiance at infinity.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentMap {
    /// The file it came from.
    pub path: PathBuf,
    /// Radiance: top row at +y; the column is φ/2π with φ = atan2(−z, x) + π.
    pub image: Arc<Image<Rgb>>,
}

/// A camera that a node places; it looks along its local −z, local +y is up.
#[derive(Clone, Debug, PartialEq)]
pub struct FileCamera {
    /// Name or id of the node.
    pub name: String,
    /// Placement.
    pub world_from_camera: DMat4,
    /// Opening angles.
    pub fov: FieldOfView,
}

/// Opening angles as the file gives them, in radians; at least one is set.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct FieldOfView {
    /// Full horizontal angle.
    pub x: Option<f64>,
    /// Full vertical angle.
    pub y: Option<f64>,
    /// Width over height.
    pub aspect: Option<f64>,
}

impl Scene {
    /// The corners of the bounding box of all geometry in world space, file units; `None` when the
    /// scene is empty.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let mut min = DVec3::INFINITY;
        let mut max = DVec3::NEG_INFINITY;
        let mut include = |p: DVec3| {
            if p.is_finite() {
                min = min.min(p);
                max = max.max(p);
            }
        };
        let mut used: Vec<Option<Vec<DVec3>>> = vec![None; self.geometries.len()];
        for instance in &self.instances {
            let to_world = instance.world_from_object;
            match self.geometries[instance.geometry].as_ref() {
                Geometry::Mesh(mesh) => {
                    let used = used[instance.geometry].get_or_insert_with(|| mesh.used_positions());
                    for &position in used.iter() {
                        include(to_world.transform_point3(position));
                    }
                }
                Geometry::Sphere { radius, .. } => {
                    let center = to_world.transform_point3(DVec3::ZERO);
                    let world_radius = radius * to_world.x_axis.truncate().length();
                    include(center - DVec3::splat(world_radius));
                    include(center + DVec3::splat(world_radius));
                }
            }
        }
        (min.x <= max.x).then_some((min, max))
    }

    /// True when something emits: a light node, an emissive material in use, or the environment.
    pub fn has_light(&self) -> bool {
        let emits = |index: &usize| self.materials[*index].emission.max_element() > 0.0;
        !self.lights.is_empty()
            || self.environment.map.is_some()
            || (self.environment.ambient + self.environment.sky).max_element() > 0.0
            || self
                .instances
                .iter()
                .any(|instance| instance.materials.iter().any(emits))
    }

    /// Gives a scene without any light a soft sky, so that there is something to see; true when it
    /// did. [`Environment::is_added`] keeps it apart from the scene's own light.
    pub fn light_if_dark(&mut self) -> bool {
        if self.has_light() {
            return false;
        }
        self.environment.sky = ADDED_SKY;
        self.environment.is_added = true;
        true
    }
}
