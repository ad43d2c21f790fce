use std::f32::consts::TAU;

use glam::{Vec2, Vec3};

use super::cone::{Cone, height};

/// The most lobes that a cell holds.
pub const LOBES: usize = 8;

/// Spheres at which the rays of a cell are aimed, and how often. Seen from a point each is a cone of
/// directions, evenly spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lobes {
    /// Centres, component by component.
    center: [[f32; LOBES]; 3],
    /// Squared, above 0.
    radius2: [f32; LOBES],
    /// Probabilities, 0 behind the last lobe.
    weight: [f32; LOBES],
    share: f32,
}

/// One of [`Lobes`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LobeSphere {
    /// Centre.
    pub center: Vec3,
    /// Radius squared, above 0.
    pub radius2: f32,
    /// The probability of the lobe.
    pub weight: f32,
}

impl Lobes {
    /// The first [`LOBES`] of `spheres`, chosen in proportion to their weights, all above 0; `share`
    /// below 1 is for [`Self::share`].
    pub fn new(spheres: &[LobeSphere], share: f32) -> Self {
        let spheres = &spheres[..spheres.len().min(LOBES)];
        let total: f32 = spheres.iter().map(|sphere| sphere.weight).sum();
        let mut lobes = Self {
            center: [[0.0; LOBES]; 3],
            radius2: [1.0; LOBES],
            weight: [0.0; LOBES],
            share,
        };
        for (i, sphere) in spheres.iter().enumerate() {
            for (row, value) in lobes.center.iter_mut().zip(sphere.center.to_array()) {
                row[i] = value;
            }
            lobes.radius2[i] = sphere.radius2;
            lobes.weight[i] = sphere.weight / total;
        }
        lobes
    }

    /// The share of the scattered rays that are to go through the lobes, 0 to 1.
    pub fn share(&self) -> f32 {
        self.share
    }

    /// The lobes.
    pub fn spheres(&self) -> impl Iterator<Item = LobeSphere> + '_ {
        let count = self.weight.iter().take_while(|&&w| w > 0.0).count();
        (0..count).map(|i| self.sphere(i))
    }

    fn sphere(&self, i: usize) -> LobeSphere {
        let [x, y, z] = &self.center;
        LobeSphere {
            center: Vec3::new(x[i], y[i], z[i]),
            radius2: self.radius2[i],
            weight: self.weight[i],
        }
    }

    /// A unit direction from `from` through the lobe that `u_lobe` picks; all numbers in [0, 1).
    pub fn sample(&self, from: Vec3, u_lobe: f32, u: Vec2) -> Vec3 {
        let (mut i, mut rest) = (0, u_lobe);
        while i + 1 < LOBES && self.weight[i + 1] > 0.0 && rest >= self.weight[i] {
            rest -= self.weight[i];
            i += 1;
        }
        let sphere = self.sphere(i);
        Cone::new(from, sphere.center, sphere.radius2).sample(u)
    }

    /// The density per steradian of [`Self::sample`] from `from` in the unit direction `wi`.
    ///
    /// The same steps for all lobes, without a branch, so that the compiler makes lanes of them.
    #[inline(always)]
    pub fn pdf(&self, from: Vec3, wi: Vec3) -> f32 {
        let [x, y, z] = &self.center;
        let mut densities = [0.0; LOBES];
        for (i, density) in densities.iter_mut().enumerate() {
            let (x, y, z) = (x[i] - from.x, y[i] - from.y, z[i] - from.z);
            let along = x * wi.x + y * wi.y + z * wi.z;
            // Not from `along`: the sine keeps narrow cones exact.
            let (cx, cy, cz) = (
                y * wi.z - z * wi.y,
                z * wi.x - x * wi.z,
                x * wi.y - y * wi.x,
            );
            let off2 = cx * cx + cy * cy + cz * cz;
            let inside = self.weight[i] / height(x * x + y * y + z * z, self.radius2[i]);
            let is_inside = (along > 0.0) & (off2 <= self.radius2[i]);
            *density = if is_inside { inside } else { 0.0 };
        }
        let [a, b, c, d, e, f, g, h] = densities;
        (((a + b) + (c + d)) + ((e + f) + (g + h))) * (1.0 / TAU)
    }
}
