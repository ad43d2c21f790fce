//! Lights seen from a point, in double precision.

use glam::{DVec3, Vec2};

use super::surface::Surface;
use super::{area_light, environment, sphere_light};
use crate::geometry::Shapes;
use crate::light::{Light, PointFalloff, SpotLight};

/// A direction in which a light is seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightSample {
    /// Unit vector towards the light.
    pub(super) wi: DVec3,
    /// Radiance from there; for delta lights irradiance.
    pub(super) radiance: DVec3,
    /// Density per steradian; 1 for delta lights.
    pub(super) pdf: f64,
    pub(super) is_delta: bool,
    /// Point and unit normal (or zero) of the light; `None` at infinity.
    pub(super) end: Option<(DVec3, DVec3)>,
}

/// A direction from `from` to `light`, of use on the side of `normal`; `None` where it sends nothing
/// there.
pub(super) fn sample(
    light: &Light,
    shapes: &Shapes,
    (from, normal): (DVec3, DVec3),
    u_choice: f32,
    u: Vec2,
) -> Option<LightSample> {
    match light {
        Light::Area(area) => {
            let part = area.choose_part(u_choice)?;
            let sample = area_light::sample(area, part, (from, normal), u)?;
            // By area over all parts.
            let share = f64::from(area.part_area(part)) / f64::from(area.area());
            Some(LightSample {
                pdf: share * sample.pdf,
                ..sample
            })
        }
        Light::Sphere(sphere) => {
            let shape = shapes.sphere(sphere.primitive)?;
            sphere_light::sample(sphere, shape, from, u.as_dvec2())
        }
        Light::Point(point) => {
            let intensity = point.intensity.as_dvec3();
            sample_point(
                from,
                point.position.as_dvec3(),
                |_, distance2| match point.falloff {
                    PointFalloff::Correct => intensity / distance2,
                    PointFalloff::Course => intensity,
                },
            )
        }
        Light::Spot(spot) => sample_point(from, spot.position.as_dvec3(), |wi, distance2| {
            intensity(spot, -wi) / distance2
        }),
        Light::Directional(directional) => Some(LightSample {
            wi: directional.to_light.as_dvec3().normalize(),
            radiance: directional.irradiance.as_dvec3(),
            pdf: 1.0,
            is_delta: true,
            end: None,
        }),
        Light::Environment(environment) => environment::sample(environment, u_choice, u),
    }
}

/// As [`sample`], from part `part` of `light`, with the numbers (inside the light, place).
pub(super) fn sample_part(
    light: &Light,
    shapes: &Shapes,
    part: usize,
    place: (DVec3, DVec3),
    (u_choice, u): (f32, Vec2),
) -> Option<LightSample> {
    match light {
        Light::Area(area) => area_light::sample(area, part, place, u),
        _ => sample(light, shapes, place, u_choice, u),
    }
}

/// The density of [`sample_part`] for the direction from `from`, lit on the side of `normal`, in
/// which it meets `surface`, which is on the part, on a side that emits.
pub(super) fn pdf_part(
    light: &Light,
    shapes: &Shapes,
    part: usize,
    (from, normal): (DVec3, DVec3),
    surface: &Surface,
) -> f64 {
    match light {
        Light::Area(area) => {
            let end = (surface.point, surface.geometric_normal);
            area_light::pdf(area, part, (from, normal), end)
        }
        Light::Sphere(sphere) => shapes
            .sphere(sphere.primitive)
            .map_or(0.0, |shape| sphere_light::pdf(sphere, shape, from)),
        Light::Point(_) | Light::Spot(_) | Light::Directional(_) | Light::Environment(_) => 0.0,
    }
}

/// Radiance that the surface of `light` sends against the direction `wi`.
pub(super) fn emitted(light: &Light, normal: DVec3, wi: DVec3) -> DVec3 {
    let (radiance, two_sided) = match light {
        Light::Area(area) => (area.radiance(), area.is_two_sided()),
        Light::Sphere(sphere) => (sphere.radiance, sphere.two_sided),
        Light::Point(_) | Light::Spot(_) | Light::Directional(_) | Light::Environment(_) => {
            return DVec3::ZERO;
        }
    };
    if two_sided || normal.dot(wi) < 0.0 {
        radiance.as_dvec3()
    } else {
        DVec3::ZERO
    }
}

/// `irradiance` depends on the direction to the light and its squared distance.
fn sample_point(
    from: DVec3,
    position: DVec3,
    irradiance: impl Fn(DVec3, f64) -> DVec3,
) -> Option<LightSample> {
    let to_light = position - from;
    let wi = to_light.try_normalize()?;
    Some(LightSample {
        wi,
        radiance: irradiance(wi, to_light.length_squared()),
        pdf: 1.0,
        is_delta: true,
        end: Some((position, DVec3::ZERO)),
    })
}

fn intensity(spot: &SpotLight, direction: DVec3) -> DVec3 {
    let cos = spot.axis.as_dvec3().normalize().dot(direction);
    if cos > 0.0 && cos >= f64::from(spot.cos_half_angle) {
        spot.intensity.as_dvec3() * cos.powf(f64::from(spot.exponent))
    } else {
        DVec3::ZERO
    }
}
