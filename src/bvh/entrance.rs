use super::node::{WIDTH, WideNode};
use super::slab::{FAR_MARGIN, T_FAR, can_meet, inverse};
use crate::math::{LANES, Lanes, Ray};

/// Up to eight rays at the root of a tree, all at once: those that meet nothing below it have their
/// answer, and the others start there.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Entrance {
    /// Rays, 1 to 8.
    count: usize,
    /// A bit for each ray that can meet anything ([`super::SlabRay::new`]).
    valid: u32,
    /// A bit for each of those that meets something below the root.
    go_on: u32,
    /// A byte for each ray, with a bit for each slot whose box it meets.
    meets: u64,
}

impl Entrance {
    /// Looks at the first of `rays`, at least one. The boxes met are those of
    /// [`super::simd::NodeTest::enter`], with the limits that the rays start with.
    #[inline(always)]
    pub(super) fn new<V: Lanes>(root: &WideNode, rays: &[Ray]) -> Self {
        let count = rays.len().min(LANES);
        let [ox, oy, oz, dx, dy, dz, t_min, t_max] = V::of_first_rays(rays);
        let (origin, direction) = ([ox, oy, oz], [dx, dy, dz]);
        let can_meet = can_meet(origin, direction, [t_min, t_max]);
        // Not mapped: a function over an array is not always inlined.
        let inverse = [inverse(dx), inverse(dy), inverse(dz)];
        let t_max = t_max.min(V::splat(T_FAR));
        let (mut meets, mut any) = (0, V::mask_of_bits(0));
        for slot in 0..WIDTH {
            // An empty one has its planes in the wrong order.
            if root.children[slot] == 0 {
                continue;
            }
            let (mut near, mut far) = (t_min, t_max);
            for axis in 0..3 {
                let t = |side: usize| {
                    (V::splat(root.planes[axis][side][slot]) - origin[axis]) * inverse[axis]
                };
                let (a, b) = (t(0), t(1));
                near = near.max(a.min(b));
                far = far.min(a.max(b));
            }
            let met = near.le(far * V::splat(FAR_MARGIN));
            any = any | met;
            meets |= u64::from(V::bits(met) & 0xff) << (8 * slot);
        }
        let valid = V::bits(can_meet) & ((1 << count) - 1);
        Self {
            count,
            valid,
            go_on: V::bits(any) & valid,
            meets: turned(meets),
        }
    }

    /// How many rays it has looked at.
    #[inline(always)]
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// A bit for each ray.
    #[inline(always)]
    pub(super) fn all(&self) -> u32 {
        (1 << self.count) - 1
    }

    /// A bit for each ray that can meet anything.
    #[inline(always)]
    pub(super) fn valid(&self) -> u32 {
        self.valid
    }

    /// A bit for each ray that meets something below the root.
    #[inline(always)]
    pub(super) fn go_on(&self) -> u32 {
        self.go_on
    }

    /// A bit for each slot that ray `lane` meets.
    #[inline(always)]
    pub(super) fn meets(&self, lane: usize) -> u32 {
        (self.meets >> (8 * lane)) as u32 & 0xff
    }
}

/// Eight rows of eight bits, rows and columns exchanged.
///
/// Warren 2013, "Hacker's Delight", section 7-3.
fn turned(mut rows: u64) -> u64 {
    for (by, mask) in [
        (7, 0x00aa_00aa_00aa_00aa),
        (14, 0x0000_cccc_0000_cccc),
        (28, 0x0000_0000_f0f0_f0f0),
    ] {
        let swap = (rows ^ (rows >> by)) & mask;
        rows ^= swap ^ (swap << by);
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bit_i_of_row_j_becomes_bit_j_of_row_i() {
        for (i, j) in (0..64).map(|n| (n / 8, n % 8)) {
            assert_eq!(turned(1 << (8 * j + i)), 1 << (8 * i + j));
        }
    }
}
