use super::REACH;
use crate::math::{IntLanes, Lanes, ROW, Ray};

/// Rays that are sorted at once; their numbers are 16 bits.
pub(super) const CHUNK: usize = 2048;

/// The directions that one packet may hold: three longest axes times eight octants.
pub(super) const WAYS: usize = 24;

/// The bin of rays that can meet nothing.
const INVALID: u32 = WAYS as u32;

/// The bin of rays whose numbers are too large or too small for the sweep, or that begin behind
/// their origins.
const ODD: u32 = INVALID + 1;

/// Directions are at least so long along their longest axis, and at most one over it: no product with
/// a distance vanishes.
const SHORTEST: f32 = 1e-10;

/// The numbers of a chunk of rays, by the signs and the longest axis of their directions.
#[derive(Debug)]
pub(super) struct Bins {
    order: [u16; CHUNK],
    /// Where each bin begins, and the end.
    starts: [usize; WAYS + 3],
    /// Per axis where rays start (least and largest), and where they start or end.
    pub(super) origins: [[f32; 2]; 3],
    pub(super) reaches: [[f32; 2]; 3],
}

/// Least and largest of numbers in lanes.
#[derive(Clone, Copy)]
struct Ends<V>(V, V);

impl<V: Lanes> Ends<V> {
    #[inline(always)]
    fn none() -> Self {
        Self(V::splat(f32::INFINITY), V::splat(f32::NEG_INFINITY))
    }

    #[inline(always)]
    fn grow(self, value: V) -> Self {
        Self(self.0.min(value), self.1.max(value))
    }

    #[inline(always)]
    fn fold(self) -> [f32; 2] {
        let (least, largest) = (self.0.to_array(), self.1.to_array());
        let mut ends = [least[0], largest[0]];
        for i in 1..V::N {
            ends = [ends[0].min(least[i]), ends[1].max(largest[i])];
        }
        ends
    }
}

impl Bins {
    /// No rays.
    pub(super) const EMPTY: Self = Self {
        order: [0; CHUNK],
        starts: [0; WAYS + 3],
        origins: [[0.0; 2]; 3],
        reaches: [[0.0; 2]; 3],
    };

    /// Sorts `rays`, at least one and at most [`CHUNK`].
    #[inline(always)]
    pub(super) fn sort<V: Lanes, const ANY: bool>(&mut self, rays: &[Ray]) {
        let mut keys = [INVALID; CHUNK + ROW];
        let mut origins = [Ends::<V>::none(); 3];
        let mut reaches = [Ends::<V>::none(); 3];
        for first in (0..rays.len()).step_by(V::N) {
            let [ox, oy, oz, dx, dy, dz, t_min, t_max] = V::of_first_rays(&rays[first..]);
            let (key, plain) = keys_of([ox, oy, oz], [dx, dy, dz], [t_min, t_max]);
            keys[first..first + V::N].copy_from_slice(&key.to_array()[..V::N]);
            let (origin, direction) = ([ox, oy, oz], [dx, dy, dz]);
            for axis in 0..3 {
                let (o, d) = (origin[axis], direction[axis]);
                let start = |otherwise: f32| V::select(plain, o, V::splat(otherwise));
                let ends = &mut origins[axis];
                *ends = Ends(
                    ends.0.min(start(f32::INFINITY)),
                    ends.1.max(start(f32::NEG_INFINITY)),
                );
                if ANY {
                    let end = V::select(plain, o + d * t_max, V::splat(0.0));
                    // Zero times infinity: as if the ray ended where it starts, and it does not
                    // move along this axis.
                    let end = V::select(end.eq(end), end, o);
                    reaches[axis] = reaches[axis].grow(end);
                }
            }
        }
        for axis in 0..3 {
            self.origins[axis] = origins[axis].fold();
            self.reaches[axis] = reaches[axis].fold();
        }
        self.arrange(&keys[..rays.len()]);
    }

    /// Counting sort.
    #[inline(always)]
    fn arrange(&mut self, keys: &[u32]) {
        let mut counts = [0_u32; 32];
        for key in keys {
            counts[*key as usize % 32] += 1;
        }
        let mut next = [0_u32; 32];
        for i in 1..32 {
            next[i] = next[i - 1] + counts[i - 1];
        }
        for (start, next) in self.starts.iter_mut().zip(&next) {
            *start = *next as usize;
        }
        for (i, key) in keys.iter().enumerate() {
            let place = &mut next[*key as usize % 32];
            self.order[*place as usize % CHUNK] = i as u16;
            *place += 1;
        }
    }

    /// The numbers of the rays that go one way: the longest axis times 8, plus the octant.
    #[inline(always)]
    pub(super) fn way(&self, way: usize) -> &[u16] {
        &self.order[self.starts[way]..self.starts[way + 1]]
    }

    /// Rays that can meet nothing.
    pub(super) fn invalid(&self) -> &[u16] {
        self.way(WAYS)
    }

    /// Rays that are left to the tree.
    pub(super) fn odd(&self) -> &[u16] {
        self.way(WAYS + 1)
    }
}

/// The bins of eight rays, and whether they are neither invalid nor odd.
#[inline(always)]
fn keys_of<V: Lanes>(
    origin: [V; 3],
    direction: [V; 3],
    [t_min, t_max]: [V; 2],
) -> (V::Ints, V::Mask) {
    let zero = V::splat(0.0);
    // The test of [`crate::bvh::SlabRay::new`]: zero, or NaN if anything is infinite or NaN.
    let [ox, oy, oz] = origin;
    let [dx, dy, dz] = direction;
    let nothing =
        ox * zero + oy * zero + oz * zero + dx * zero + dy * zero + dz * zero + t_min * zero;
    let [x, y, z] = [dx.abs(), dy.abs(), dz.abs()];
    let longest = x.max(y).max(z);
    let valid = nothing.eq(zero) & zero.lt(longest) & t_min.lt(t_max);
    let far = ox.abs().max(oy.abs()).max(oz.abs());
    let plain = valid
        & zero.le(t_min)
        & far.le(V::splat(REACH))
        & longest.ge(V::splat(SHORTEST))
        & longest.le(V::splat(1.0 / SHORTEST));
    let int = |value: u32| V::Ints::splat(value);
    let along = V::select_ints(y.gt(x), int(8), int(0));
    let along = V::select_ints(z.gt(x) & z.gt(y), int(16), along);
    let bit = |d: V, bit: u32| V::select_ints(d.lt(zero), int(bit), int(0));
    let way = along | bit(dx, 1) | bit(dy, 2) | bit(dz, 4);
    let other = V::select_ints(valid, int(ODD), int(INVALID));
    (V::select_ints(plain, way, other), plain)
}
