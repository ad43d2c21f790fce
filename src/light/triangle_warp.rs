use glam::{DVec2, DVec3, Vec2, Vec3};

use super::LightSampleContext;
use super::triangle::Triangle;
use crate::sampling::Bilinear;

/// Samples a triangle by solid angle, times a factor bilinear between the cosines at its corners.
///
/// One corner, the apex, stays; the arc between the others is shared out by the solid angle that it
/// cuts off with the apex, the arc from the apex to the place so found by its cosine (Arvo 1995,
/// "Stratified Sampling of Spherical Triangles"). The apex is the corner that faces the surface most: the
/// true cosine falls off from there no faster than the factor does. Solid angles are those of Van Oosterom
/// and Strackee 1983, "The Solid Angle of a Plane Triangle"; an angle γ between sides whose halves have
/// tangents p and q belongs to tan(Ω/2) = pq sin γ / (1 + pq cos γ). As in [`super::cylinder_warp`] an angle is
/// replaced by the tangent of half its distance from the middle, here Ω/2: that needs roots only and is
/// uneven by at most a factor of two. In double precision, so that needles, points near an edge and points
/// far away need no method of their own.
pub(super) struct TriangleWarp {
    from: DVec3,
    apex: Seen,
    /// Across from the apex.
    base: Side,
    /// The end of the base, from the point that is lit.
    end: DVec3,
    /// Six times that of the tetrahedron over the light: area and distance to the plane, twice.
    volume: f64,
    /// Ω/4 as the direction of (cos, sin), Ω being the solid angle of the light.
    middle: DVec2,
    /// Tangent of Ω/8.
    eighth: f64,
    density: Bilinear,
}

/// A point of the light as it is seen.
#[derive(Clone, Copy)]
struct Seen {
    /// From the point that is lit.
    segment: DVec3,
    distance: f64,
    /// Unit.
    direction: DVec3,
}

/// A straight line on the light, seen as an arc.
struct Side {
    start: Seen,
    /// From the start.
    edge: DVec3,
    /// The parts of the edge away from the point that is lit and at a right angle to that.
    outwards: f64,
    across: f64,
}

impl TriangleWarp {
    /// `None` in the plane of the light, at a corner, and where the light lies wholly below the horizon of
    /// `from`.
    pub(super) fn new(light: &Triangle, from: &LightSampleContext) -> Option<Self> {
        let point = from.point.as_dvec3();
        let corners = light.corners.map(|p| Seen::new(p.as_dvec3() - point));
        let cosines = corners.map(|corner| from.foreshortened(corner.direction.as_vec3(), 1.0));
        let most = cosines[0].max(cosines[1]).max(cosines[2]);
        let first = cosines.iter().position(|&cos| cos == most)?;
        let order = [first, (first + 1) % 3, (first + 2) % 3];
        let [at_apex, at_start, at_end] = order.map(|i| cosines[i]);
        let [apex, start, end] = order.map(|i| corners[i]);
        let edges = (start.segment - apex.segment).cross(end.segment - apex.segment);
        let volume = edges.dot(apex.segment).abs();
        let middle = half_of(half_solid_angle([&apex, &start, &end], volume));
        let eighth = half_tangent(middle);
        (eighth > 0.0).then_some(Self {
            from: point,
            apex,
            base: Side::new(&start, end.segment),
            end: end.segment,
            volume,
            middle,
            eighth,
            density: Bilinear::new([at_apex, at_start, at_apex, at_end])?,
        })
    }

    /// Point and density per steradian.
    pub(super) fn sample(&self, u: Vec2) -> (Vec3, f32) {
        let place = self.density.sample(u);
        let tangent = self.eighth * f64::from(2.0 * place.y - 1.0);
        let ray = Side::new(&self.apex, self.base.at(self.share_of(tangent)));
        let height = f64::from(place.x) * ray.one_minus_cos();
        let turn = DVec2::new(1.0 - height, (height * (2.0 - height)).sqrt());
        let point = self.from + ray.at(ray.share_at(turn));
        (point.as_vec3(), self.density_at(place, tangent))
    }

    /// Density per steradian at a point of the light.
    pub(super) fn pdf(&self, point: Vec3) -> f32 {
        let segment = point.as_dvec3() - self.from;
        let share = self.share_beside(segment);
        let end = self.base.at(share);
        let corners = [&self.apex, &self.base.start, &Seen::new(end)];
        let cut = half_solid_angle(corners, share * self.volume);
        let back = DVec2::new(self.middle.x, -self.middle.y);
        let tangent = half_tangent(cut.rotate(back)).clamp(-self.eighth, self.eighth);
        let [part, whole] = [segment, end].map(|p| Side::new(&self.apex, p));
        let along = (part.one_minus_cos() / whole.one_minus_cos()).clamp(0.0, 1.0);
        let place = DVec2::new(along, 0.5 + 0.5 * tangent / self.eighth);
        // Where a corner lies at the point itself this is no number.
        self.density_at(place.as_vec2(), tangent).max(0.0)
    }

    /// On the way through the light Ω/2 = Ω/4 + 2 atan t, so that dω = 4 dt / (1 + t²), and t goes through
    /// 2 · `eighth`.
    fn density_at(&self, place: Vec2, tangent: f64) -> f32 {
        let even = (1.0 + tangent * tangent) / (8.0 * self.eighth);
        self.density.pdf(place) * even as f32
    }

    /// The share of the base that cuts off the solid angle twice Ω/4 + 2 atan `tangent`.
    fn share_of(&self, tangent: f64) -> f64 {
        let square = tangent * tangent;
        let turn = DVec2::new(1.0 - square, 2.0 * tangent);
        let cut = self.middle.rotate(turn);
        let base = &self.base;
        let start = &base.start;
        let to_apex = self.apex.segment - start.segment;
        // p cos γ, p sin γ and 1, all three times the last factor.
        let cos = base.edge.dot(to_apex) - base.outwards * start.direction.dot(to_apex);
        let sin = self.volume / start.distance;
        let factor =
            base.across * self.apex.distance * (1.0 + start.direction.dot(self.apex.direction));
        let half = DVec2::new(cut.x * sin - cut.y * cos, cut.y * factor);
        base.share_at(half.rotate(half))
    }

    /// The share of the base at which the line from the apex through a point of the light meets it.
    fn share_beside(&self, segment: DVec3) -> f64 {
        let [start, end, p] =
            [self.base.start.segment, self.end, segment].map(|v| v - self.apex.segment);
        let normal = start.cross(end);
        let (at_start, at_end) = (p.cross(end).dot(normal), start.cross(p).dot(normal));
        let sum = at_start + at_end;
        if sum > 0.0 {
            (at_end / sum).clamp(0.0, 1.0)
        } else {
            0.5
        }
    }
}

impl Seen {
    fn new(segment: DVec3) -> Self {
        let distance = segment.length();
        Self {
            segment,
            distance,
            direction: segment * distance.recip(),
        }
    }
}

impl Side {
    fn new(start: &Seen, end: DVec3) -> Self {
        let edge = end - start.segment;
        Self {
            start: *start,
            edge,
            outwards: start.direction.dot(edge),
            across: start.direction.cross(edge).length(),
        }
    }

    fn at(&self, share: f64) -> DVec3 {
        self.start.segment + share * self.edge
    }

    /// The share after which it is seen at an angle to its start, given by the direction of (cos, sin).
    fn share_at(&self, angle: DVec2) -> f64 {
        let share =
            self.start.distance * angle.y / (self.across * angle.x - self.outwards * angle.y);
        share.clamp(0.0, 1.0)
    }

    /// 1 − cos of the angle of the whole, exact also where it is small.
    fn one_minus_cos(&self) -> f64 {
        // Distance of the end along the direction of the start, and from it.
        let along = self.start.distance + self.outwards;
        let distance2 = along * along + self.across * self.across;
        let distance = distance2.sqrt();
        if along < 0.0 {
            1.0 - along / distance
        } else {
            self.across * self.across / (distance2 + along * distance)
        }
    }
}

/// Half the solid angle of a triangle, as the direction of (cos, sin).
fn half_solid_angle([a, b, c]: [&Seen; 3], volume: f64) -> DVec2 {
    let dot = |a: &Seen, b: &Seen| a.segment.dot(b.segment);
    let cos = a.distance * b.distance * c.distance
        + dot(a, b) * c.distance
        + dot(b, c) * a.distance
        + dot(c, a) * b.distance;
    DVec2::new(cos, volume)
}

/// Half of an angle from 0 to π, both as directions of (cos, sin).
fn half_of(angle: DVec2) -> DVec2 {
    let length = angle.length();
    if angle.x < 0.0 {
        DVec2::new(angle.y, length - angle.x)
    } else {
        DVec2::new(length + angle.x, angle.y)
    }
}

/// The tangent of half of an angle between −π and π, given as the direction of (cos, sin).
fn half_tangent(angle: DVec2) -> f64 {
    angle.y / (angle.length() + angle.x)
}
