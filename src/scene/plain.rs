use glam::Vec3;

use super::prepared::{DARK, FLAT, Owner, PreparedMaterial};
use crate::bsdf::Bsdf;
use crate::color::Rgb;
use crate::geometry::{Shapes, Sphere};

/// In place of a reflectance.
const NOT_PLAIN: Rgb = Rgb::NEG_ONE;

/// The surfaces that most paths meet, and whose shading goes eight at a time: diffuse, not black,
/// without emission, not shared by instances. Few and short steps lead from a primitive to what
/// shading needs.
#[derive(Clone, Copy, Debug)]
pub struct PlainSurfaces<'a> {
    pub(super) shapes: &'a Shapes,
    pub(super) owner_of: &'a [u32],
    pub(super) plain: &'a [Rgb],
    pub(super) smooth: &'a [u32],
    pub(super) corner_normals: &'a [[Vec3; 3]],
}

/// A plain surface.
#[derive(Clone, Copy, Debug)]
pub enum PlainShape<'a> {
    /// A triangle: its vertices, and the normals there if it is smooth.
    Triangle([Vec3; 3], Option<&'a [Vec3; 3]>),
    /// A sphere.
    Sphere(&'a Sphere),
}

impl<'a> PlainSurfaces<'a> {
    /// Reflectance and shape of `primitive`; `None` when it is not plain, or not a primitive.
    #[inline(always)]
    pub fn get(&self, primitive: u32) -> Option<(Rgb, PlainShape<'a>)> {
        let index = primitive as usize;
        let reflectance = self.plain[*self.owner_of.get(index)? as usize];
        if reflectance.x < 0.0 {
            return None;
        }
        let shape = match self.shapes.triangles.get(index) {
            Some(corners) => {
                let vertices = corners.map(|i| self.shapes.positions[i as usize]);
                let smooth = self.smooth.get(index).filter(|&&place| place != FLAT);
                let normals = smooth.map(|&place| &self.corner_normals[place as usize]);
                PlainShape::Triangle(vertices, normals)
            }
            None => PlainShape::Sphere(&self.shapes.spheres[index - self.shapes.triangles.len()]),
        };
        Some((reflectance, shape))
    }
}

/// The table [`PlainSurfaces`] looks into.
pub(super) fn plain_reflectances(owners: &[Owner], materials: &[PreparedMaterial]) -> Vec<Rgb> {
    let reflectance = |owner: &Owner| match materials[owner.material as usize].bsdf {
        Bsdf::Diffuse(diffuse)
            if owner.light == DARK
                && diffuse.reflectance != Rgb::ZERO
                && diffuse.reflectance.min_element() >= 0.0 =>
        {
            diffuse.reflectance
        }
        _ => NOT_PLAIN,
    };
    owners.iter().map(reflectance).collect()
}
