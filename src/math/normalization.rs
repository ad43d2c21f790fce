use glam::{DVec3, Vec3};

/// The map from file coordinates to the space in which rays are traced: shift to the origin, then
/// scale by a power of two, so that the scene has about unit size and f32 keeps its precision.
///
/// A power of two changes no mantissa: scenes that differ by 2ᵏ render to the same bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normalization {
    /// The point of the file that becomes the origin.
    pub center: DVec3,
    /// Tracing units per file unit, a power of two.
    pub scale: f64,
}

impl Normalization {
    /// File coordinates as they are.
    pub const IDENTITY: Self = Self {
        center: DVec3::ZERO,
        scale: 1.0,
    };

    /// Brings the box `min`..`max` around the origin, its largest half extent into [½, 1).
    pub fn fit(min: DVec3, max: DVec3) -> Self {
        let half = (max - min).max_element() * 0.5;
        let scale = if half > 0.0 && half.is_finite() {
            (-(half.log2().floor() + 1.0)).exp2()
        } else {
            1.0
        };
        Self {
            center: min * 0.5 + max * 0.5,
            scale,
        }
    }

    /// A point of the file in tracing space, still in double precision.
    pub fn point_to_scene_f64(&self, file: DVec3) -> DVec3 {
        (file - self.center) * self.scale
    }

    /// A point of the file in tracing space.
    pub fn point_to_scene(&self, file: DVec3) -> Vec3 {
        self.point_to_scene_f64(file).as_vec3()
    }

    /// A point of tracing space in file coordinates.
    pub fn point_to_file(&self, scene: Vec3) -> DVec3 {
        scene.as_dvec3() / self.scale + self.center
    }

    /// A length of tracing space in file units.
    pub fn length_to_file(&self, scene: f64) -> f64 {
        scene / self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_of_any_size_come_to_unit_size_by_a_power_of_two() {
        for exponent in -20..20 {
            let size = 1.7 * f64::from(exponent).exp2();
            let n = Normalization::fit(DVec3::splat(100.0), DVec3::splat(100.0 + size));
            assert_eq!(n.scale.log2().fract(), 0.0);
            let half = n.point_to_scene_f64(DVec3::splat(100.0 + size)).x;
            assert!(
                (0.5..1.0).contains(&half) || (half - 0.85).abs() < 1e-6,
                "{half}"
            );
        }
        assert_eq!(Normalization::fit(DVec3::ONE, DVec3::ONE).scale, 1.0);
    }
}
