use glam::Vec3;

/// From where a light is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSampleContext {
    /// The point that is lit.
    pub point: Vec3,
    /// Unit normal there, on the side that is lit: light from the other side is of no use and need
    /// not be sampled. Zero when light from all directions counts.
    pub normal: Vec3,
}

impl LightSampleContext {
    /// A point that takes light from all directions.
    pub fn all_around(point: Vec3) -> Self {
        Self {
            point,
            normal: Vec3::ZERO,
        }
    }

    /// The share of light from the unnormalised direction `segment` that counts, times the length of
    /// `segment`: its cosine to the normal, not below 0, or 1 where there is no normal.
    pub(super) fn foreshortened(&self, segment: Vec3, length: f32) -> f32 {
        if self.normal == Vec3::ZERO {
            length
        } else {
            self.normal.dot(segment).max(0.0)
        }
    }
}
