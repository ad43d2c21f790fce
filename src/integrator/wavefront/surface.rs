use glam::Vec3;

use crate::geometry::{Hit, is_clear_of_edges, triangle_departure};
use crate::math::{DoubleLanes, Lanes, ROW, Ray, Vec3Array, Vec3Lanes, gamma, set_bits};
use crate::scene::{PlainShape, PlainSurfaces, SurfaceInteraction};

/// Up to eight plain surface points, each with the bits of [`crate::scene::PreparedScene::interaction`].
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfaceLanes<L> {
    pub(super) point: Vec3Lanes<L>,
    pub(super) departure: Vec3Lanes<L>,
    pub(super) error: Vec3Lanes<L>,
    pub(super) geometric_normal: Vec3Lanes<L>,
    pub(super) shading_normal: Vec3Lanes<L>,
    pub(super) reflectance: Vec3Lanes<L>,
}

impl<L: Lanes> SurfaceLanes<L> {
    /// To memory.
    #[inline(always)]
    pub(super) fn store(&self) -> SurfaceArrays {
        SurfaceArrays {
            point: self.point.store(),
            departure: self.departure.store(),
            error: self.error.store(),
            geometric_normal: self.geometric_normal.store(),
            shading_normal: self.shading_normal.store(),
        }
    }
}

/// What single steps have looked up for eight hits.
#[derive(Debug)]
pub(super) struct Found {
    /// A bit for each lane that holds a plain surface.
    pub(super) lanes: u32,
    spheres: u32,
    smooth: u32,
    /// Of triangles; of spheres the centres, and the radius in all components.
    vertices: [Vec3Array; 3],
    /// At the vertices of smooth triangles.
    normals: [Vec3Array; 3],
    reflectance: Vec3Array,
    weights: [[f32; ROW]; 2],
    /// Of rays that met spheres, where they did.
    met: Vec3Array,
}

impl Found {
    /// Nothing.
    pub(super) const NONE: Self = Self {
        lanes: 0,
        spheres: 0,
        smooth: 0,
        vertices: [Vec3Array::ZERO; 3],
        normals: [Vec3Array::ZERO; 3],
        reflectance: Vec3Array::ZERO,
        weights: [[0.0; ROW]; 2],
        met: Vec3Array::ZERO,
    };

    /// Looks up the surfaces of up to eight `hits` by `rays`. In other lanes stays what was there.
    #[inline(always)]
    pub(super) fn look_up(&mut self, scene: &PlainSurfaces<'_>, rays: &[Ray], hits: &[Hit]) {
        (self.lanes, self.spheres, self.smooth) = (0, 0, 0);
        for (lane, (ray, hit)) in rays.iter().zip(hits).enumerate().take(ROW) {
            let Some((reflectance, shape)) = scene.get(hit.primitive) else {
                continue;
            };
            let bit = 1 << lane;
            self.lanes |= bit;
            self.reflectance.set(lane, reflectance);
            match shape {
                PlainShape::Triangle([a, b, c], normals) => {
                    self.vertices[0].set(lane, a);
                    self.vertices[1].set(lane, b);
                    self.vertices[2].set(lane, c);
                    self.weights[0][lane] = hit.b1;
                    self.weights[1][lane] = hit.b2;
                    if let Some([a, b, c]) = normals {
                        self.smooth |= bit;
                        self.normals[0].set(lane, *a);
                        self.normals[1].set(lane, *b);
                        self.normals[2].set(lane, *c);
                    }
                }
                PlainShape::Sphere(sphere) => {
                    self.spheres |= bit;
                    self.vertices[0].set(lane, sphere.center);
                    self.vertices[1].set(lane, Vec3::splat(sphere.radius));
                    self.met.set(lane, ray.at(hit.t));
                }
            }
        }
    }

    /// The surfaces.
    #[inline(always)]
    pub(super) fn surfaces<L: Lanes>(&self) -> SurfaceLanes<L> {
        let mut surface = self.triangles::<L>();
        if self.spheres != 0 {
            self.add_spheres(&mut surface);
        }
        if self.smooth != 0 {
            let (b1, b2) = (L::load_row(&self.weights[0]), L::load_row(&self.weights[1]));
            let b0 = L::splat(1.0) - b1 - b2;
            let smooth = Vec3Lanes::load(&self.normals[0]).scale(b0)
                + Vec3Lanes::load(&self.normals[1]).scale(b1)
                + Vec3Lanes::load(&self.normals[2]).scale(b2);
            surface.shading_normal = Vec3Lanes::select(
                L::mask_of_bits(self.smooth),
                smooth.normalize_or(surface.geometric_normal),
                surface.geometric_normal,
            );
        }
        surface
    }

    #[inline(always)]
    fn triangles<L: Lanes>(&self) -> SurfaceLanes<L> {
        let a = Vec3Lanes::<L>::load(&self.vertices[0]);
        let b = Vec3Lanes::load(&self.vertices[1]);
        let c = Vec3Lanes::load(&self.vertices[2]);
        let (b1, b2) = (L::load_row(&self.weights[0]), L::load_row(&self.weights[1]));
        let b0 = L::splat(1.0) - b1 - b2;
        let (wa, wb, wc) = (a.scale(b0), b.scale(b1), c.scale(b2));
        let point = wa + wb + wc;
        let reach = (a - point)
            .abs()
            .max((b - point).abs())
            .max((c - point).abs());
        let error = (wa.abs() + wb.abs() + wc.abs())
            .scale(L::splat(gamma(7)))
            .offset(reach.max_element() * L::splat(gamma(8)));
        let (ab, ac, bc) = (b - a, c - a, c - b);
        let normal = ab.unit_cross(ac);
        let mut surface = SurfaceLanes {
            point,
            departure: point,
            error,
            geometric_normal: normal,
            shading_normal: normal,
            reflectance: Vec3Lanes::load(&self.reflectance),
        };
        let longest = ab
            .length_squared()
            .max(ac.length_squared())
            .max(bc.length_squared());
        let clear = L::bits(is_clear_of_edges([b0, b1, b2], longest, error));
        let near = self.lanes & !self.spheres & !clear;
        if near != 0 {
            let (departure, error) = self.depart(near, &point.store(), &error.store());
            surface.departure = Vec3Lanes::load(&departure);
            surface.error = Vec3Lanes::load(&error);
        }
        surface
    }

    /// The points of departure and their errors, those of `lanes`, which are close to an edge, one by
    /// one.
    #[cold]
    #[inline(never)]
    fn depart(&self, lanes: u32, points: &Vec3Array, errors: &Vec3Array) -> (Vec3Array, Vec3Array) {
        let (mut departures, mut bounds) = (*points, *errors);
        for lane in set_bits(lanes) {
            let vertices = self.vertices.map(|vertex| vertex.get(lane));
            let [b1, b2] = self.weights.map(|weights| weights[lane]);
            let at = (points.get(lane), errors.get(lane));
            let (departure, bound) = triangle_departure(&vertices, b1, b2, at);
            departures.set(lane, departure);
            bounds.set(lane, bound);
        }
        (departures, bounds)
    }

    /// As [`crate::geometry::Sphere::point_and_error`].
    #[inline(always)]
    fn add_spheres<L: Lanes>(&self, surface: &mut SurfaceLanes<L>) {
        let center = Vec3Lanes::<L>::load(&self.vertices[0]);
        let radius = Vec3Lanes::<L>::load(&self.vertices[1]).x;
        let [mx, my, mz] = Vec3Lanes::<L>::load(&self.met).widen();
        let [cx, cy, cz] = center.widen();
        let [x, y, z] = Vec3Lanes::<L>::unit_or([mx - cx, my - cy, mz - cz], [0.0; 3]);
        let wide_radius = L::Doubles::widen(radius);
        let point = Vec3Lanes::new(
            (cx + x * wide_radius).narrow(),
            (cy + y * wide_radius).narrow(),
            (cz + z * wide_radius).narrow(),
        );
        let error = point.abs().offset(radius).scale(L::splat(gamma(2)));
        let normal = (point - center).normalize_or(Vec3Lanes::splat(Vec3::Z));
        let is_sphere = L::mask_of_bits(self.spheres);
        surface.point = Vec3Lanes::select(is_sphere, point, surface.point);
        surface.departure = Vec3Lanes::select(is_sphere, point, surface.departure);
        surface.error = Vec3Lanes::select(is_sphere, error, surface.error);
        surface.geometric_normal = Vec3Lanes::select(is_sphere, normal, surface.geometric_normal);
        surface.shading_normal = surface.geometric_normal;
    }
}

/// Eight surfaces in memory.
#[derive(Debug)]
pub(super) struct SurfaceArrays {
    point: Vec3Array,
    departure: Vec3Array,
    error: Vec3Array,
    geometric_normal: Vec3Array,
    shading_normal: Vec3Array,
}

impl SurfaceArrays {
    pub(super) fn get(&self, lane: usize, primitive: u32) -> SurfaceInteraction {
        SurfaceInteraction {
            point: self.point.get(lane),
            departure: self.departure.get(lane),
            error: self.error.get(lane),
            geometric_normal: self.geometric_normal.get(lane),
            shading_normal: self.shading_normal.get(lane),
            primitive,
        }
    }
}
