use super::super::Hit;
use super::patch::Patch;
use super::{Bounds, VERTICES, Vertices};
use crate::bvh::{FAR_MARGIN, T_FAR};
use crate::math::{IntLanes, Lanes, ROW, Ray};

/// Every vertex of the scene as some rays see it: sheared to where they run along the last axis.
pub(super) type Sheared = [[[f32; ROW]; 2]; VERTICES];

/// Rays of one octant, one a lane, longest along one axis, and the best hits so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Packet<V: Lanes> {
    pub(super) origin: [V; 3],
    pub(super) direction: [V; 3],
    /// One over the direction; finite.
    inverse: [V; 3],
    pub(super) t_min: V,
    pub(super) t_max: V,
    /// As [`super::super::triangle::Shear`].
    shear: [V; 3],
    /// The axes of the sheared space.
    axes: [usize; 3],
    octant: usize,
    pub(super) t: V,
    /// Edge functions of the triangle that was hit: the sum, that of the second vertex, and that of
    /// the third.
    pub(super) det: V,
    pub(super) b1: V,
    pub(super) b2: V,
    /// Ids as numbers, which are small and so exact; infinite for none.
    pub(super) primitive: V,
    /// Lanes with an edge function of zero, and others that the sweep cannot decide.
    pub(super) odd: V::Mask,
}

impl<V: Lanes> Packet<V> {
    /// Prepares rays that go one `way`: the longest axis times 8, plus the octant.
    #[inline(always)]
    pub(super) fn new(rays: &[&Ray; ROW], way: usize) -> Self {
        let [ox, oy, oz, dx, dy, dz, t_min, t_max] = V::of_rays(rays);
        Self::of_lanes([ox, oy, oz], [dx, dy, dz], [t_min, t_max], way)
    }

    /// The same from components.
    #[inline(always)]
    pub(super) fn of_lanes(origin: [V; 3], direction: [V; 3], t: [V; 2], way: usize) -> Self {
        let zero = V::splat(0.0);
        let [x, y, z] = direction;
        let direction = [x + zero, y + zero, z + zero];
        let one_over = |d: V| {
            (V::splat(1.0) / d)
                .min(V::splat(f32::MAX))
                .max(V::splat(-f32::MAX))
        };
        let [x, y, z] = direction;
        let inverse = [one_over(x), one_over(y), one_over(z)];
        let z = way / 8;
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        Self {
            origin,
            direction,
            inverse,
            t_min: t[0],
            t_max: t[1].min(V::splat(T_FAR)),
            shear: [
                direction[axes[0]] * inverse[z],
                direction[axes[1]] * inverse[z],
                inverse[z],
            ],
            axes,
            octant: way % 8,
            t: V::splat(Hit::MISS.t),
            det: V::splat(1.0),
            b1: zero,
            b2: zero,
            primitive: V::splat(f32::INFINITY),
            odd: zero.lt(zero),
        }
    }

    /// Shears the `chosen` vertices; see [`super::super::triangle::Shear::edges`].
    #[inline(always)]
    pub(super) fn shear(&self, vertices: &Vertices, chosen: &[u8], sheared: &mut Sheared) {
        match self.axes[2] {
            0 => self.shear_along::<1, 2, 0>(vertices, chosen, sheared),
            1 => self.shear_along::<2, 0, 1>(vertices, chosen, sheared),
            _ => self.shear_along::<0, 1, 2>(vertices, chosen, sheared),
        }
    }

    #[inline(always)]
    fn shear_along<const X: usize, const Y: usize, const Z: usize>(
        &self,
        vertices: &Vertices,
        chosen: &[u8],
        sheared: &mut Sheared,
    ) {
        let (ox, oy, oz) = (self.origin[X], self.origin[Y], self.origin[Z]);
        let [shear_x, shear_y, _] = self.shear;
        for &number in chosen {
            let vertex = &vertices[usize::from(number)];
            let to = &mut sheared[usize::from(number)];
            let depth = V::splat(vertex[Z]) - oz;
            (V::splat(vertex[X]) - ox - shear_x * depth).store_row(&mut to[0]);
            (V::splat(vertex[Y]) - oy - shear_y * depth).store_row(&mut to[1]);
        }
    }

    /// Tests the triangles of `patch`.
    #[inline(always)]
    pub(super) fn meet<const ANY: bool>(&mut self, patch: &Patch, sheared: &Sheared) {
        let zero = V::splat(0.0);
        // Without closures over arrays: those are not always inlined.
        let [a, b, c, d] = patch.corners;
        let (a, b) = (corner::<V>(sheared, a), corner(sheared, b));
        let c = corner::<V>(sheared, c);
        let (ba, cb, ac) = (edge(b, a), edge(c, b), edge(a, c));
        let on_edge = (ba * cb * ac).eq(zero);
        let in_first = same_sign::<V>(ba, cb, ac);
        let first = turned(patch.triangles[0].turn, [cb, ac, ba]);
        if !patch.is_pair {
            self.odd = self.odd | on_edge;
            if V::bits(in_first) != 0 {
                self.hit::<ANY, false>(patch, [in_first; 2], [first; 2]);
            }
            return;
        }
        let d = corner(sheared, d);
        let (dc, ad, ca) = (edge(d, c), edge(a, d), V::neg(ac));
        let in_second = same_sign::<V>(dc, ad, ca);
        // In both only where rounding folds a flat pair that is seen edge on.
        self.odd = self.odd | on_edge | (dc * ad).eq(zero) | (in_first & in_second);
        let inside = in_first | in_second;
        if V::bits(inside) != 0 {
            let second = turned(patch.triangles[1].turn, [dc, ad, ca]);
            self.hit::<ANY, true>(patch, [inside, in_second], [first, second]);
        }
    }

    /// The lanes that are `inside` the edges of a triangle, and those that are in the second of a
    /// `PAIR`; see [`super::super::triangle::Shear::hits`]. Without a branch that depends on the rays:
    /// rays that part make all of them hard to predict.
    #[inline(always)]
    fn hit<const ANY: bool, const PAIR: bool>(
        &mut self,
        patch: &Patch,
        [inside, in_second]: [V::Mask; 2],
        [first, second]: [[V; 3]; 2],
    ) {
        let [one, two] = &patch.triangles;
        let [x, y, z] = self.axes;
        let pick = |one: V, two: V| {
            if PAIR {
                V::select(in_second, two, one)
            } else {
                one
            }
        };
        let normal = |axis: usize| pick(V::splat(one.normal[axis]), V::splat(two.normal[axis]));
        let corner = |axis: usize| pick(V::splat(one.first[axis]), V::splat(two.first[axis]));
        let (nx, ny, nz) = (normal(x), normal(y), normal(z));
        let distance = nx * (corner(x) - self.origin[x])
            + ny * (corner(y) - self.origin[y])
            + nz * (corner(z) - self.origin[z]);
        let [shear_x, shear_y, shear_z] = self.shear;
        let slope = nx * shear_x + ny * shear_y + nz;
        let t = distance / slope * shear_z;
        let possible = inside & t.gt(self.t_min) & t.lt(self.t_max) & t.le(self.t);
        let (mut front, mut meets) = self.enter(&one.bounds);
        if PAIR && !patch.share_bounds {
            let other = self.enter(&two.bounds);
            front = V::select(in_second, other.0, front);
            meets = V::without(meets, in_second) | (other.1 & in_second);
        }
        let t = t.max(front);
        let met = possible & meets & t.lt(self.t_max);
        let id = V::splat(one.id);
        if ANY {
            // Either id will do.
            self.t = V::select(met, t, self.t);
            self.primitive = V::select(met, id, self.primitive);
            return;
        }
        let id = pick(id, V::splat(two.id));
        let met = met & (t.lt(self.t) | (t.eq(self.t) & id.lt(self.primitive)));
        let [u, v, w] = first;
        let det = pick(u + v + w, second[0] + second[1] + second[2]);
        self.t = V::select(met, t, self.t);
        self.primitive = V::select(met, id, self.primitive);
        self.det = V::select(met, det, self.det);
        self.b1 = V::select(met, pick(v, second[1]), self.b1);
        self.b2 = V::select(met, pick(w, second[2]), self.b2);
    }

    /// The weights of the second and third vertices of the triangles that were hit.
    #[inline(always)]
    pub(super) fn weights(&self) -> [V; 2] {
        let inverse = V::splat(1.0) / self.det;
        [self.b1 * inverse, self.b2 * inverse]
    }

    /// [`crate::bvh::SlabRay::enter`].
    #[inline(always)]
    pub(super) fn enter(&self, bounds: &Bounds) -> (V, V::Mask) {
        let t = |axis: usize, side: usize| {
            let side = (self.octant >> axis & 1) ^ side;
            (V::splat(bounds[axis][side]) - self.origin[axis]) * self.inverse[axis]
        };
        let near = t(0, 0).max(t(1, 0)).max(t(2, 0).max(self.t_min));
        let far = t(0, 1).min(t(1, 1)).min(t(2, 1).min(self.t_max));
        (near, near.le(far * V::splat(FAR_MARGIN)))
    }

    /// Lanes that have hit something.
    #[inline(always)]
    pub(super) fn has_hit(&self) -> V::Mask {
        self.t.lt(V::splat(f32::INFINITY))
    }
}

#[inline(always)]
fn corner<V: Lanes>(sheared: &Sheared, number: u8) -> [V; 2] {
    let [x, y] = &sheared[usize::from(number)];
    [V::load_row(x), V::load_row(y)]
}

/// The edge functions of a triangle in its own order, from those in the order of a patch.
#[inline(always)]
fn turned<V: Lanes>(turn: u8, [a, b, c]: [V; 3]) -> [V; 3] {
    match turn {
        0 => [a, b, c],
        1 => [c, a, b],
        _ => [b, c, a],
    }
}

/// The edge function of two sheared vertices. Changes its sign, and nothing else, with their order.
#[inline(always)]
fn edge<V: Lanes>(p: [V; 2], q: [V; 2]) -> V {
    p[0] * q[1] - p[1] * q[0]
}

/// Where the signs of three numbers other than zero agree.
#[inline(always)]
fn same_sign<V: Lanes>(u: V, v: V, w: V) -> V::Mask {
    let (u, v, w) = (u.to_ints(), v.to_ints(), w.to_ints());
    let differs = ((u ^ v) | (u ^ w)).shr::<31>();
    V::ints_eq(differs, V::Ints::splat(0))
}
