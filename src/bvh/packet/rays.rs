use super::super::slab::{FAR_MARGIN, SlabRay, T_FAR, can_meet, inverse};
use super::super::tree::BLOCK;
use crate::math::{LANES, Lanes, Ray};

/// Groups of eight rays in a packet.
pub const GROUPS: usize = 4;

/// Rays in a packet.
pub const PACKET: usize = GROUPS * LANES;

/// A number for each ray of a packet.
pub type PerRay = [[f32; LANES]; GROUPS];

/// The number of ray `i`.
#[inline(always)]
pub fn of_ray(values: &PerRay, i: usize) -> f32 {
    values.as_flattened()[i % PACKET]
}

/// The place of the number of ray `i`.
#[inline(always)]
pub fn of_ray_mut(values: &mut PerRay, i: usize) -> &mut f32 {
    &mut values.as_flattened_mut()[i % PACKET]
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
        origin: [[[0.0; LANES]; GROUPS]; 3],
        direction: [[[0.0; LANES]; GROUPS]; 3],
        inverse: [[[0.0; LANES]; GROUPS]; 3],
        t_min: [[0.0; LANES]; GROUPS],
        t_max: [[0.0; LANES]; GROUPS],
        octant: 0,
    };

    /// Takes in `rays`; false if one of them can meet nothing ([`SlabRay::new`]) or they do not agree
    /// in the signs of their directions.
    #[inline(always)]
    pub(super) fn set<V: Lanes>(&mut self, rays: &[Ray; PACKET]) -> bool {
        let mut is_valid = true;
        let mut negative = [[0; 3]; GROUPS];
        for (group, negative) in negative.iter_mut().enumerate() {
            let numbers = V::of_first_rays(&rays[group * LANES..]);
            is_valid &= self.prepare::<V>(group, numbers, negative);
        }
        let first = [negative[0][0] & 1, negative[0][1] & 1, negative[0][2] & 1];
        self.octant = first[0] | first[1] << 1 | first[2] << 2;
        let all = [first[0] * 0xff, first[1] * 0xff, first[2] * 0xff];
        is_valid && negative.iter().all(|negative| *negative == all)
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
        let is_valid = V::bits(can_meet(origin, direction, [t_min, t_max])) == 0xff;
        for (axis, negative) in negative.iter_mut().enumerate() {
            let direction = direction[axis] + zero;
            origin[axis].store(&mut self.origin[axis][group]);
            direction.store(&mut self.direction[axis][group]);
            inverse(direction).store(&mut self.inverse[axis][group]);
            *negative = V::bits(direction.lt(zero));
        }
        t_min.store(&mut self.t_min[group]);
        t_max.min(V::splat(T_FAR)).store(&mut self.t_max[group]);
        is_valid
    }

    /// True when all rays start at one point.
    #[inline(always)]
    pub(super) fn share_origin<V: Lanes>(&self) -> bool {
        let mut same = V::splat(0.0).eq(V::splat(0.0));
        for axis in 0..3 {
            let first = V::splat(self.origin[axis][0][0]);
            for group in 0..GROUPS {
                same = same & first.eq(self.origin(axis, group));
            }
        }
        V::bits(same) == 0xff
    }

    /// Ray `i` by itself.
    #[inline(always)]
    pub fn slab(&self, i: usize) -> SlabRay {
        let at = |values: &PerRay| of_ray(values, i);
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
        self.origin[axis][0][0]
    }

    /// Coordinate `axis` of the origins of a group.
    #[inline(always)]
    pub fn origin<V: Lanes>(&self, axis: usize, group: usize) -> V {
        V::load(&self.origin[axis][group])
    }

    /// Component `axis` of the directions of a group, with +0 for −0.
    #[inline(always)]
    pub fn direction<V: Lanes>(&self, axis: usize, group: usize) -> V {
        V::load(&self.direction[axis][group])
    }

    /// One over the directions, as [`SlabRay::inverse_direction`].
    #[inline(always)]
    pub fn inverse<V: Lanes>(&self, axis: usize, group: usize) -> V {
        V::load(&self.inverse[axis][group])
    }

    /// Starts of the valid intervals.
    #[inline(always)]
    pub fn t_min<V: Lanes>(&self, group: usize) -> V {
        V::load(&self.t_min[group])
    }

    /// Ends of the valid intervals, at most [`T_FAR`].
    #[inline(always)]
    pub fn t_max<V: Lanes>(&self, group: usize) -> V {
        V::load(&self.t_max[group])
    }

    /// End of the valid interval of ray `i`.
    #[inline(always)]
    pub fn t_max_of(&self, i: usize) -> f32 {
        of_ray(&self.t_max, i)
    }

    /// [`SlabRay::enter`] for the rays of a group and one box, which must not be empty: minimum and
    /// maximum per axis.
    #[inline(always)]
    pub fn enter<V: Lanes>(
        &self,
        boxes: &[[[f32; BLOCK]; 2]; 3],
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
