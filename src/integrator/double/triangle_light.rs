//! A triangle that emits, seen from a point, in double precision.

use std::f64::consts::PI;

use glam::{DVec2, DVec3, Vec3};

use super::bilinear::{bilinear_density, bilinear_place, cosine, usable};
use super::warp;
use crate::light::NEAR;

/// What fills less, in steradians, sends nothing that counts: points all but in the plane of the light.
/// Angles say nothing about it.
const LEAST_AREA: f64 = 1e-10;

/// A triangle.
pub(super) struct Triangle {
    corners: [DVec3; 3],
    pub(super) normal: DVec3,
}

/// The triangle on the sphere about the point that is lit.
struct Spherical {
    /// The apex and the ends of the side across from it, unit.
    apex: DVec3,
    base: [DVec3; 2],
    weights: [f64; 4],
    area: f64,
}

impl Triangle {
    pub(super) fn new(corners: [Vec3; 3]) -> Self {
        let corners = corners.map(|p| p.as_dvec3());
        let [a, b, c] = corners;
        Self {
            corners,
            normal: (b - a).cross(c - a).normalize(),
        }
    }

    /// Even by area.
    pub(super) fn at(&self, u: DVec2) -> DVec3 {
        let [a, b, c] = self.corners;
        let (b1, b2) = warp::triangle(u);
        a + b1 * (b - a) + b2 * (c - a)
    }

    fn is_near(&self, from: DVec3) -> bool {
        let [a, b, c] = self.corners;
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        from.distance((a + b + c) / 3.0) < f64::from(NEAR) * longest
    }

    /// A point for `u`, of use from `from` on the side of `facing`.
    pub(super) fn sample(&self, from: DVec3, facing: DVec3, u: DVec2) -> Option<DVec3> {
        if !self.is_near(from) {
            return Some(self.at(u));
        }
        let wi = self.seen(from, facing)?.sample(u);
        let distance = self.normal.dot(self.corners[0] - from) / self.normal.dot(wi);
        Some(from + distance * wi)
    }

    /// The density of [`Self::sample`] per steradian.
    pub(super) fn pdf(&self, from: DVec3, facing: DVec3, point: DVec3) -> f64 {
        let to_light = point - from;
        if self.is_near(from) {
            let seen = self.seen(from, facing);
            return seen.map_or(0.0, |seen| seen.pdf(to_light.normalize()));
        }
        let [a, b, c] = self.corners;
        let area = 0.5 * (b - a).cross(c - a).length();
        let cos = self.normal.dot(to_light.normalize()).abs();
        to_light.length_squared() / (area * cos)
    }

    fn seen(&self, from: DVec3, facing: DVec3) -> Option<Spherical> {
        let directions = self.corners.map(|p| (p - from).normalize());
        let cosines = directions.map(|wi| cosine(facing, wi));
        let first = (1..3).fold(
            0,
            |best, i| if cosines[i] > cosines[best] { i } else { best },
        );
        let [a, b, c] = [0, 1, 2].map(|i| (first + i) % 3);
        let (apex, base) = (directions[a], [directions[b], directions[c]]);
        let area = spherical_area([apex, base[0], base[1]]);
        let weights = usable([cosines[a], cosines[b], cosines[a], cosines[c]])?;
        (area > LEAST_AREA).then_some(Spherical {
            apex,
            base,
            weights,
            area,
        })
    }
}

impl Spherical {
    /// Arvo 1995, "Stratified Sampling of Spherical Triangles", the area warped.
    fn sample(&self, u: DVec2) -> DVec3 {
        let place = bilinear_place(self.weights, u);
        let tangent = (0.125 * self.area).tan() * (2.0 * place.y - 1.0);
        let area = 0.5 * self.area + 4.0 * tangent.atan();
        let [start, end] = self.base;
        let angle = angle_at(start, self.apex, end);
        let (sin, cos) = (area - angle).sin_cos();
        let (p, q) = (cos - angle.cos(), sin + angle.sin() * start.dot(self.apex));
        let top = (q * cos - p * sin) * angle.cos() - q;
        let cos_base = (top / ((q * sin + p * cos) * angle.sin())).clamp(-1.0, 1.0);
        let on_base = turned(start, end, cos_base);
        let cos = 1.0 - place.x * (1.0 - on_base.dot(self.apex));
        turned(self.apex, on_base, cos)
    }

    fn pdf(&self, wi: DVec3) -> f64 {
        let [start, end] = self.base;
        let across = self.apex.cross(wi).cross(start.cross(end)).normalize();
        let on_base = across * across.dot(start + end).signum();
        let cut = spherical_area([self.apex, start, on_base]);
        let quarter = (0.125 * self.area).tan();
        let tangent = (0.25 * cut - 0.125 * self.area).tan();
        let x = (1.0 - wi.dot(self.apex)) / (1.0 - on_base.dot(self.apex));
        let place = DVec2::new(x, 0.5 + 0.5 * tangent / quarter);
        let even = (1.0 + tangent * tangent) / (8.0 * quarter);
        even * bilinear_density(self.weights, place)
    }
}

/// The angle of the spherical triangle at `corner`.
fn angle_at(corner: DVec3, a: DVec3, b: DVec3) -> f64 {
    let [a, b] = [a, b].map(|p| p.reject_from_normalized(corner));
    a.cross(b).length().atan2(a.dot(b))
}

/// Girard's theorem: what the angles add to beyond π.
fn spherical_area([a, b, c]: [DVec3; 3]) -> f64 {
    angle_at(a, b, c) + angle_at(b, c, a) + angle_at(c, a, b) - PI
}

/// The direction at the cosine `cos` from `from` on the way to `to`.
fn turned(from: DVec3, to: DVec3, cos: f64) -> DVec3 {
    let aside = to.reject_from_normalized(from).normalize_or_zero();
    cos * from + ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt() * aside
}
