use std::ops::ControlFlow;

use anyhow::anyhow;
use glam::{DVec3, Vec2, Vec3};
use softbox::camera::{Camera, Framing};
use softbox::geometry::Shapes;
use softbox::light::LightSampleContext;
use softbox::math::Normalization;
use softbox::scene::{Instancing, PrepareSettings, PreparedScene, Scene, initial_camera, prepare};
use softbox::settings::CameraRule;

use super::Random;
use super::mesh::{append, geodesic};

/// By how much rays leave a surface, in a scene of about unit size.
pub(crate) const OFFSET: f32 = 2e-5;

/// Subdivision of a sphere of a scene file: triangles are what all systems can do.
const SPHERE: u32 = 16;

/// Triangles, from where they are seen, and what lights them.
#[derive(Debug)]
pub(crate) struct Subject {
    /// Name in tables.
    pub(crate) name: String,
    /// Triangles only.
    pub(crate) shapes: Shapes,
    /// The camera, in the space that `normalization` leads from.
    pub(crate) camera: Camera,
    /// From the camera's space to that of the shapes.
    pub(crate) normalization: Normalization,
    /// Distance along the normal at which rays leave a surface.
    pub(crate) offset: f32,
    /// Where shadow rays go.
    pub(crate) lamp: Lamp,
}

/// Where shadow rays go.
#[derive(Debug)]
pub(crate) enum Lamp {
    /// Points of a parallelogram: a corner and two edges.
    Quad([Vec3; 3]),
    /// The lights of a scene, as a render chooses them.
    Scene(Box<PreparedScene>),
}

impl Lamp {
    /// Unit direction and distance (may be infinite) of a random point of the lamp seen from a
    /// surface of the given point and normal; `None` where it does not shine.
    pub(crate) fn sample(
        &self,
        (from, normal): (Vec3, Vec3),
        random: &mut Random,
    ) -> Option<(Vec3, f32)> {
        let [choice, part, u, v] = [0; 4].map(|_| random.unit());
        match self {
            Self::Quad([corner, edge_u, edge_v]) => {
                let segment = *corner + *edge_u * u + *edge_v * v - from;
                Some((segment.normalize(), segment.length()))
            }
            Self::Scene(scene) => {
                let chosen = scene.light_sampler().sample(from, normal, choice)?;
                let numbers = (part, Vec2::new(u, v));
                let sample = scene.light(chosen.light).sample_part(
                    scene.shapes(),
                    chosen.part as usize,
                    &LightSampleContext {
                        point: from,
                        normal,
                    },
                    numbers,
                )?;
                Some((sample.wi, sample.distance))
            }
        }
    }
}

impl Subject {
    /// A generated scene; `degrees` is the vertical opening angle of a picture of 4:3.
    pub(crate) fn generated(
        name: &str,
        shapes: Shapes,
        (eye, target, degrees): (Vec3, Vec3, f64),
        lamp: [Vec3; 3],
        offset: f32,
    ) -> Self {
        let half_width = (degrees.to_radians() * 0.5).tan() * 4.0 / 3.0;
        Self {
            name: name.to_owned(),
            shapes,
            camera: Camera {
                eye: eye.as_dvec3(),
                target: target.as_dvec3(),
                up: DVec3::Y,
                framing: Framing::Horizontal(2.0 * half_width.atan()),
                ..Camera::default()
            },
            normalization: Normalization::IDENTITY,
            offset,
            lamp: Lamp::Quad(lamp),
        }
    }

    /// A scene as the program shows it at first, its spheres as triangles.
    ///
    /// # Errors
    /// When nothing is in it.
    pub(crate) fn of_scene(mut scene: Scene) -> anyhow::Result<Self> {
        scene.light_if_dark();
        let camera = Camera {
            lens_radius: 0.0,
            ..initial_camera(&scene, CameraRule::Auto, false)
        };
        // Other systems get every triangle.
        let settings = PrepareSettings {
            instancing: Instancing::Never,
            ..PrepareSettings::default()
        };
        let prepared = prepare(&scene, &settings, &|_, _| ControlFlow::Continue(()))
            .ok_or_else(|| anyhow!("Preparing the scene broke off."))?;
        let Shapes {
            positions,
            triangles,
            spheres,
        } = prepared.shapes().clone();
        let mut shapes = Shapes {
            positions,
            triangles,
            spheres: Vec::new(),
        };
        let ball = geodesic(SPHERE, |_| 1.0);
        for sphere in spheres {
            append(&mut shapes, &ball, sphere.radius, sphere.center);
        }
        if shapes.is_empty() {
            return Err(anyhow!("{}: nothing to trace", scene.name));
        }
        Ok(Self {
            name: scene.name.clone(),
            shapes,
            camera,
            normalization: *prepared.normalization(),
            offset: OFFSET,
            lamp: Lamp::Scene(Box::new(prepared)),
        })
    }
}
