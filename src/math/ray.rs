use glam::Vec3;

/// A half line `origin + t · direction`, valid for `t` in the open interval (`t_min`, `t_max`).
///
/// The direction is of unit length unless the maker says otherwise (shadow rays use the whole
/// segment as direction, so that `t = 1` is the light). The hit is never stored inside.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Ray {
    /// Start of the ray, in the space of the scene it is traced against.
    pub origin: Vec3,
    /// Direction; need not be of unit length for traversal.
    pub direction: Vec3,
    /// Hits at or before this parameter are ignored.
    pub t_min: f32,
    /// Hits at or beyond this parameter are ignored.
    pub t_max: f32,
}

impl Ray {
    /// A ray without end.
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Self {
            origin,
            direction,
            t_min: 0.0,
            t_max: f32::INFINITY,
        }
    }

    /// The segment from `origin` towards `origin + direction · t_max`.
    pub fn segment(origin: Vec3, direction: Vec3, t_max: f32) -> Self {
        Self {
            origin,
            direction,
            t_min: 0.0,
            t_max,
        }
    }

    /// The point at parameter `t`.
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}
