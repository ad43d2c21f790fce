use glam::Vec3;

use crate::math::Aabb;

/// Where a part of a light is, how bright it is, and in which directions it shines at all: around
/// `axis` there are normals up to the angle θₒ, and each shines up to θₑ around itself.
///
/// Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting",
/// section 4.1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EmissionBounds {
    /// A sphere around it.
    pub(super) center: Vec3,
    pub(super) radius: f32,
    /// A box around it.
    pub(super) aabb: Aabb,
    /// Unit.
    pub(super) axis: Vec3,
    /// cos θₒ.
    pub(super) cos_normals: f32,
    /// cos θₑ.
    pub(super) cos_emission: f32,
    /// The directions against the axis count too.
    pub(super) two_sided: bool,
    /// Luminance of the radiant intensity along the axis.
    pub(super) intensity: f32,
}

impl EmissionBounds {
    /// A flat part of these corners; `None` when it sends out nothing.
    pub(super) fn flat(
        corners: &[Vec3],
        normal: Vec3,
        intensity: f32,
        two_sided: bool,
    ) -> Option<Self> {
        let aabb = Aabb::from_points(corners.iter().copied());
        let center = aabb.center();
        let radius = corners
            .iter()
            .map(|c| c.distance(center))
            .fold(0.0, f32::max);
        Self {
            center,
            radius,
            aabb,
            axis: normal,
            cos_normals: 1.0,
            cos_emission: 0.0,
            two_sided,
            intensity,
        }
        .usable()
    }

    /// What shines in all directions, from inside a sphere.
    pub(super) fn round(center: Vec3, radius: f32, intensity: f32) -> Option<Self> {
        Self {
            center,
            radius,
            aabb: Aabb {
                min: center - radius,
                max: center + radius,
            },
            axis: Vec3::Y,
            cos_normals: -1.0,
            cos_emission: 0.0,
            two_sided: false,
            intensity,
        }
        .usable()
    }

    /// A point that shines into the cone around `axis` of this cosine.
    pub(super) fn cone(
        position: Vec3,
        axis: Vec3,
        cos_half_angle: f32,
        intensity: f32,
    ) -> Option<Self> {
        Self {
            axis,
            cos_normals: 1.0,
            cos_emission: cos_half_angle.clamp(0.0, 1.0),
            ..Self::round(position, 0.0, intensity)?
        }
        .usable()
    }

    /// `None` when it is dark or at no place.
    fn usable(self) -> Option<Self> {
        let is_bright = self.intensity.is_finite() && self.intensity > 0.0;
        let is_placed = self.center.is_finite() && self.radius.is_finite();
        (is_bright && is_placed && self.axis.is_finite()).then_some(self)
    }
}
