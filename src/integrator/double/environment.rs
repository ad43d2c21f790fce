//! Light from infinity, in double precision.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::light::LightSample;
use super::warp;
use crate::light::{EnvironmentLight, EnvironmentPart};

/// Radiance along a ray in the unit `direction` that leaves the scene; camera rays do not see the
/// ambient part.
pub(super) fn radiance(light: &EnvironmentLight, direction: DVec3, is_camera_ray: bool) -> DVec3 {
    let mut radiance = light.sky().as_dvec3();
    if direction.y > 0.0 && !is_camera_ray {
        radiance += light.ambient().as_dvec3();
    }
    if let Some(image) = light.map() {
        let phi = (-direction.z).atan2(direction.x) + PI;
        let theta = direction.y.clamp(-1.0, 1.0).acos();
        let column = (phi / TAU * image.width() as f64) as usize;
        let row = (theta / PI * image.height() as f64) as usize;
        let texel = image.get(column.min(image.width() - 1), row.min(image.height() - 1));
        radiance += texel.as_dvec3();
    }
    radiance
}

/// The density of [`sample`]. Every part is chosen by its flux and sampled by its luminance, so the
/// mixture is the luminance of all over the flux of all.
pub(super) fn pdf(light: &EnvironmentLight, direction: DVec3) -> f64 {
    let weights = DVec3::new(0.2126, 0.7152, 0.0722);
    radiance(light, direction, false).dot(weights) / f64::from(light.flux())
}

/// The direction that the numbers stand for; the tables choose part and texel.
pub(super) fn sample(
    light: &EnvironmentLight,
    u_choice: f32,
    u: glam::Vec2,
) -> Option<LightSample> {
    let wi = match light.choose(u_choice, u)? {
        EnvironmentPart::Sky => warp::sphere(u.as_dvec2()),
        EnvironmentPart::Ambient => {
            let up = warp::hemisphere(u.as_dvec2());
            DVec3::new(up.y, up.z, up.x)
        }
        EnvironmentPart::Map(place) => map_direction(place.as_dvec2(), light.map()?.height()),
    };
    let pdf = pdf(light, wi);
    (pdf > 0.0).then(|| LightSample {
        wi,
        radiance: radiance(light, wi, false),
        pdf,
        is_delta: false,
        end: None,
    })
}

/// Even in the cosine inside each row, so that solid angle is even inside each texel.
fn map_direction(place: DVec2, height: usize) -> DVec3 {
    let row = (place.y * height as f64).floor();
    let edge = |row: f64| (PI * row / height as f64).cos();
    let (top, bottom) = (edge(row), edge(row + 1.0));
    let cos = top + (bottom - top) * (place.y * height as f64 - row);
    let around = warp::at_cosine(cos, place.x);
    DVec3::new(-around.x, around.z, around.y)
}
