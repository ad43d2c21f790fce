use glam::{Vec2, Vec3};

use super::LightSampleContext;
use super::parallelogram::Parallelogram;
use crate::sampling::Bilinear;

/// The share of the first edge by which points count as less far beyond it. Not zero: points straight
/// below an edge would be left to rounding.
pub(crate) const LEVEL: f32 = 0.013;

/// Samples a parallelogram nearby: by solid angle, in the cylinder coordinates of an axis through the
/// point that runs along an edge, times a factor bilinear between the four corners.
///
/// A row of the light along the axis at distance r is sampled by the sine of the angle to the axis'
/// normal plane, y / √(r² + y²), the rows by the angle θ about the axis. dω = dθ d(sine), so that what
/// a sample counts for is bounded, however near the light is. (Ureña, Fajardo, King 2013, "An
/// Area-Preserving Parametrization for Spherical Rectangles", invert the product exactly; here the
/// length of the rows enters by the bilinear factor.) The angle is replaced by the tangent of a quarter
/// of it, which needs roots only and is uneven by at most a factor of two.
pub(super) struct CylinderWarp<'a> {
    from: Vec3,
    frame: &'a EdgeFrame,
    /// From the axis to the plane, unit times distance.
    height: f32,
    down: Vec3,
    /// First row, along `across`.
    near_row: f32,
    /// Start of the first row along the axis.
    start: f32,
    /// The middle of the angle that the rows fill, as a unit vector over (`across`, `down`).
    middle: Vec2,
    /// Tangent of a quarter of that angle.
    quarter: f32,
    density: Bilinear,
}

/// A parallelogram as it lies to an axis along one of its edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EdgeFrame {
    /// Unit, along the edge; sines are measured along it.
    pub(super) axis: Vec3,
    /// Unit, in the plane, at a right angle to the axis, from the first row to the last.
    pub(super) across: Vec3,
    /// Of the edge and of all rows.
    pub(super) length: f32,
    /// From the first row to the last, along `across`.
    pub(super) width: f32,
    /// How far rows move along the axis per unit of `across`.
    pub(super) shear: f32,
}

impl EdgeFrame {
    /// The axes along the first and along the second edge.
    pub(super) fn both(edge_1: Vec3, edge_2: Vec3, normal: Vec3) -> [Self; 2] {
        let frame = |along: Vec3, other: Vec3, turn: f32| {
            let length = along.length();
            let axis = along / length;
            let across = turn * normal.cross(axis);
            let width = other.dot(across);
            Self {
                axis,
                across,
                length,
                width,
                shear: other.dot(axis) / width,
            }
        };
        [frame(edge_1, edge_2, 1.0), frame(edge_2, edge_1, -1.0)]
    }
}

/// The part of the light at one distance from the axis.
struct Row {
    /// Squared distance to the axis.
    radius2: f32,
    /// Ends along the axis, and their distances from the point.
    ends: [f32; 2],
    distances: [f32; 2],
    /// Sine at the last end less that at the first.
    sines: f32,
}

impl<'a> CylinderWarp<'a> {
    /// `None` in the plane of the light and where the light lies wholly below the horizon of `from`.
    pub(super) fn new(light: &'a Parallelogram, from: &LightSampleContext) -> Option<Self> {
        let along = usize::from(is_beyond_ends(light, from.point));
        let frame = &light.frames[along];
        let EdgeFrame {
            axis,
            across,
            width,
            ..
        } = *frame;
        let to_corner = light.corner - from.point;
        let height = light.normal.dot(to_corner);
        let near_row = to_corner.dot(across);
        let far_row = near_row + width;
        let unit = |x: f32| Vec2::new(x, height.abs()).normalize_or_zero();
        let sum = unit(near_row) + unit(far_row);
        // Half the angle: cosine from the sum, sine of a small angle from that of the whole.
        let cos = 0.5 * sum.length();
        let sin = if cos < 0.5 {
            (1.0 - cos * cos).sqrt()
        } else {
            0.5 * unit(near_row).y * unit(far_row).y * (width / height.abs()) / cos
        };
        let mut warp = Self {
            from: from.point,
            frame,
            height: height.abs(),
            down: light.normal * height.signum(),
            near_row,
            start: to_corner.dot(axis),
            middle: sum.try_normalize()?,
            quarter: sin / (1.0 + cos),
            density: Bilinear::new([1.0; 4])?,
        };
        let sines = [warp.row(near_row).sines, warp.row(far_row).sines];
        let corners = light.corners_along(along);
        let weight = |i: usize| {
            let segment = corners[i] - from.point;
            let distance = segment.length();
            sines[i / 2] * from.foreshortened(segment, distance) / distance
        };
        warp.density = Bilinear::new([0, 1, 2, 3].map(weight))?;
        (warp.quarter > 0.0).then_some(warp)
    }

    /// Point and density per steradian.
    pub(super) fn sample(&self, u: Vec2) -> (Vec3, f32) {
        let place = self.density.sample(u);
        let tangent = self.quarter * (2.0 * place.y - 1.0);
        let scale = 1.0 / (1.0 + tangent * tangent);
        let (cos, sin) = ((1.0 - tangent * tangent) * scale, 2.0 * tangent * scale);
        let sideways = self.middle.x * cos + self.middle.y * sin;
        let downwards = self.middle.y * cos - self.middle.x * sin;
        // At the ends rounding may leave the light or even point upwards.
        let x = (self.height * sideways / downwards.max(f32::MIN_POSITIVE))
            .clamp(self.near_row, self.near_row + self.frame.width);
        let row = self.row(x);
        let y = row.at(place.x);
        let point =
            self.from + x * self.frame.across + y * self.frame.axis + self.height * self.down;
        (point, self.density_at(place, tangent, &row))
    }

    /// Density per steradian at a point of the light.
    pub(super) fn pdf(&self, point: Vec3) -> f32 {
        let segment = point - self.from;
        let x = segment.dot(self.frame.across);
        let toward = Vec2::new(x, self.height).normalize_or_zero();
        let cos = toward.dot(self.middle);
        let sin = toward.x * self.middle.y - toward.y * self.middle.x;
        let most = self.quarter;
        let tangent = (sin / (1.0 + cos)).clamp(-most, most);
        let row = self.row(x.clamp(self.near_row, self.near_row + self.frame.width));
        let along = row.place_of(segment.dot(self.frame.axis));
        let place = Vec2::new(along, 0.5 + 0.5 * tangent / most);
        self.density_at(place, tangent, &row)
    }

    /// θ is twice the angle whose tangent is that of half of it: dθ = 2 dt / (1 + t²), and t goes
    /// through 2 · `quarter`.
    fn density_at(&self, place: Vec2, tangent: f32, row: &Row) -> f32 {
        self.density.pdf(place) * (1.0 + tangent * tangent) / (4.0 * self.quarter * row.sines)
    }

    /// The row at `x` along `across`.
    fn row(&self, x: f32) -> Row {
        let first = self.start + (x - self.near_row) * self.frame.shear;
        let ends = [first, first + self.frame.length];
        let radius2 = x * x + self.height * self.height;
        let distances = ends.map(|y| (radius2 + y * y).sqrt());
        let product = distances[0] * distances[1];
        let outer = ends[1] * distances[0] + -ends[0] * distances[1];
        // On one side of the point the sines cancel; a² − b² over a + b does not.
        let inner = radius2 * self.frame.length * (ends[0] + ends[1])
            / (ends[1] * distances[0] + ends[0] * distances[1]);
        let is_aside = ends[0] * ends[1] > 0.0;
        Row {
            radius2,
            ends,
            distances,
            sines: if is_aside { inner } else { outer } / product,
        }
    }
}

/// True where rows along the first edge would lie farther off their middle than rows along the second.
/// From beyond the end of a row that runs past close by, the angle about it says little about how much
/// of it is seen.
fn is_beyond_ends(light: &Parallelogram, from: Vec3) -> bool {
    let place = light.place_of(from);
    let beyond = (place - place.clamp(Vec2::ZERO, Vec2::ONE)).abs();
    let [first, second] = &light.frames;
    (beyond.x - LEVEL) * first.length > beyond.y * second.length
}

impl Row {
    /// The place along the axis whose sine lies the share `t` of the way between those of the ends.
    fn at(&self, t: f32) -> f32 {
        let [s0, s1] = [0, 1].map(|i| self.ends[i] / self.distances[i]);
        let sine = (1.0 - t) * s0 + t * s1;
        // 1 − sine², of positive terms only.
        let [c0, c1] = self.distances.map(|d| self.radius2 / (d * d));
        let cos2 = (1.0 - t) * c0 + t * c1 + t * (1.0 - t) * self.sines * self.sines;
        let y = sine * (self.radius2 / cos2).sqrt();
        y.clamp(self.ends[0], self.ends[1])
    }

    /// The inverse of [`Self::at`].
    fn place_of(&self, y: f32) -> f32 {
        let sine = y / (self.radius2 + y * y).sqrt();
        ((sine - self.ends[0] / self.distances[0]) / self.sines).clamp(0.0, 1.0)
    }
}
