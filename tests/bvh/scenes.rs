//! Meshes and rays that the tests share.

use glam::Vec3;
use softbox::bvh::{BvhKind, BvhSettings};
use softbox::geometry::{Aggregate, Hit, Shapes, Sphere, TraceCounts};
use softbox::math::{Isa, Ray};

/// A small generator of random numbers (Marsaglia 2003, "Xorshift RNGs").
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub(crate) fn bits(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1_u64 << 24) as f32
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.bits() >> 11) as usize % n
    }

    /// Uniform in the cube from -1 to 1.
    pub(crate) fn in_cube(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
    }

    /// A direction, uniform over the sphere.
    pub(crate) fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.in_cube();
            let length = v.length();
            if length > 0.01 && length <= 1.0 {
                return v / length;
            }
        }
    }
}

pub(crate) fn settings(kind: BvhKind, leaf_size: u32) -> BvhSettings {
    BvhSettings {
        kind,
        leaf_size,
        ..BvhSettings::default()
    }
}

/// One leaf with everything: every ray meets every primitive.
pub(crate) fn brute_force(shapes: Shapes) -> Aggregate {
    Aggregate::build(shapes, settings(BvhKind::None, 1))
}

/// The same shapes in every form that the tracer has, each with its name: all must give the same
/// hits, bit for bit, and pass every test.
pub(crate) fn aggregates(shapes: &Shapes, settings: BvhSettings) -> Vec<(&'static str, Aggregate)> {
    let built = Aggregate::build(shapes.clone(), settings);
    let swept = built.is_swept().then(|| built.clone());
    let trees =
        Isa::available().map(|isa| (isa.name(), built.clone().without_sweep().with_isa(isa)));
    let sweeps = swept.into_iter().flat_map(|swept| {
        Isa::available().map(move |isa| match isa {
            Isa::Portable => ("portable sweep", swept.clone().with_isa(isa)),
            _ => ("sweep", swept.clone().with_isa(isa)),
        })
    });
    trees.chain(sweeps).collect()
}

pub(crate) fn closest(aggregate: &Aggregate, rays: &[Ray]) -> Vec<Hit> {
    let mut hits = vec![Hit::MISS; rays.len()];
    aggregate.closest_hit(rays, &mut hits, &mut TraceCounts::default());
    hits
}

/// The hit as bits, so that -0 and NaN cannot hide.
pub(crate) fn bits(hit: &Hit) -> (u32, u32, u32, u32) {
    let Hit {
        t,
        primitive,
        b1,
        b2,
    } = *hit;
    (t.to_bits(), primitive, b1.to_bits(), b2.to_bits())
}

/// A closed sphere-like mesh with `n` × `n` cells around the origin; `radius(i, j)` per vertex.
pub(crate) fn closed_sphere(n: usize, radius: impl Fn(usize, usize) -> f32) -> Shapes {
    use std::f32::consts::{PI, TAU};
    let mut positions = vec![Vec3::Z * radius(0, 0), Vec3::NEG_Z * radius(n, 0)];
    for i in 1..n {
        for j in 0..n {
            let (theta, phi) = (PI * i as f32 / n as f32, TAU * j as f32 / n as f32);
            let ring = theta.sin();
            let v = Vec3::new(ring * phi.cos(), ring * phi.sin(), theta.cos());
            positions.push(v * radius(i, j));
        }
    }
    let vertex = |i: usize, j: usize| match i {
        0 => 0,
        _ if i == n => 1,
        _ => (2 + (i - 1) * n + j % n) as u32,
    };
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let quad = [
                vertex(i, j),
                vertex(i + 1, j),
                vertex(i + 1, j + 1),
                vertex(i, j + 1),
            ];
            if i + 1 < n {
                triangles.push([quad[0], quad[1], quad[2]]);
            }
            if i > 0 {
                triangles.push([quad[0], quad[2], quad[3]]);
            }
        }
    }
    Shapes {
        positions,
        triangles,
        spheres: Vec::new(),
    }
}

pub(crate) fn smooth_sphere() -> Shapes {
    closed_sphere(16, |_, _| 1.0)
}

pub(crate) fn spiky_sphere() -> Shapes {
    closed_sphere(16, |i, j| if (i + j) % 2 == 0 { 1.0 } else { 0.4 })
}

/// The cube from -1 to 1, twelve triangles.
pub(crate) fn cube() -> Shapes {
    let positions = (0..8)
        .map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 2.0 - 1.0)
        .collect();
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = faces
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .collect();
    Shapes {
        positions,
        triangles,
        spheres: Vec::new(),
    }
}

/// Triangles without shared vertices.
pub(crate) fn soup(corners: impl IntoIterator<Item = [Vec3; 3]>) -> Shapes {
    let positions: Vec<_> = corners.into_iter().flatten().collect();
    let triangles = (0..positions.len() as u32 / 3)
        .map(|i| [3 * i, 3 * i + 1, 3 * i + 2])
        .collect();
    Shapes {
        positions,
        triangles,
        spheres: Vec::new(),
    }
}

/// `n` random triangles of edge length about `size` in the unit cube.
pub(crate) fn random_soup(n: usize, size: f32, seed: u64) -> Shapes {
    let mut random = Random::new(seed);
    soup((0..n).map(|_| {
        let center = random.in_cube();
        [0; 3].map(|_| center + random.in_cube() * size)
    }))
}

/// Triangles and spheres mixed.
pub(crate) fn mixed(n: usize) -> Shapes {
    let mut random = Random::new(77);
    let spheres = (0..n).map(|_| Sphere {
        center: random.in_cube(),
        radius: 0.02 + 0.1 * random.unit(),
    });
    let spheres = spheres.collect();
    Shapes {
        spheres,
        ..random_soup(n, 0.2, 5)
    }
}

/// Rays through the unit cube, some parallel to axes, some with long directions and bounds.
pub(crate) fn random_rays(n: usize, seed: u64) -> Vec<Ray> {
    let mut random = Random::new(seed);
    (0..n)
        .map(|i| {
            let origin = random.in_cube() * 1.5;
            let mut direction = (random.in_cube() * 0.8 - origin) * (0.1 + random.unit());
            match i % 8 {
                0 => direction[random.below(3)] = 0.0,
                1 => {
                    let axis = random.below(3);
                    direction =
                        Vec3::ZERO.with_axis(axis, if random.unit() < 0.5 { 1.0 } else { -1.0 });
                }
                _ => {}
            }
            let mut ray = Ray::new(origin, direction);
            if i % 3 == 0 {
                ray.t_max = 3.0 * random.unit();
            }
            if i % 5 == 0 {
                ray.t_min = random.unit();
            }
            ray
        })
        .collect()
}

/// `Vec3` with one component replaced.
pub(crate) trait WithAxis {
    fn with_axis(self, axis: usize, value: f32) -> Self;
}

impl WithAxis for Vec3 {
    fn with_axis(mut self, axis: usize, value: f32) -> Self {
        self[axis] = value;
        self
    }
}
