use glam::Vec3;

use super::super::bounds::EmissionBounds;

/// Children of a node.
pub(super) const WIDTH: usize = 8;
/// In a link: the child is a part, not a node.
const PART: u32 = 1 << 31;
/// In a link: the child shines against its axis too.
const TWO_SIDED: u32 = 1 << 30;
/// Steps of the stored cosines and axes to 1.
const COSINE_STEPS: f32 = 127.0;
const AXIS_STEPS: f32 = 32767.0;
/// Intensities are relative to the brightest part; dimmer ones count as this.
pub(super) const LEAST_INTENSITY: f32 = 1e-20;

/// Up to [`WIDTH`] children side by side, 32 bytes each. Empty places have intensity 0.
#[derive(Clone, Debug, PartialEq)]
#[repr(C, align(64))]
pub(super) struct Node {
    x: [f32; WIDTH],
    y: [f32; WIDTH],
    z: [f32; WIDTH],
    radius: [f32; WIDTH],
    intensity: [f32; WIDTH],
    link: [u32; WIDTH],
    axis: [[i16; WIDTH]; 3],
    cos_normals: [i8; WIDTH],
    cos_emission: [i8; WIDTH],
}

/// What lies behind a child.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Link {
    /// Node number.
    Node(usize),
    /// Part number, counted over all lights.
    Part(usize),
}

/// A child of a node of the light tree, as it is stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightCluster {
    /// Middle of a sphere around it.
    pub center: Vec3,
    /// Radius of the sphere.
    pub radius: f32,
    /// The axis of its normals, a unit vector up to 10⁻⁴.
    pub axis: Vec3,
    /// Cosine of the largest angle of a normal to the axis.
    pub cos_normals: f32,
    /// Cosine of the largest angle of emission to a normal.
    pub cos_emission: f32,
    /// It shines against the axis too.
    pub two_sided: bool,
    /// Luminance of the intensity, relative to the brightest part of all.
    pub intensity: f32,
    /// What it is.
    pub link: Link,
}

impl LightCluster {
    /// Square of the shortest distance that counts, in scene units: scenes are of unit size.
    pub const LEAST_DISTANCE2: f32 = 1e-12;
    /// Points up to this many squared radii away count as inside the sphere, so that rounding does
    /// not matter on it.
    pub const INSIDE: f32 = 1.001;
    /// Emission this close to the edge of its cone is never left out: axes and cosines are rounded.
    pub const EDGE: f32 = 1e-4;
    /// The share of the cosines of the middle, the rest is that of their bounds. Found by measurement:
    /// with 0, small error remains where clusters are wide; with 1, lights just below the horizon of
    /// their middle are missed.
    pub const MIDDLE: f32 = 0.7;
}

impl Node {
    pub(super) const EMPTY: Self = Self {
        x: [0.0; WIDTH],
        y: [0.0; WIDTH],
        z: [0.0; WIDTH],
        radius: [0.0; WIDTH],
        intensity: [0.0; WIDTH],
        link: [0; WIDTH],
        axis: [[0; WIDTH]; 3],
        cos_normals: [0; WIDTH],
        cos_emission: [0; WIDTH],
    };

    /// Puts `bounds` at place `i`; its intensity becomes relative to `brightest`. Cosines are
    /// rounded down, so that nothing is left out.
    pub(super) fn set(&mut self, i: usize, bounds: &EmissionBounds, brightest: f64, link: Link) {
        let cosine = |cos: f32| (cos.clamp(-1.0, 1.0) * COSINE_STEPS).floor() as i8;
        [self.x[i], self.y[i], self.z[i]] = bounds.center.to_array();
        self.radius[i] = bounds.radius;
        let relative = (f64::from(bounds.intensity) / brightest) as f32;
        self.intensity[i] = relative.max(LEAST_INTENSITY);
        for (axis, component) in self.axis.iter_mut().zip(bounds.axis.to_array()) {
            axis[i] = (component * AXIS_STEPS).round() as i16;
        }
        self.cos_normals[i] = cosine(bounds.cos_normals);
        self.cos_emission[i] = cosine(bounds.cos_emission);
        let side = if bounds.two_sided { TWO_SIDED } else { 0 };
        self.link[i] = side
            | match link {
                Link::Node(node) => node as u32,
                Link::Part(part) => PART | part as u32,
            };
    }

    pub(super) fn link(&self, i: usize) -> Link {
        let index = (self.link[i] & !(PART | TWO_SIDED)) as usize;
        if self.link[i] & PART == 0 {
            Link::Node(index)
        } else {
            Link::Part(index)
        }
    }

    /// Child `i`; `None` when there is none.
    pub(super) fn cluster(&self, i: usize) -> Option<LightCluster> {
        (self.intensity[i] > 0.0).then(|| LightCluster {
            center: Vec3::new(self.x[i], self.y[i], self.z[i]),
            radius: self.radius[i],
            axis: Vec3::from_array([0, 1, 2].map(|k| axis(self.axis[k][i]))),
            cos_normals: cosine(self.cos_normals[i]),
            cos_emission: cosine(self.cos_emission[i]),
            two_sided: self.link[i] & TWO_SIDED != 0,
            intensity: self.intensity[i],
            link: self.link(i),
        })
    }

    /// About the irradiance that each child could give at `point` on the side of the unit `normal`
    /// if nothing is in the way, in arbitrary units; 0 only where it gives none.
    ///
    /// Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree
    /// Splitting", section 4.2, bounds the cosine at the light: the angle is made smaller by what
    /// the sphere around the child subtends. Here the cosine at the surface is bounded in the same
    /// way, and both are then mixed with the cosines of the middle, which are nearer the mean.
    pub(super) fn importance(&self, point: Vec3, normal: Vec3) -> [f32; WIDTH] {
        let mut importance = [0.0; WIDTH];
        for (i, importance) in importance.iter_mut().enumerate() {
            *importance = self.importance_of(i, point, normal);
        }
        importance
    }

    /// No branches, so that the compiler does several children at once.
    #[inline(always)]
    fn importance_of(&self, i: usize, point: Vec3, normal: Vec3) -> f32 {
        let x = self.x[i] - point.x;
        let y = self.y[i] - point.y;
        let z = self.z[i] - point.z;
        let radius = self.radius[i];
        let r2 = radius * radius;
        let d2 = (x * x + y * y + z * z).max(LightCluster::LEAST_DISTANCE2);
        let inverse = 1.0 / d2.sqrt();
        let is_inside = d2 <= r2 * LightCluster::INSIDE;
        // The half angle that the sphere subtends.
        let sin_b = radius * inverse;
        let cos_b = sine(sin_b);
        let [ax, ay, az] = [0, 1, 2].map(|k| axis(self.axis[k][i]));
        let along_axis = -(x * ax + y * ay + z * az) * inverse;
        let two_sided = self.link[i] & TWO_SIDED != 0;
        let cos_w = if two_sided {
            along_axis.abs()
        } else {
            along_axis
        };
        // From the nearest normal.
        let cos_o = cosine(self.cos_normals[i]);
        let (sin_w, sin_o) = (sine(cos_w), sine(cos_o));
        let (cos_wo, sin_wo) = (cos_w * cos_o + sin_w * sin_o, sin_w * cos_o - cos_w * sin_o);
        let is_normal = cos_w >= cos_o;
        let cos_x = if is_normal { 1.0 } else { cos_wo };
        let sin_x = if is_normal { 0.0 } else { sin_wo };
        // From the nearest normal to the nearest point, and from the surface's normal to it.
        let at_light = narrowed((cos_x, sin_x), (cos_b, sin_b));
        let cos_i = (x * normal.x + y * normal.y + z * normal.z) * inverse;
        let at_surface = narrowed((cos_i, sine(cos_i)), (cos_b, sin_b)).max(0.0);
        let at_light = if is_inside { 1.0 } else { at_light };
        let at_surface = if is_inside { 1.0 } else { at_surface };
        let mean_at_light = mixed(at_light.max(LightCluster::EDGE), cos_x);
        let irradiance = self.intensity[i] * mean_at_light * mixed(at_surface, cos_i) / d2.max(r2);
        let is_emitting = at_light > cosine(self.cos_emission[i]) - LightCluster::EDGE;
        if is_emitting { irradiance } else { 0.0 }
    }
}

/// The cosine of an angle made smaller by another, at least 0; both by cosine and sine.
fn narrowed((cos_a, sin_a): (f32, f32), (cos_b, sin_b): (f32, f32)) -> f32 {
    let difference = cos_a * cos_b + sin_a * sin_b;
    if cos_a >= cos_b { 1.0 } else { difference }
}

/// The bound of a cosine, mixed with the cosine of the middle where that is positive.
fn mixed(bound: f32, middle: f32) -> f32 {
    // Where the bound is 0, nothing is in front: rounding must not let the other bring it back.
    let bound = bound.max(0.0);
    // Not `clamp`: its check of the limits is a branch.
    bound + (middle.max(0.0).min(bound) - bound) * LightCluster::MIDDLE
}

fn axis(stored: i16) -> f32 {
    f32::from(stored) * (1.0 / AXIS_STEPS)
}

fn cosine(stored: i8) -> f32 {
    f32::from(stored) * (1.0 / COSINE_STEPS)
}

fn sine(cosine: f32) -> f32 {
    (1.0 - cosine * cosine).max(0.0).sqrt()
}
