//! Meshes by formula: the parts of the generated scenes.

use std::collections::HashMap;
use std::f64::consts::TAU;

use glam::{DVec3, Vec3};
use softbox::geometry::Shapes;

/// Appends `part`, scaled and then moved.
pub(crate) fn append(shapes: &mut Shapes, part: &Shapes, scale: f32, offset: Vec3) {
    let first = shapes.positions.len() as u32;
    let moved = part.positions.iter().map(|p| *p * scale + offset);
    shapes.positions.extend(moved);
    let triangles = part.triangles.iter().map(|t| t.map(|i| i + first));
    shapes.triangles.extend(triangles);
}

/// Appends the parallelogram at `corner` with the edges `u` and `v`: two triangles.
pub(crate) fn add_quad(shapes: &mut Shapes, corner: Vec3, u: Vec3, v: Vec3) {
    let i = shapes.positions.len() as u32;
    let corners = [corner, corner + u, corner + u + v, corner + v];
    shapes.positions.extend(corners);
    shapes
        .triangles
        .extend([[i, i + 1, i + 2], [i, i + 2, i + 3]]);
}

/// Appends the box from `min` to `max`, without its front (largest z) if it `is_open`: ten or twelve
/// triangles.
pub(crate) fn add_box(shapes: &mut Shapes, min: Vec3, max: Vec3, is_open: bool) {
    let edge = |axis: usize| Vec3::AXES[axis] * (max - min)[axis];
    for axis in 0..3 {
        let (u, v) = (edge((axis + 1) % 3), edge((axis + 2) % 3));
        add_quad(shapes, min, u, v);
        if axis != 2 || !is_open {
            add_quad(shapes, min + edge(axis), u, v);
        }
    }
}

/// A smooth function of space with details at four scales, about -0.3 to 0.3; `fine` is the size of
/// the smallest.
pub(crate) fn bumps(p: DVec3, fine: f64) -> f64 {
    let layer = |frequency: f64, shift: f64| {
        let q = p * frequency + DVec3::new(0.0, shift, 2.0 * shift);
        (q.x + 0.4 * q.y).sin() * (q.y - 0.3 * q.z).sin() * (q.z + 0.2 * q.x).sin()
    };
    0.18 * layer(3.7, 0.9)
        + 0.09 * layer(9.1, 2.3)
        + 0.03 * layer(21.0, 4.1)
        + fine * layer(97.0, 5.7)
}

/// A ball around the origin of 20 `n`² triangles, closed; `radius` by unit direction.
///
/// Every face of an icosahedron is divided into `n`² triangles.
pub(crate) fn geodesic(n: u32, radius: impl Fn(DVec3) -> f64) -> Shapes {
    let corners = icosahedron_corners();
    let mut shapes = Shapes::default();
    // A vertex is a mixture of corners; those on the edges of a face belong to its neighbours too.
    let mut known = HashMap::new();
    let mut vertex = |mixture: [(usize, u32); 3], shapes: &mut Shapes| {
        let mut key = mixture.map(|(corner, weight)| (weight > 0).then_some((corner, weight)));
        key.sort_unstable();
        *known.entry(key).or_insert_with(|| {
            let parts = key.iter().flatten();
            let sum: DVec3 = parts
                .map(|&(c, weight)| corners[c] * f64::from(weight))
                .sum();
            let direction = sum.normalize();
            shapes
                .positions
                .push((direction * radius(direction)).as_vec3());
            shapes.positions.len() as u32 - 1
        })
    };
    for [a, b, c] in icosahedron_faces(&corners) {
        let mut at =
            |i: u32, j: u32, shapes: &mut Shapes| vertex([(a, n - i - j), (b, i), (c, j)], shapes);
        for (i, j) in (0..n).flat_map(|i| (0..n - i).map(move |j| (i, j))) {
            let [p, q, r] = [(i, j), (i + 1, j), (i, j + 1)].map(|(i, j)| at(i, j, &mut shapes));
            shapes.triangles.push([p, q, r]);
            if i + j + 1 < n {
                let s = at(i + 1, j + 1, &mut shapes);
                shapes.triangles.push([q, s, r]);
            }
        }
    }
    shapes
}

/// The corners of three golden rectangles at right angles.
fn icosahedron_corners() -> Vec<DVec3> {
    let golden = 0.5 + 1.25_f64.sqrt();
    let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let rectangle = |axis: usize| {
        signs.map(|(s, t)| DVec3::AXES[axis] * s + DVec3::AXES[(axis + 1) % 3] * (t * golden))
    };
    (0..3).flat_map(rectangle).collect()
}

/// All triples of neighbours, seen counter-clockwise from outside.
fn icosahedron_faces(corners: &[DVec3]) -> Vec<[usize; 3]> {
    let touch = |a: usize, b: usize| corners[a].distance_squared(corners[b]) < 4.1;
    let mut faces = Vec::new();
    for a in 0..corners.len() {
        for b in (0..a).filter(|b| touch(a, *b)) {
            for c in (0..b).filter(|c| touch(a, *c) && touch(b, *c)) {
                let is_outward = corners[a].dot(corners[b].cross(corners[c])) > 0.0;
                faces.push(if is_outward { [a, b, c] } else { [a, c, b] });
            }
        }
    }
    faces
}

/// A tube around a curve: `along` × `around` quads of two triangles, vertex `i * around + j` on ring
/// `i`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tube {
    /// Quads along the curve.
    pub(crate) along: u32,
    /// Quads around it.
    pub(crate) around: u32,
    /// Whether the last ring is joined to the first.
    pub(crate) is_closed: bool,
}

impl Tube {
    /// The tube around `curve`, a function of [0, 1]; `radius` by place on the curve and unit vector
    /// outwards.
    pub(crate) fn around(
        self,
        curve: impl Fn(f64) -> DVec3,
        radius: impl Fn(f64, DVec3) -> f64,
    ) -> Shapes {
        let rings = self.along + u32::from(!self.is_closed);
        let mut shapes = Shapes::default();
        for i in 0..rings {
            let t = f64::from(i) / f64::from(self.along);
            let middle = curve(t);
            let forward = (curve(t + 1e-4) - curve(t - 1e-4)).normalize();
            let side = forward.cross(DVec3::new(0.02, 1.0, 0.05)).normalize();
            let up = side.cross(forward);
            for j in 0..self.around {
                let (sin, cos) = (TAU * f64::from(j) / f64::from(self.around)).sin_cos();
                let outward = up * cos + side * sin;
                let place = middle + outward * radius(t, outward);
                shapes.positions.push(place.as_vec3());
            }
        }
        let vertex = |i: u32, j: u32| i % rings * self.around + j % self.around;
        for (i, j) in (0..self.along).flat_map(|i| (0..self.around).map(move |j| (i, j))) {
            let [a, b] = [vertex(i, j), vertex(i + 1, j)];
            let [c, d] = [vertex(i + 1, j + 1), vertex(i, j + 1)];
            shapes.triangles.extend([[a, b, c], [a, c, d]]);
        }
        shapes
    }
}

/// A bumpy (2, 3) torus knot about the origin, of extent about 1.9: a closed tube.
pub(crate) fn knot(along: u32, around: u32, fine: f64) -> Shapes {
    let curve = |t: f64| {
        let (a, b) = (2.0 * TAU * t, 3.0 * TAU * t);
        let r = 0.55 + 0.25 * b.cos();
        DVec3::new(r * a.cos(), 0.32 * b.sin(), r * a.sin())
    };
    let tube = Tube {
        along,
        around,
        is_closed: true,
    };
    tube.around(curve, |t, outward| {
        0.13 + 0.065 * bumps((curve(t) + outward) * 2.0, 4.0 * fine)
    })
}

/// A scaly serpent with legs and a crest, 100 000 triangles of very different sizes, as scans of
/// statues have them.
pub(crate) fn serpent() -> Shapes {
    let spine = |t: f64| {
        let bend = (2.2 * TAU * t).sin();
        DVec3::new(
            1.5 * t - 0.75,
            0.25 * (1.3 * TAU * t).cos() - 0.1,
            0.28 * bend,
        )
    };
    let girth = |t: f64| 0.02 + 0.16 * (TAU * 0.5 * t.clamp(0.0, 1.0)).sin().powi(2);
    let part = |along, around| Tube {
        along,
        around,
        is_closed: false,
    };
    let mut shapes = part(900, 40).around(spine, |t, outward| {
        let scales = (TAU * 120.0 * t).sin() * (20.0 * outward.y).sin();
        girth(t) * (1.0 + 0.05 * scales + bumps((spine(t) + outward) * 1.5, 0.02))
    });
    for leg in 0..4 {
        let t = if leg < 2 { 0.32 } else { 0.68 };
        let side = if leg % 2 == 0 { 0.14 } else { -0.14 };
        let hip = spine(t);
        let foot = DVec3::new(hip.x + 0.1, -0.55, hip.z + side);
        let curve = |s: f64| hip.lerp(foot, s) + DVec3::Z * (side * (TAU * 0.5 * s).sin());
        let leg = part(100, 24).around(curve, |s, outward| {
            (0.07 - 0.04 * s) * (1.0 + 0.3 * bumps((curve(s) + outward) * 3.0, 0.05))
        });
        append(&mut shapes, &leg, 1.0, Vec3::ZERO);
    }
    for spike in 0..110 {
        let t = (f64::from(spike) + 0.5) / 110.0;
        let root = spine(t) + DVec3::Y * (0.8 * girth(t));
        let tip = root + DVec3::new(0.05, 0.5 * girth(t) + 0.02, 0.0);
        let spike = part(10, 4).around(|s| root.lerp(tip, s), |s, _| 0.012 * (1.001 - s));
        append(&mut shapes, &spike, 1.0, Vec3::ZERO);
    }
    shapes
}
