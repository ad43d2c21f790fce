//! Flat lights seen from a point, in double precision.

use glam::{DVec2, DVec3, Vec2, Vec3};

use super::bilinear::{bilinear_density, bilinear_place, cosine, usable};
use super::light::LightSample;
use super::triangle_light::Triangle;
use crate::light::{AreaDensity, AreaLight, AreaPart, LEVEL, NEAR};

/// A point of part `index` of the light, whose directions count by their cosine to `normal`.
pub(super) fn sample(
    area: &AreaLight,
    index: usize,
    (from, normal): (DVec3, DVec3),
    u: Vec2,
) -> Option<LightSample> {
    let u = u.as_dvec2();
    let part = Flat::new(area.part(index));
    let point = match area.density() {
        AreaDensity::Correct => part.sample(from, normal, u)?,
        AreaDensity::Course => part.at(u),
    };
    let front = part.front();
    let pdf = pdf(area, index, (from, normal), (point, front));
    (pdf > 0.0).then(|| LightSample {
        wi: (point - from).normalize(),
        radiance: area.radiance().as_dvec3(),
        pdf,
        is_delta: false,
        end: Some((point, front)),
    })
}

/// The density of [`sample`] for the direction of the point and normal `end` on the part.
pub(super) fn pdf(
    area: &AreaLight,
    index: usize,
    (from, facing): (DVec3, DVec3),
    (point, front): (DVec3, DVec3),
) -> f64 {
    let to_light = point - from;
    let cos_wi = front.dot(to_light.normalize());
    let cos = if area.is_two_sided() {
        cos_wi.abs()
    } else {
        -cos_wi
    };
    if cos <= 0.0 {
        return 0.0;
    }
    match area.density() {
        AreaDensity::Correct => Flat::new(area.part(index)).pdf(from, facing, point),
        AreaDensity::Course => to_light.length() / (f64::from(area.part_area(index)) * cos),
    }
}

/// A part of a light.
enum Flat {
    Triangle(Triangle),
    Quad(Quad),
}

impl Flat {
    fn new(part: AreaPart) -> Self {
        match part {
            AreaPart::Triangle(corners) => Self::Triangle(Triangle::new(corners)),
            AreaPart::Parallelogram {
                corner,
                edge_1,
                edge_2,
            } => Self::Quad(Quad::new([corner, edge_1, edge_2])),
        }
    }

    fn front(&self) -> DVec3 {
        match self {
            Self::Triangle(triangle) => triangle.normal,
            Self::Quad(quad) => quad.normal,
        }
    }

    /// Even by area.
    fn at(&self, u: DVec2) -> DVec3 {
        match self {
            Self::Triangle(triangle) => triangle.at(u),
            Self::Quad(quad) => quad.at(u),
        }
    }

    fn sample(&self, from: DVec3, facing: DVec3, u: DVec2) -> Option<DVec3> {
        match self {
            Self::Triangle(triangle) => triangle.sample(from, facing, u),
            Self::Quad(quad) => quad.sample(from, facing, u),
        }
    }

    fn pdf(&self, from: DVec3, facing: DVec3, point: DVec3) -> f64 {
        match self {
            Self::Triangle(triangle) => triangle.pdf(from, facing, point),
            Self::Quad(quad) => quad.pdf(from, facing, point),
        }
    }
}

/// A parallelogram.
struct Quad {
    corner: DVec3,
    edge_1: DVec3,
    edge_2: DVec3,
    normal: DVec3,
}

impl Quad {
    fn new(vectors: [Vec3; 3]) -> Self {
        let [corner, edge_1, edge_2] = vectors.map(|v| v.as_dvec3());
        Self {
            corner,
            edge_1,
            edge_2,
            normal: edge_1.cross(edge_2).normalize(),
        }
    }

    fn at(&self, place: DVec2) -> DVec3 {
        self.corner + place.x * self.edge_1 + place.y * self.edge_2
    }

    /// Coordinates by Cramer's rule.
    fn place_of(&self, point: DVec3) -> DVec2 {
        let p = point - self.corner;
        let whole = self.edge_1.cross(self.edge_2);
        let share = |part: DVec3| part.dot(whole) / whole.length_squared();
        DVec2::new(share(p.cross(self.edge_2)), share(self.edge_1.cross(p)))
    }

    fn is_near(&self, from: DVec3) -> bool {
        let foot = self.place_of(from).clamp(DVec2::ZERO, DVec2::ONE);
        let longer = self.edge_1.length().max(self.edge_2.length());
        from.distance(self.at(foot)) < f64::from(NEAR) * longer
    }

    fn sample(&self, from: DVec3, facing: DVec3, u: DVec2) -> Option<DVec3> {
        if self.is_near(from) {
            let near = Near::new(self, from);
            let place = bilinear_place(near.weights(facing)?, u);
            Some(near.at(place))
        } else {
            Some(self.at(bilinear_place(self.weights(from, facing)?, u)))
        }
    }

    fn pdf(&self, from: DVec3, facing: DVec3, point: DVec3) -> f64 {
        if self.is_near(from) {
            let near = Near::new(self, from);
            let (place, pdf) = near.place_of(point);
            near.weights(facing)
                .map_or(0.0, |weights| pdf * bilinear_density(weights, place))
        } else {
            let to_light = point - from;
            let cos = self.normal.dot(to_light.normalize()).abs();
            let area = self.edge_1.cross(self.edge_2).length();
            self.weights(from, facing).map_or(0.0, |weights| {
                let density = bilinear_density(weights, self.place_of(point)) / area;
                density * to_light.length_squared() / cos
            })
        }
    }

    /// What the corners send: both cosines over the squared distance.
    fn weights(&self, from: DVec3, facing: DVec3) -> Option<[f64; 4]> {
        usable(corner_places().map(|place| {
            let to_corner = self.at(place) - from;
            let wi = to_corner.normalize();
            let cos = self.normal.dot(wi).abs();
            cosine(facing, wi) * cos / to_corner.length_squared()
        }))
    }
}

/// Cylinder coordinates about an axis through `from` along an edge.
struct Near<'a> {
    quad: &'a Quad,
    from: DVec3,
    /// The edge along the axis, and the other.
    edges: [DVec3; 2],
    axis: DVec3,
    across: DVec3,
    /// Towards the plane of the light, with the distance to it.
    down: DVec3,
    /// Angles of the first and the last row from `down` to `across`.
    angles: [f64; 2],
}

impl<'a> Near<'a> {
    fn new(quad: &'a Quad, from: DVec3) -> Self {
        let place = quad.place_of(from);
        let beyond = (place - place.clamp(DVec2::ZERO, DVec2::ONE)).abs();
        let [first, second] = [quad.edge_1, quad.edge_2];
        let edges = if (beyond.x - f64::from(LEVEL)) * first.length() > beyond.y * second.length() {
            [second, first]
        } else {
            [first, second]
        };
        let axis = edges[0].normalize();
        let across = edges[1].reject_from_normalized(axis).normalize();
        let down = quad.normal * quad.normal.dot(quad.corner - from);
        let angle = |p: DVec3| (p - from).dot(across).atan2(down.length());
        Self {
            quad,
            from,
            edges,
            axis,
            across,
            down,
            angles: [angle(quad.corner), angle(quad.corner + edges[1])],
        }
    }

    /// Row lengths in sines times cosines at the surface.
    fn weights(&self, facing: DVec3) -> Option<[f64; 4]> {
        usable(corner_places().map(|place| {
            let [first, last] = self.row(place.y).1;
            let corner = self.quad.corner + place.x * self.edges[0] + place.y * self.edges[1];
            cosine(facing, (corner - self.from).normalize()) * (last - first)
        }))
    }

    /// Middle of the angles, tangent of a quarter of what lies between them.
    fn fan(&self) -> (f64, f64) {
        let [first, last] = self.angles;
        (0.5 * (first + last), (0.25 * (last - first)).tan())
    }

    /// Distance to the axis and sines at both ends of the row at `share` of the other edge.
    fn row(&self, share: f64) -> (f64, [f64; 2]) {
        let first = self.quad.corner + share * self.edges[1] - self.from;
        let y = first.dot(self.axis);
        let radius = (first - y * self.axis).length();
        let sine = |y: f64| y / radius.hypot(y);
        (radius, [sine(y), sine(y + self.edges[0].length())])
    }

    fn at(&self, place: DVec2) -> DVec3 {
        let (middle, quarter) = self.fan();
        let angle = middle + 2.0 * (quarter * (2.0 * place.y - 1.0)).atan();
        let x = self.down.length() * angle.tan();
        let share = self.share_of(x);
        let (radius, [first, last]) = self.row(share);
        let sine = first + place.x * (last - first);
        let y = radius * sine / ((1.0 - sine) * (1.0 + sine)).sqrt();
        self.from + self.down + x * self.across + y * self.axis
    }

    /// The share of the other edge at `x` along `across`.
    fn share_of(&self, x: f64) -> f64 {
        let start = (self.quad.corner - self.from).dot(self.across);
        ((x - start) / self.edges[1].dot(self.across)).clamp(0.0, 1.0)
    }

    /// The inverse of [`Self::at`], and the density of `at` for even places.
    fn place_of(&self, point: DVec3) -> (DVec2, f64) {
        let (middle, quarter) = self.fan();
        let p = point - self.from;
        let x = p.dot(self.across);
        let tangent = (0.5 * (x.atan2(self.down.length()) - middle)).tan();
        let (radius, [first, last]) = self.row(self.share_of(x));
        let y = p.dot(self.axis);
        let along = (y / radius.hypot(y) - first) / (last - first);
        let place = DVec2::new(along, 0.5 + 0.5 * tangent / quarter);
        let rate = (1.0 + tangent * tangent) / (4.0 * quarter);
        (place, rate / (last - first))
    }
}

fn corner_places() -> [DVec2; 4] {
    [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(DVec2::from)
}
