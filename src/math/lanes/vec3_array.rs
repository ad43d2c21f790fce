use glam::Vec3;

use super::{Lanes, ROW, Vec3Lanes};

/// Vectors in memory, a row of them, component by component, for steps that take one at a time.
#[derive(Clone, Copy, Debug)]
pub struct Vec3Array([[f32; ROW]; 3]);

impl Vec3Array {
    /// All zero.
    pub const ZERO: Self = Self([[0.0; ROW]; 3]);

    /// The vector in `lane`, below [`ROW`].
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Vec3 {
        let [x, y, z] = &self.0;
        Vec3::new(x[lane], y[lane], z[lane])
    }

    /// Puts `value` in `lane`, below [`ROW`].
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
        Self::new(L::load_row(x), L::load_row(y), L::load_row(z))
    }

    /// To memory.
    #[inline(always)]
    pub fn store(self) -> Vec3Array {
        let mut to = Vec3Array::ZERO;
        let [x, y, z] = &mut to.0;
        self.x.store_row(x);
        self.y.store_row(y);
        self.z.store_row(z);
        to
    }
}
