use std::fmt;

use clap::ValueEnum;
use glam::{Vec2, Vec3};
use serde::Serialize;
use softbox::camera::RayCamera;
use softbox::geometry::Hit;
use softbox::math::{Frame, Ray};
use softbox::sampling::cosine_hemisphere;

use super::{Exact, Random, Subject};

/// Primary rays come in tiles of this many pixels squared, as a renderer walks a picture.
const TILE: u32 = 8;

/// Shadow rays end at this part of the way to the lamp.
const SHADOW_END: f32 = 0.999;

/// A set of rays of one subject.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Kind {
    /// Camera rays, for their closest hits
    Primary,
    /// Diffuse rays from where primary rays hit, for their closest hits
    Bounce1,
    /// Diffuse rays from where those hit
    Bounce2,
    /// From where primary rays hit to the lamp, for any hit
    Shadow0,
    /// From where the first bounce hits to the lamp, for any hit
    Shadow1,
}

impl Kind {
    /// Whether any hit will do.
    pub(crate) fn is_shadow(self) -> bool {
        matches!(self, Self::Shadow0 | Self::Shadow1)
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Primary => "primary",
            Self::Bounce1 => "bounce1",
            Self::Bounce2 => "bounce2",
            Self::Shadow0 => "shadow0",
            Self::Shadow1 => "shadow1",
        })
    }
}

/// Rays and their true hits.
#[derive(Debug)]
pub(crate) struct RaySet {
    pub(crate) kind: Kind,
    pub(crate) rays: Vec<Ray>,
    pub(crate) expected: Vec<Hit>,
}

/// The wanted sets, for a picture of `size` pixels. They come from double precision, not from a system
/// that is measured.
pub(crate) fn ray_sets(
    subject: &Subject,
    exact: &Exact<'_>,
    size: (u32, u32),
    wanted: &[Kind],
) -> Vec<RaySet> {
    let make = |kind, rays: Vec<Ray>| RaySet {
        kind,
        expected: exact.closest_hits(&rays),
        rays,
    };
    let is_wanted = |kind| wanted.contains(&kind);
    let primary = make(Kind::Primary, primary(subject, size));
    let mut sets = Vec::new();
    if is_wanted(Kind::Shadow0) {
        sets.push(make(Kind::Shadow0, shadow(subject, &primary, 4)));
    }
    if [Kind::Bounce1, Kind::Bounce2, Kind::Shadow1]
        .into_iter()
        .any(is_wanted)
    {
        let bounce1 = make(Kind::Bounce1, bounce(subject, &primary, 2));
        if is_wanted(Kind::Bounce2) {
            sets.push(make(Kind::Bounce2, bounce(subject, &bounce1, 3)));
        }
        if is_wanted(Kind::Shadow1) {
            sets.push(make(Kind::Shadow1, shadow(subject, &bounce1, 5)));
        }
        sets.push(bounce1);
    }
    sets.push(primary);
    sets.retain(|set| is_wanted(set.kind) && !set.rays.is_empty());
    sets.sort_by_key(|set| set.kind);
    sets
}

fn primary(subject: &Subject, (width, height): (u32, u32)) -> Vec<Ray> {
    let camera = RayCamera::new(&subject.camera, width, height, &subject.normalization);
    let mut random = Random::new(1);
    let tiles = (0..height.div_ceil(TILE))
        .flat_map(|y| (0..width.div_ceil(TILE)).map(move |x| (x * TILE, y * TILE)));
    let pixels =
        tiles.flat_map(|(x, y)| (0..TILE * TILE).map(move |i| (x + i % TILE, y + i / TILE)));
    pixels
        .filter(|(x, y)| *x < width && *y < height)
        .map(|(x, y)| {
            let inside = Vec2::new(random.unit(), random.unit());
            camera.generate_ray(Vec2::new(x as f32, y as f32) + inside, || Vec2::ZERO)
        })
        .collect()
}

/// Where the rays hit: a point just above the surface, and the normal on that side.
fn places<'a>(subject: &'a Subject, set: &'a RaySet) -> impl Iterator<Item = (Vec3, Vec3)> + 'a {
    let hits = set
        .rays
        .iter()
        .zip(&set.expected)
        .filter(|(_, hit)| !hit.is_miss());
    hits.map(|(ray, hit)| {
        let [a, b, c] = subject.shapes.vertices(hit.primitive as usize);
        let normal = (b - a).as_dvec3().cross((c - a).as_dvec3());
        let normal = normal.normalize().as_vec3();
        let normal = if normal.dot(ray.direction) > 0.0 {
            -normal
        } else {
            normal
        };
        (ray.at(hit.t) + normal * subject.offset, normal)
    })
}

fn bounce(subject: &Subject, set: &RaySet, seed: u64) -> Vec<Ray> {
    let mut random = Random::new(seed);
    places(subject, set)
        .map(|(point, normal)| {
            let local = cosine_hemisphere(Vec2::new(random.unit(), random.unit()));
            Ray::new(point, Frame::from_normal(normal).to_world(local))
        })
        .collect()
}

fn shadow(subject: &Subject, set: &RaySet, seed: u64) -> Vec<Ray> {
    let mut random = Random::new(seed);
    places(subject, set)
        .filter_map(|place @ (point, _)| {
            let (direction, distance) = subject.lamp.sample(place, &mut random)?;
            Some(Ray::segment(point, direction, distance * SHADOW_END))
        })
        .collect()
}
