use glam::Vec3;

use super::super::Shapes;
use super::matching::{CHUNK, Turning, quads};
use crate::bvh::map_stretches;
use crate::math::Aabb;

/// For each triangle by how many vertices (0 to 2) it should be turned to the left, so that it and a
/// neighbour can be one primitive of the hierarchy.
///
/// # Panics
/// If a vertex index is out of range.
pub fn quad_turns(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<u8> {
    map_stretches(triangles.len(), CHUNK, |stretch| {
        let triangles = &triangles[stretch];
        let vertices = triangles.iter().map(|of| of.map(|i| positions[i as usize]));
        let boxes: Vec<_> = vertices.map(Aabb::from_points).collect();
        let mut turns = vec![0; triangles.len()];
        for quad in quads(triangles, &boxes, Turning::Allowed) {
            for (triangle, by) in quad.triangles.into_iter().zip(quad.turns) {
                turns[triangle as usize] = by as u8;
            }
        }
        turns
    })
}

impl Shapes {
    /// Turns the triangles as [`quad_turns`] says; which vertex of a triangle comes first changes.
    pub fn turn_to_quads(&mut self) {
        let turns = quad_turns(&self.positions, &self.triangles);
        for (triangle, by) in self.triangles.iter_mut().zip(turns) {
            triangle.rotate_left(by.into());
        }
    }
}
