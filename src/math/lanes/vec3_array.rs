use glam::Vec3;

use super::{LANES, Lanes, Vec3Lanes};

/// Eight vectors in memory, component by component, for steps that take one at a time.
#[derive(Clone, Copy, Debug)]
pub struct Vec3Array([[f32; LANES]; 3]);

impl Vec3Array {
    /// All zero.
    pub const ZERO: Self = Self([[0.0; LANES]; 3]);

    /// The vector in `lane`, below [`LANES`].
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Vec3 {
        let [x, y, z] = &self.0;
        Vec3::new(x[lane], y[lane], z[lane])
    }

    /// Puts `value` in `lane`, below [`LANES`].
    #[inline(always)]
    pub fn set(&mut self, lane: usize, value: Vec3) {
        let [x, y, z] = &mut self.0;
        x[lane] = value.x;
        y[lane] = value.y;
        z[lane] = value.z;
    }
}

impl<L: Lanes> Vec3Lanes<L> {
    /// From memory.
    #[inline(always)]
    pub fn load(from: &Vec3Array) -> Self {
        let [x, y, z] = &from.0;
        Self::new(L::load(x), L::load(y), L::load(z))
    }

    /// To memory.
    #[inline(always)]
    pub fn store(self) -> Vec3Array {
        let mut to = Vec3Array::ZERO;
        let [x, y, z] = &mut to.0;
        self.x.store(x);
        self.y.store(y);
        self.z.store(z);
        to
    }
}
