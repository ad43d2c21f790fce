/// The cheap answer of traversal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Ray parameter; infinite for a miss.
    pub t: f32,
    /// Index of the primitive in its [`super::Shapes`]: triangles first, then spheres.
    pub primitive: u32,
    /// Barycentric weight of the second vertex (triangles), else 0.
    pub b1: f32,
    /// Barycentric weight of the third vertex (triangles), else 0.
    pub b2: f32,
}

impl Hit {
    /// No hit.
    pub const MISS: Self = Self {
        t: f32::INFINITY,
        primitive: u32::MAX,
        b1: 0.0,
        b2: 0.0,
    };

    /// True when nothing was hit.
    pub fn is_miss(&self) -> bool {
        self.primitive == u32::MAX
    }
}
