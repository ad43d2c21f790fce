use super::super::slab::{FAR_MARGIN, SlabRay, T_FAR, can_meet, inverse};
use crate::math::{LANES, Lanes, ROW, Ray};

/// Rays in a packet.
pub const PACKET: usize = 32;

/// A number for each ray of a packet.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct PerRay([[f32; ROW]; PACKET / ROW]);

impl PerRay {
    /// The same number for all rays.
    pub const fn splat(value: f32) -> Self {
        Self([[value; ROW]; PACKET / ROW])
    }

    /// The numbers of all rays.
    #[inline(always)]
    pub fn all(&self) -> &[f32] {
        self.0.as_flattened()
    }

    /// The number of ray `i`.
    #[inline(always)]
    pub fn of_ray(&self, i: usize) -> f32 {
        self.0.as_flattened()[i % PACKET]
    }

    /// The place of the number of ray `i`.
    #[inline(always)]
    pub fn of_ray_mut(&mut self, i: usize) -> &mut f32 {
        &mut self.0.as_flattened_mut()[i % PACKET]
    }

    /// The numbers of a group: as many rays as there are lanes.
    #[inline(always)]
    pub fn group<V: Lanes>(&self, group: usize) -> V {
        if V::N == ROW {
            return V::load_row(&self.0[group % (PACKET / ROW)]);
        }
        let (halves, _) = self.0.as_flattened().as_chunks();
        V::load(&halves[group % (PACKET / LANES)])
    }

    /// Writes the numbers of a group.
    #[inline(always)]
    pub fn set_group<V: Lanes>(&mut self, group: usize, values: V) {
        if V::N == ROW {
            return values.store_row(&mut self.0[group % (PACKET / ROW)]);
        }
        let (halves, _) = self.0.as_flattened_mut().as_chunks_mut();
        values.store(&mut halves[group % (PACKET / LANES)]);
    }
}

/// Groups in a packet.
#[inline(always)]
pub const fn groups<V: Lanes>() -> usize {
    PACKET / V::N
}

/// The rays of a packet side by side, prepared for box tests: all valid, all in one octant. The
/// numbers are those of [`SlabRay`].
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct PacketRays {
    /// Per axis.
    pub(super) origin: [PerRay; 3],
    /// Per axis, with +0 for −0.
    direction: [PerRay; 3],
    /// One over the direction, finite.
    pub(super) inverse: [PerRay; 3],
    pub(super) t_min: PerRay,
    /// At most [`T_FAR`].
    t_max: PerRay,
    pub(super) octant: u32,
}

impl PacketRays {
    /// Room for a packet.
    pub(super) const EMPTY: Self = Self {
        origin: [PerRay::splat(0.0); 3],
        direction: [PerRay::splat(0.0); 3],
        inverse: [PerRay::splat(0.0); 3],
        t_min: PerRay::splat(0.0),
        t_max: PerRay::splat(0.0),
        octant: 0,
    };

    /// Takes in `rays`; false if one of them can meet nothing ([`SlabRay::new`]) or they do not agree
    /// in the signs of their directions.
    #[inline(always)]
    pub(super) fn set<V: Lanes>(&mut self, rays: &[Ray; PACKET]) -> bool {
        let mut is_valid = true;
        let mut is_one = true;
        let mut signs = [0; 3];
        for group in 0..groups::<V>() {
            let numbers = V::of_first_rays(&rays[group * V::N..]);
            let mut negative = [0; 3];
            is_valid &= self.prepare::<V>(group, numbers, &mut negative);
            if group == 0 {
                signs = [negative[0] & 1, negative[1] & 1, negative[2] & 1];
            }
            is_one &= negative == [signs[0] * V::ALL, signs[1] * V::ALL, signs[2] * V::ALL];
        }
        self.octant = signs[0] | signs[1] << 1 | signs[2] << 2;
        is_valid && is_one
    }

    /// Takes in the numbers of the rays of one group, and makes what [`SlabRay::new`] makes of them; a
    /// bit in `negative` for each ray whose direction is negative on that axis. False if a ray can meet
    /// nothing.
    #[inline(always)]
    fn prepare<V: Lanes>(
        &mut self,
        group: usize,
        [ox, oy, oz, dx, dy, dz, t_min, t_max]: [V; 8],
        negative: &mut [u32; 3],
    ) -> bool {
        let zero = V::splat(0.0);
        let (origin, direction) = ([ox, oy, oz], [dx, dy, dz]);
        let is_valid = V::bits(can_meet(origin, direction, [t_min, t_max])) == V::ALL;
        for (axis, negative) in negative.iter_mut().enumerate() {
            let direction = direction[axis] + zero;
            self.origin[axis].set_group(group, origin[axis]);
            self.direction[axis].set_group(group, direction);
            self.inverse[axis].set_group(group, inverse(direction));
            *negative = V::bits(direction.lt(zero));
        }
        self.t_min.set_group(group, t_min);
        self.t_max.set_group(group, t_max.min(V::splat(T_FAR)));
        is_valid
    }

    /// True when all rays start at one point.
    #[inline(always)]
    pub(super) fn share_origin<V: Lanes>(&self) -> bool {
        let mut same = V::splat(0.0).eq(V::splat(0.0));
        for axis in 0..3 {
            let first = V::splat(self.first_origin(axis));
            for group in 0..groups::<V>() {
                same = same & first.eq(self.origin(axis, group));
            }
        }
        V::bits(same) == V::ALL
    }

    /// Ray `i` by itself.
    #[inline(always)]
    pub fn slab(&self, i: usize) -> SlabRay {
        let at = |values: &PerRay| values.of_ray(i);
        SlabRay {
            origin: [
                at(&self.origin[0]),
                at(&self.origin[1]),
                at(&self.origin[2]),
                at(&self.t_min),
            ],
            inverse: [
                at(&self.inverse[0]),
                at(&self.inverse[1]),
                at(&self.inverse[2]),
                at(&self.t_max),
            ],
            octant: self.octant,
            near: SlabRay::near_planes(self.octant),
        }
    }

    /// Coordinate `axis` of the origin of the first ray.
    #[inline(always)]
    pub fn first_origin(&self, axis: usize) -> f32 {
        self.origin[axis].of_ray(0)
    }

    /// Coordinate `axis` of the origins of a group.
    #[inline(always)]
    pub fn origin<V: Lanes>(&self, axis: usize, group: usize) -> V {
        self.origin[axis].group(group)
    }

    /// Component `axis` of the directions of a group, with +0 for −0.
    #[inline(always)]
    pub fn direction<V: Lanes>(&self, axis: usize, group: usize) -> V {
        self.direction[axis].group(group)
    }

    /// One over the directions, as [`SlabRay::inverse_direction`].
    #[inline(always)]
    pub fn inverse<V: Lanes>(&self, axis: usize, group: usize) -> V {
        self.inverse[axis].group(group)
    }

    /// Starts of the valid intervals.
    #[inline(always)]
    pub fn t_min<V: Lanes>(&self, group: usize) -> V {
        self.t_min.group(group)
    }

    /// Ends of the valid intervals, at most [`T_FAR`].
    #[inline(always)]
    pub fn t_max<V: Lanes>(&self, group: usize) -> V {
        self.t_max.group(group)
    }

    /// End of the valid interval of ray `i`.
    #[inline(always)]
    pub fn t_max_of(&self, i: usize) -> f32 {
        self.t_max.of_ray(i)
    }

    /// [`SlabRay::enter`] for the rays of a group and one box, which must not be empty: minimum and
    /// maximum per axis.
    #[inline(always)]
    pub fn enter<V: Lanes, const N: usize>(
        &self,
        boxes: &[[[f32; N]; 2]; 3],
        which: usize,
        group: usize,
    ) -> (V, V::Mask) {
        let t = |axis: usize, side: u32| {
            let side = (self.octant >> axis & 1) ^ side;
            (V::splat(boxes[axis][side as usize & 1][which]) - self.origin(axis, group))
                * self.inverse(axis, group)
        };
        let near = t(0, 0).max(t(1, 0)).max(t(2, 0).max(self.t_min(group)));
        let far = t(0, 1).min(t(1, 1)).min(t(2, 1).min(self.t_max(group)));
        let far = far * V::splat(FAR_MARGIN);
        (near, near.le(far))
    }
}
