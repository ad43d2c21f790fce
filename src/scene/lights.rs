//! The light table of the runtime scene.

use glam::{DVec3, Vec3};

use super::emitters::EmittingRectangle;
use super::{LightKind, LightNode, Scene};
use crate::geometry::Shapes;
use crate::light::{
    AreaDensity, AreaLight, AreaShape, DirectionalLight, EnvironmentLight, Light, LightSampler,
    PointFalloff, PointLight, SpotLight,
};
use crate::math::Normalization;

/// Radius of the sphere around the normalised scene, for the power of light from infinity.
const SCENE_RADIUS: f32 = 1.733;

/// Lights as they are collected.
#[derive(Debug)]
pub(super) struct LightTable {
    pub(super) lights: Vec<Light>,
    pub(super) sampled: Vec<u32>,
    pub(super) environment: Option<u32>,
    pub(super) course_compatible: bool,
}

impl LightTable {
    pub(super) fn new(course_compatible: bool) -> Self {
        Self {
            lights: Vec::new(),
            sampled: Vec::new(),
            environment: None,
            course_compatible,
        }
    }

    /// A light that rays can meet. The course's program never samples those.
    pub(super) fn add_surface(&mut self, light: Light) -> u32 {
        let index = self.lights.len() as u32;
        self.lights.push(light);
        if !self.course_compatible {
            self.sampled.push(index);
        }
        index
    }

    fn add_sampled(&mut self, light: Light) -> u32 {
        let index = self.lights.len() as u32;
        self.lights.push(light);
        self.sampled.push(index);
        index
    }

    /// The course's area light: sampled with its wrong density, never met.
    pub(super) fn add_course_rectangle(
        &mut self,
        rectangle: &EmittingRectangle,
        normalization: &Normalization,
        shapes: &Shapes,
    ) {
        let edge = |e: DVec3| (e * normalization.scale).as_vec3();
        let shape = AreaShape::Rectangle {
            corner: normalization.point_to_scene(rectangle.corner),
            edge_u: edge(rectangle.edge_u),
            edge_v: edge(rectangle.edge_v),
        };
        // Light that falls off as 1/r depends on the unit of r: the file's.
        let radiance = rectangle.radiance / normalization.scale as f32;
        let light =
            AreaLight::new(shapes, shape, radiance, false).with_density(AreaDensity::Course);
        self.add_sampled(Light::Area(light));
    }

    /// Chooses among the parts of all lights. Course-compatible scenes sample every light instead.
    pub(super) fn sampler(&self, shapes: &Shapes) -> LightSampler {
        let lights: &[Light] = if self.course_compatible {
            &[]
        } else {
            &self.lights
        };
        LightSampler::new(lights, shapes, SCENE_RADIUS)
    }
}

/// Adds the lights of nodes and the environment.
pub(super) fn light_nodes(
    scene: &Scene,
    course_compatible: bool,
    normalization: &Normalization,
    table: &mut LightTable,
) {
    for node in &scene.lights {
        let light = if course_compatible {
            course_light(node, normalization)
        } else {
            node_light(node, normalization)
        };
        if let Some(light) = light {
            table.add_sampled(light);
        }
    }
    let environment = &scene.environment;
    let map = environment.map.as_ref().map(|map| map.image.clone());
    let sky = match map {
        Some(_) => Vec3::ZERO,
        None => environment.sky,
    };
    if map.is_some() || (environment.ambient + environment.sky).max_element() > 0.0 {
        let light = EnvironmentLight::new(sky, environment.ambient, map);
        table.environment = Some(table.add_sampled(Light::Environment(light)));
    }
}

/// The light of a node; `None` for area lights, which are surfaces.
fn node_light(node: &LightNode, normalization: &Normalization) -> Option<Light> {
    // Irradiance I/d² must not depend on the unit of d.
    let intensity_scale = (normalization.scale * normalization.scale) as f32;
    let place = node.world_from_light;
    let position = normalization.point_to_scene(place.transform_point3(DVec3::ZERO));
    let forward = place.transform_vector3(DVec3::NEG_Z);
    let axis = forward.try_normalize().unwrap_or(DVec3::NEG_Y).as_vec3();
    match node.kind {
        LightKind::Area { .. } => None,
        LightKind::Point { intensity } => Some(Light::Point(PointLight {
            position,
            intensity: intensity * intensity_scale,
            falloff: PointFalloff::Correct,
        })),
        LightKind::Spot {
            intensity,
            cone_angle,
            exponent,
        } => Some(Light::Spot(SpotLight {
            position,
            axis,
            intensity: intensity * intensity_scale,
            cos_half_angle: (cone_angle * 0.5).cos() as f32,
            exponent: exponent as f32,
        })),
        LightKind::Directional { irradiance } => Some(Light::Directional(DirectionalLight {
            to_light: -axis,
            irradiance,
        })),
    }
}

/// The same as the course's program has it: point lights do not fade, spot lights give nothing, and
/// the direction of a directional light is moved by its node's translation, so that it comes from about
/// where the node stands.
fn course_light(node: &LightNode, normalization: &Normalization) -> Option<Light> {
    let place = node.world_from_light;
    match node.kind {
        LightKind::Area { .. } | LightKind::Spot { .. } => None,
        LightKind::Point { intensity } => Some(Light::Point(PointLight {
            position: normalization.point_to_scene(place.transform_point3(DVec3::ZERO)),
            intensity,
            falloff: PointFalloff::Course,
        })),
        LightKind::Directional { irradiance } => Some(Light::Directional(DirectionalLight {
            to_light: place
                .transform_point3(DVec3::NEG_Z)
                .try_normalize()
                .unwrap_or(DVec3::Y)
                .as_vec3(),
            irradiance,
        })),
    }
}
