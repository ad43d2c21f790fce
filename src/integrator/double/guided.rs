//! Rays aimed at mirrors and glass through which lights are seen, in double precision.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::bsdf::{self, Scattered};
use super::frame::Frame;
use super::path::Vertex;
use super::warp;
use crate::guide::{LobeSphere, Lobes};
use crate::integrator::PathTracer;

/// Where the vertex aims some of its rays, as the table of the guide has it.
pub(super) fn lobes_at<'a>(
    tracer: &PathTracer<'a>,
    bounce: u32,
    vertex: &Vertex<'_>,
) -> Option<&'a Lobes> {
    let place = (
        vertex.surface.point.as_vec3(),
        vertex.lit_normal().as_vec3(),
    );
    tracer.lobes_at(bounce, vertex.bsdf, place)
}

/// The direction that the numbers stand for; `None` below the surface.
pub(super) fn sample(
    lobes: &Lobes,
    vertex: &Vertex<'_>,
    u_lobe: f64,
    u: DVec2,
) -> Option<Scattered> {
    let share = f64::from(lobes.share());
    let wi = if u_lobe < share {
        vertex
            .frame
            .to_local(aimed(lobes, vertex.surface.point, u_lobe / share, u))
    } else {
        match bsdf::sample(vertex.bsdf, vertex.wo, u_lobe, u)? {
            Scattered::Smooth { wi, .. } | Scattered::Delta { wi, .. } => wi,
        }
    };
    let (value, pdf) = bsdf::eval_and_pdf(vertex.bsdf, vertex.wo, wi);
    (pdf > 0.0).then(|| Scattered::Smooth {
        wi,
        value,
        pdf: mixture(lobes, vertex, pdf, vertex.frame.to_world(wi)),
    })
}

/// The density of all scattered rays in the unit direction `wi`, `material` being that of the rays that
/// are not aimed.
pub(super) fn mixture(lobes: &Lobes, vertex: &Vertex<'_>, material: f64, wi: DVec3) -> f64 {
    let share = f64::from(lobes.share());
    let densities = lobes.spheres().map(|sphere| {
        let to = sphere.center.as_dvec3() - vertex.surface.point;
        let is_inside =
            to.dot(wi) > 0.0 && to.cross(wi).length_squared() <= f64::from(sphere.radius2);
        if is_inside {
            f64::from(sphere.weight) / (TAU * height(to, &sphere))
        } else {
            0.0
        }
    });
    (1.0 - share) * material + share * densities.sum::<f64>()
}

/// A direction through the lobe that `u_lobe` picks, evenly over its cone.
fn aimed(lobes: &Lobes, from: DVec3, u_lobe: f64, u: DVec2) -> DVec3 {
    let mut end = 0.0;
    let picked = lobes.spheres().find(|sphere| {
        end += f64::from(sphere.weight);
        u_lobe < end
    });
    let Some(sphere) = picked.or_else(|| lobes.spheres().last()) else {
        return DVec3::Z;
    };
    let to = sphere.center.as_dvec3() - from;
    let height = height(to, &sphere);
    let disk = warp::disk(u);
    let z = 1.0 - disk.length_squared() * height;
    let side = disk.normalize_or_zero() * (1.0 - z * z).max(0.0).sqrt();
    Frame::from_normal(to.normalize()).to_world(side.extend(z))
}

/// 1 − cos of the half angle under which the sphere is seen; from inside that of a right angle.
fn height(to: DVec3, sphere: &LobeSphere) -> f64 {
    let sin2 = (f64::from(sphere.radius2) / to.length_squared()).min(1.0);
    sin2 / (1.0 + (1.0 - sin2).sqrt())
}
