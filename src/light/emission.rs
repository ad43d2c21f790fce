use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::Light;
use crate::color::luminance;
use crate::geometry::Shapes;
use crate::sampling::uniform_sphere;

/// A point from which a light shines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmissionPoint {
    /// The point.
    pub point: Vec3,
    /// Unit normal of the front.
    pub normal: Vec3,
    /// Luminance of the radiance, times the area of one side of the light.
    pub luminance_area: f32,
    /// True when the back shines too.
    pub two_sided: bool,
}

impl Light {
    /// A point evenly spread over the area of the light: `u_part` picks a part, `u` the place, all in
    /// [0, 1). `None` for a light without extent and for the environment.
    pub fn emission_point(&self, shapes: &Shapes, u_part: f32, u: Vec2) -> Option<EmissionPoint> {
        match self {
            Self::Area(area) => {
                let (point, normal) = area.even_point(u_part, u)?;
                Some(EmissionPoint {
                    point,
                    normal,
                    luminance_area: luminance(area.radiance()) * area.area(),
                    two_sided: area.is_two_sided(),
                })
            }
            Self::Sphere(light) => {
                let sphere = shapes.sphere(light.primitive)?;
                let normal = uniform_sphere(u);
                let area = 4.0 * PI * sphere.radius * sphere.radius;
                Some(EmissionPoint {
                    point: sphere.center + sphere.radius * normal,
                    normal,
                    luminance_area: luminance(light.radiance) * area,
                    two_sided: light.two_sided,
                })
            }
            Self::Point(_) | Self::Spot(_) | Self::Directional(_) | Self::Environment(_) => None,
        }
    }
}
