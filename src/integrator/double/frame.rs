use glam::DVec3;

/// An orthonormal right-handed basis around a unit vector `z`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    x: DVec3,
    y: DVec3,
    z: DVec3,
}

impl Frame {
    /// Duff et al. 2017, "Building an Orthonormal Basis, Revisited": the tangents must be those of
    /// [`crate::math::Frame`], or the paths would part.
    pub(super) fn from_normal(z: DVec3) -> Self {
        let sign = 1.0_f64.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let y = DVec3::new(z.x * z.y * a, sign + z.y * z.y * a, -z.y);
        Self {
            x: y.cross(z),
            y,
            z,
        }
    }

    /// A world direction expressed in this frame.
    pub(super) fn to_local(self, world: DVec3) -> DVec3 {
        DVec3::new(self.x.dot(world), self.y.dot(world), self.z.dot(world))
    }

    /// A direction of this frame expressed in the world.
    pub(super) fn to_world(self, local: DVec3) -> DVec3 {
        self.x * local.x + self.y * local.y + self.z * local.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math;

    #[test]
    fn tangents_are_those_of_single_precision() {
        for i in 0..1000 {
            let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / 1000.0;
            let (sin, cos) = (f64::from(i) * 2.399_963).sin_cos();
            let n = DVec3::new(cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt(), z);
            let (ours, theirs) = (Frame::from_normal(n), math::Frame::from_normal(n.as_vec3()));
            for (a, b) in [(ours.x, theirs.x), (ours.y, theirs.y), (ours.z, theirs.z)] {
                assert!((a - b.as_dvec3()).length() < 1e-6, "{n}: {a} {b}");
            }
            let v = DVec3::new(0.3, -0.4, 0.5);
            assert!((ours.to_world(ours.to_local(v)) - v).length() < 1e-14);
        }
    }
}
