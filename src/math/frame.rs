use glam::Vec3;

/// An orthonormal right-handed basis whose z axis is a surface normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// First tangent.
    pub x: Vec3,
    /// Second tangent.
    pub y: Vec3,
    /// The normal.
    pub z: Vec3,
}

impl Frame {
    /// The frame around the unit vector `z`.
    ///
    /// Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3.
    pub fn from_normal(z: Vec3) -> Self {
        let sign = 1.0_f32.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        Self {
            x: Vec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x),
            y: Vec3::new(b, sign + z.y * z.y * a, -z.y),
            z,
        }
    }

    /// A world direction expressed in this frame.
    pub fn to_local(&self, world: Vec3) -> Vec3 {
        Vec3::new(self.x.dot(world), self.y.dot(world), self.z.dot(world))
    }

    /// A direction of this frame expressed in the world.
    pub fn to_world(&self, local: Vec3) -> Vec3 {
        self.x * local.x + self.y * local.y + self.z * local.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Test G15 of the stress list: poles, near poles, and a spiral over the sphere.
    #[test]
    fn frames_are_orthonormal_right_handed_and_finite() {
        let spiral = (0..100_000).map(|i| {
            let z = 1.0 - 2.0 * (i as f32 + 0.5) / 100_000.0;
            let phi = i as f32 * 2.399_963;
            let r = (1.0 - z * z).max(0.0).sqrt();
            Vec3::new(r * phi.cos(), r * phi.sin(), z).normalize()
        });
        let poles = [1.0_f32, -1.0].into_iter().flat_map(|s| {
            [0.0_f32, 1e-8, 1e-6, 1e-4, -1e-7]
                .into_iter()
                .map(move |d| Vec3::new(d, -d, s).normalize())
        });
        for n in spiral.chain(poles) {
            let f = Frame::from_normal(n);
            assert!(f.x.is_finite() && f.y.is_finite());
            for (a, b) in [(f.x, f.y), (f.y, f.z), (f.z, f.x)] {
                assert!(a.dot(b).abs() < 4e-7, "{n} {a} {b}");
            }
            assert!((f.x.cross(f.y) - f.z).length() < 1e-6);
            assert!(
                (f.to_world(f.to_local(Vec3::new(0.3, -0.4, 0.5))) - Vec3::new(0.3, -0.4, 0.5))
                    .length()
                    < 1e-6
            );
        }
    }
}
