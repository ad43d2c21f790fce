use glam::Vec3;

use super::Sphere;

/// Everything rays can meet, in the normalised space of the prepared scene.
///
/// Primitive ids count the triangles first, then the spheres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shapes {
    /// Vertices of the triangles.
    pub positions: Vec<Vec3>,
    /// Vertex indices, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// Spheres.
    pub spheres: Vec<Sphere>,
}

impl Shapes {
    /// Number of primitives.
    pub fn len(&self) -> usize {
        self.triangles.len() + self.spheres.len()
    }

    /// True when there is nothing to hit.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The vertices of triangle `triangle`.
    #[inline]
    pub fn vertices(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|i| self.positions[i as usize])
    }

    /// The sphere with primitive id `primitive`, `None` for a triangle.
    pub fn sphere(&self, primitive: u32) -> Option<&Sphere> {
        (primitive as usize)
            .checked_sub(self.triangles.len())
            .and_then(|i| self.spheres.get(i))
    }
}
