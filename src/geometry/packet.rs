use super::Hit;
use super::block::{Block, Corner, TRIANGLES};
use super::leaf::Query;
use super::triangle::{Edges, Shear};
use crate::bvh::{BLOCK, PacketRays, PerRay, SlabRay, groups, padded_each};
use crate::math::{Lanes, ROW, Ray, set_bits};

const ZERO: PerRay = PerRay::splat(0.0);

/// The rays of a packet among the primitives: [`Query`] side by side, all sheared along one axis.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Packet {
    axes: [u8; 3],
    x: PerRay,
    y: PerRay,
    z: PerRay,
    /// The smaller of the best hit and the end of the ray.
    limit: PerRay,
    t: PerRay,
    b1: PerRay,
    b2: PerRay,
    /// The bits of the ids.
    primitive: PerRay,
}

impl Default for Packet {
    fn default() -> Self {
        Self {
            axes: [0; 3],
            x: ZERO,
            y: ZERO,
            z: ZERO,
            limit: ZERO,
            t: ZERO,
            b1: ZERO,
            b2: ZERO,
            primitive: ZERO,
        }
    }
}

/// The vertices of a block prepared for a packet: per axis of the sheared space, seen from the origin
/// if all rays share it.
pub(super) struct Corners {
    /// Of both triangles of a primitive: `a` by primitive, then `c`.
    shared: [[[f32; BLOCK]; 2]; 3],
    /// By triangle.
    own: [[f32; TRIANGLES]; 3],
}

impl Corners {
    #[inline(always)]
    pub(super) fn new<V: Lanes, const SHARED: bool>(
        block: &Block,
        axes: [u8; 3],
        rays: &PacketRays,
    ) -> Self {
        let mut out = Self {
            shared: [[[0.0; BLOCK]; 2]; 3],
            own: [[0.0; TRIANGLES]; 3],
        };
        // Without closures over arrays: those are not always inlined.
        for (i, axis) in axes.into_iter().enumerate() {
            let mut shared = block.both_corners::<V>(axis);
            let mut own = block.coordinate::<V>(Corner::Own, axis);
            if SHARED {
                let origin = V::splat(rays.first_origin(axis.into()));
                (shared, own) = (shared - origin, own - origin);
            }
            let to = out.shared[i].as_flattened_mut().first_chunk_mut();
            shared.store(to.expect("eight numbers"));
            own.store(&mut out.own[i]);
        }
        out
    }
}

/// What a hit needs of the triangles of a block.
pub(super) struct Planes {
    normal: [[f32; TRIANGLES]; 3],
    /// Of the origin from the plane, times the length of the normal; if all rays share it.
    distance: [f32; TRIANGLES],
    /// Padded; minimum and maximum per axis.
    bounds: [[[f32; TRIANGLES]; 2]; 3],
}

impl Planes {
    #[inline(always)]
    pub(super) fn new<V: Lanes>(block: &Block, axes: [u8; 3], corners: &Corners) -> Self {
        let normal = block.normals::<V>(axes);
        let first = |axis: usize| V::repeat(&corners.shared[axis][0]);
        let distance = normal[0] * first(0) + normal[1] * first(1) + normal[2] * first(2);
        let mut bounds = block.bounds::<V>();
        padded_each(&mut bounds);
        let mut out = Self {
            normal: [[0.0; TRIANGLES]; 3],
            distance: [0.0; TRIANGLES],
            bounds: [[[0.0; TRIANGLES]; 2]; 3],
        };
        distance.store(&mut out.distance);
        // Without closures over arrays: those are not always inlined.
        for axis in 0..3 {
            normal[axis].store(&mut out.normal[axis]);
            bounds[axis][0].store(&mut out.bounds[axis][0]);
            bounds[axis][1].store(&mut out.bounds[axis][1]);
        }
        out
    }
}

/// What the two triangles of a quad have in common for a group of rays: the vertices that they share,
/// sheared, and the edge function of `c` and `a`.
pub(super) struct SharedEdge<V> {
    a: [V; 2],
    c: [V; 2],
    ca: V,
}

impl Packet {
    /// Takes in the rays, which have hit nothing yet; false if they are not longest along one axis.
    #[inline(always)]
    pub(super) fn set<V: Lanes>(&mut self, rays: &PacketRays) -> bool {
        // Of z and of y over x: bits that some and that all groups have.
        let (mut some, mut all) = ([0; 2], [V::ALL; 2]);
        for group in 0..groups::<V>() {
            let size = |axis: usize| rays.direction::<V>(axis, group).abs();
            let (x, y, z) = (size(0), size(1), size(2));
            let longest = [V::bits(z.gt(x) & z.gt(y)), V::bits(y.gt(x))];
            for i in 0..2 {
                some[i] |= longest[i];
                all[i] &= longest[i];
            }
        }
        let z = match (some, all) {
            (_, [z, _]) if z == V::ALL => 2,
            ([0, _], [_, y]) if y == V::ALL => 1,
            ([0, 0], _) => 0,
            _ => return false,
        };
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        self.axes = [x as u8, y as u8, z as u8];
        for group in 0..groups::<V>() {
            let inverse = rays.inverse::<V>(z, group);
            self.x
                .set_group(group, rays.direction::<V>(x, group) * inverse);
            self.y
                .set_group(group, rays.direction::<V>(y, group) * inverse);
            self.z.set_group(group, inverse);
            self.limit.set_group(group, rays.t_max::<V>(group));
            self.t.set_group(group, V::splat(Hit::MISS.t));
            self.b1.set_group(group, V::splat(0.0));
            self.b2.set_group(group, V::splat(0.0));
            let nothing = f32::from_bits(Hit::MISS.primitive);
            self.primitive.set_group(group, V::splat(nothing));
        }
        true
    }

    /// For each ray the parameter beyond which nothing matters any more.
    #[inline(always)]
    pub(super) fn limit(&self) -> &PerRay {
        &self.limit
    }

    /// The axes of the sheared space.
    #[inline(always)]
    pub(super) fn axes(&self) -> [u8; 3] {
        self.axes
    }

    /// The edge that the triangles of the primitive in `place` share, for a group of rays.
    #[inline(always)]
    pub(super) fn shared_edge<V: Lanes, const SHARED: bool>(
        &self,
        rays: &PacketRays,
        corners: &Corners,
        (place, group): (usize, usize),
    ) -> SharedEdge<V> {
        let [x, y, z] = &corners.shared;
        let (a, c) = (
            [x[0][place], y[0][place], z[0][place]],
            [x[1][place], y[1][place], z[1][place]],
        );
        let a = self.sheared::<V, SHARED>(rays, a, group);
        let c = self.sheared::<V, SHARED>(rays, c, group);
        SharedEdge {
            a,
            c,
            ca: c[0] * a[1] - c[1] * a[0],
        }
    }

    /// The same as [`Shear::edges`] for one triangle and a group of rays.
    #[inline(always)]
    pub(super) fn edges<V: Lanes, const SHARED: bool>(
        &self,
        rays: &PacketRays,
        corners: &Corners,
        edge: &SharedEdge<V>,
        (triangle, group): (usize, usize),
    ) -> Edges<V> {
        let own = [0, 1, 2].map(|axis| corners.own[axis][triangle]);
        let own = self.sheared::<V, SHARED>(rays, own, group);
        let (a, c) = (edge.a, edge.c);
        Edges {
            ca: edge.ca,
            own_c: own[0] * c[1] - own[1] * c[0],
            a_own: a[0] * own[1] - a[1] * own[0],
        }
    }

    /// A vertex as a group of rays sees it, sheared. Not a closure: those are not always inlined.
    #[inline(always)]
    fn sheared<V: Lanes, const SHARED: bool>(
        &self,
        rays: &PacketRays,
        vertex: [f32; 3],
        group: usize,
    ) -> [V; 2] {
        let z = self.seen::<V, SHARED>(rays, vertex, 2, group);
        [
            self.seen::<V, SHARED>(rays, vertex, 0, group) - self.x.group::<V>(group) * z,
            self.seen::<V, SHARED>(rays, vertex, 1, group) - self.y.group::<V>(group) * z,
        ]
    }

    /// One coordinate of a vertex, of those in the order of the axes.
    #[inline(always)]
    fn seen<V: Lanes, const SHARED: bool>(
        &self,
        rays: &PacketRays,
        vertex: [f32; 3],
        axis: usize,
        group: usize,
    ) -> V {
        let value = V::splat(vertex[axis]);
        if SHARED {
            return value;
        }
        value - rays.origin(usize::from(self.axes[axis]) % 3, group)
    }

    /// The same as [`Shear::hits`].
    #[inline(always)]
    pub(super) fn hits<V: Lanes, const SHARED: bool>(
        &self,
        rays: &PacketRays,
        (corners, planes): (&Corners, &Planes),
        edges: &Edges<V>,
        (triangle, group): (usize, usize),
    ) -> [V; 3] {
        let normal = [
            V::splat(planes.normal[0][triangle]),
            V::splat(planes.normal[1][triangle]),
            V::splat(planes.normal[2][triangle]),
        ];
        let distance = if SHARED {
            V::splat(planes.distance[triangle])
        } else {
            let first = [0, 1, 2].map(|axis| corners.shared[axis][0][triangle % BLOCK]);
            let at = |axis| self.seen::<V, SHARED>(rays, first, axis, group);
            normal[0] * at(0) + normal[1] * at(1) + normal[2] * at(2)
        };
        let at = |values: &PerRay| values.group::<V>(group);
        let slope = normal[0] * at(&self.x) + normal[1] * at(&self.y) + normal[2];
        let (b1, b2) = if triangle < BLOCK {
            (edges.ca, edges.a_own)
        } else {
            (edges.a_own, edges.ca)
        };
        let inverse = V::splat(1.0) / (edges.own_c + b1 + b2);
        [distance / slope * at(&self.z), b1 * inverse, b2 * inverse]
    }

    /// The same as [`Query::offer`] for the hits of a group with one triangle, where `inside`.
    #[inline(always)]
    pub(super) fn offer<V: Lanes>(
        &mut self,
        rays: &PacketRays,
        [t, b1, b2]: [V; 3],
        inside: V::Mask,
        (planes, primitive, (triangle, group)): (&Planes, u32, (usize, usize)),
    ) {
        let (t_min, t_max) = (rays.t_min::<V>(group), rays.t_max::<V>(group));
        let possible = inside & t.gt(t_min) & t.lt(t_max) & t.le(self.t.group(group));
        if V::bits(possible) == 0 {
            return;
        }
        let (front, meets) = rays.enter::<V, TRIANGLES>(&planes.bounds, triangle, group);
        let t = t.max(front);
        let met = possible & meets & t.lt(t_max);
        self.take([t, b1, b2], met, primitive, group);
    }

    /// Keeps the hits of a group with triangle `primitive` where `met` and better than the best so
    /// far.
    #[inline(always)]
    fn take<V: Lanes>(&mut self, [t, b1, b2]: [V; 3], met: V::Mask, primitive: u32, group: usize) {
        let best = self.t.group::<V>(group);
        let better = met & t.lt(best);
        let equal = V::bits(met & t.eq(best));
        let keep = |old: &mut PerRay, new: V| {
            old.set_group(group, V::select(better, new, old.group(group)));
        };
        let limit = self.limit.group::<V>(group);
        keep(&mut self.limit, t.min(limit));
        keep(&mut self.t, t);
        keep(&mut self.b1, b1);
        keep(&mut self.b2, b2);
        keep(&mut self.primitive, V::splat(f32::from_bits(primitive)));
        if equal != 0 {
            let first = V::N * group;
            self.take_equal((first, equal), primitive, [b1.to_array(), b2.to_array()]);
        }
    }

    /// At equal parameters the smaller id wins.
    #[cold]
    fn take_equal(
        &mut self,
        (first, lanes): (usize, u32),
        primitive: u32,
        [b1, b2]: [[f32; ROW]; 2],
    ) {
        for lane in set_bits(lanes) {
            let i = first + lane;
            let best = self.primitive.of_ray_mut(i);
            if primitive < best.to_bits() {
                *best = f32::from_bits(primitive);
                *self.b1.of_ray_mut(i) = b1[lane];
                *self.b2.of_ray_mut(i) = b2[lane];
            }
        }
    }

    /// The query of ray `i` by itself.
    #[inline(always)]
    pub(super) fn query(&self, i: usize) -> Query {
        let at = |values: &PerRay| values.of_ray(i);
        let hit = Hit {
            t: at(&self.t),
            primitive: at(&self.primitive).to_bits(),
            b1: at(&self.b1),
            b2: at(&self.b2),
        };
        Query::new(
            Shear::of(self.axes, [at(&self.x), at(&self.y), at(&self.z)]),
            hit,
        )
    }

    /// Writes the best hit of each ray.
    #[inline(always)]
    pub(super) fn write_hits(&self, hits: &mut [Hit]) {
        let hits = hits.iter_mut().zip(self.t.all()).zip(self.primitive.all());
        for (((hit, t), primitive), (b1, b2)) in hits.zip(self.b1.all().iter().zip(self.b2.all())) {
            *hit = Hit {
                t: *t,
                primitive: primitive.to_bits(),
                b1: *b1,
                b2: *b2,
            };
        }
    }

    /// Puts the best hit of ray `i` back.
    #[inline(always)]
    pub(super) fn put(&mut self, rays: &PacketRays, i: usize, query: &Query) {
        let (hit, end) = (&query.hit, rays.t_max_of(i));
        *self.limit.of_ray_mut(i) = if hit.t < end { hit.t } else { end };
        *self.t.of_ray_mut(i) = hit.t;
        *self.b1.of_ray_mut(i) = hit.b1;
        *self.b2.of_ray_mut(i) = hit.b2;
        *self.primitive.of_ray_mut(i) = f32::from_bits(hit.primitive);
    }

    /// Lets ray `i` want nothing more.
    #[inline(always)]
    pub(super) fn drop_ray(&mut self, i: usize) {
        *self.limit.of_ray_mut(i) = f32::NEG_INFINITY;
    }

    /// Does something with ray `i` by itself.
    pub(super) fn alone(
        &mut self,
        (rays, prepared): (&[Ray], &PacketRays),
        i: usize,
        test: impl FnOnce(&mut Query, (&Ray, &SlabRay)),
    ) {
        let mut query = self.query(i);
        test(&mut query, (&rays[i], &prepared.slab(i)));
        self.put(prepared, i, &query);
    }
}
