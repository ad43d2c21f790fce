use std::collections::HashMap;
use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::emitters::Emitters;
use super::shading_normals::{NormalRule, has_normal};
use super::{Geometry, Instance, Scene};

/// Whether instances of a mesh share one hierarchy or each become triangles of the scene's own.
///
/// Sharing costs a ray a new start for each instance that it comes near; copying costs memory and
/// time to prepare. The picture is the same up to rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Instancing {
    /// Shared where copies would be many: meshes of at least 256 triangles, whose second and further
    /// copies would add at least 200 000.
    #[default]
    Auto,
    /// Everything is copied.
    Never,
    /// Everything that can be is shared, even what is used once.
    Always,
}

/// Smaller meshes are copied: an instance takes as much memory as a few of their triangles, and
/// rays far more time.
const FEWEST_TRIANGLES: usize = 256;

/// Triangles that sharing a mesh must save: of copies, so many take about 30 megabytes and a tenth
/// of a second.
const SAVED_TRIANGLES: usize = 200_000;

/// A placement that stretches a mesh by more than this in one direction against another is not
/// undone well in single precision.
const LARGEST_STRETCH: f64 = 1e3;

/// Relative difference of lengths and angles below which a placement does not stretch.
const NO_STRETCH: f64 = 1e-6;

/// For each instance of `scene` whether it shares its mesh.
pub(super) fn shared(
    scene: &Scene,
    emitters: &Emitters,
    rule: NormalRule,
    instancing: Instancing,
) -> Vec<bool> {
    if instancing == Instancing::Never {
        return vec![false; scene.instances.len()];
    }
    let mut sharing = Sharing {
        scene,
        emitters,
        rule,
        has_normals: HashMap::new(),
    };
    let instances = scene.instances.iter().enumerate();
    let mut shared: Vec<bool> = instances
        .map(|(i, at)| sharing.is_possible(i, at))
        .collect();
    if instancing == Instancing::Always {
        return shared;
    }
    let geometry = |instance: &Instance| &scene.geometries[instance.geometry];
    let mut copies: HashMap<*const Geometry, usize> = HashMap::new();
    for (instance, _) in scene.instances.iter().zip(&shared).filter(|(_, s)| **s) {
        *copies.entry(Arc::as_ptr(geometry(instance))).or_default() += 1;
    }
    for (instance, shared) in scene.instances.iter().zip(&mut shared) {
        let geometry = geometry(instance);
        *shared = *shared && {
            let triangles = triangle_count(geometry);
            let copies = copies[&Arc::as_ptr(geometry)];
            let saves_enough = (copies - 1) * triangles >= SAVED_TRIANGLES;
            triangles >= FEWEST_TRIANGLES && saves_enough
        };
    }
    shared
}

fn triangle_count(geometry: &Geometry) -> usize {
    match geometry {
        Geometry::Mesh(mesh) => mesh.triangles.len(),
        Geometry::Sphere { .. } => 0,
    }
}

struct Sharing<'a> {
    scene: &'a Scene,
    emitters: &'a Emitters,
    rule: NormalRule,
    /// By geometry: the file gives every normal that is used.
    has_normals: HashMap<usize, bool>,
}

impl Sharing<'_> {
    /// True for a mesh that does not emit (lights sample triangles of the scene's own), whose
    /// placement can be undone, and whose normals turn with it: those that softbox makes up depend
    /// on how the mesh is stretched.
    fn is_possible(&mut self, index: usize, instance: &Instance) -> bool {
        let Geometry::Mesh(mesh) = self.scene.geometries[instance.geometry].as_ref() else {
            return false;
        };
        let slots = 0..instance.materials.len() as u16;
        let emits = |slot| self.emitters.surfaces.contains_key(&(index, slot));
        if mesh.triangles.is_empty() || slots.into_iter().any(emits) {
            return false;
        }
        match stretch(&DMat3::from_mat4(instance.world_from_object)) {
            Stretch::None => true,
            Stretch::TooMuch => false,
            Stretch::Some => {
                self.rule == NormalRule::File
                    && *self
                        .has_normals
                        .entry(instance.geometry)
                        .or_insert_with(|| {
                            let mut corners = mesh.triangles.iter().flat_map(|t| t.corners);
                            corners.all(|corner| has_normal(mesh, corner))
                        })
            }
        }
    }
}

/// How a linear map changes shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stretch {
    /// It turns, mirrors and scales.
    None,
    /// It scales by different factors, or shears.
    Some,
    /// So much that it can hardly be undone, or it is not finite.
    TooMuch,
}

pub(super) fn stretch(linear: &DMat3) -> Stretch {
    let size = |m: &DMat3| {
        (m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()).sqrt()
    };
    // Frobenius norms: at least the condition number.
    let condition = size(linear) * size(&linear.inverse());
    if !(condition.is_finite() && condition <= LARGEST_STRETCH) {
        return Stretch::TooMuch;
    }
    let DMat3 {
        x_axis: x,
        y_axis: y,
        z_axis: z,
    } = *linear;
    let lengths = DVec3::new(x.length_squared(), y.length_squared(), z.length_squared());
    let angles = DVec3::new(x.dot(y), y.dot(z), z.dot(x));
    let most = lengths.max_element();
    let is_similar = most - lengths.min_element() <= NO_STRETCH * most
        && angles.abs().max_element() <= NO_STRETCH * most;
    if is_similar {
        Stretch::None
    } else {
        Stretch::Some
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    #[test]
    fn turning_mirroring_and_scaling_is_no_stretch() {
        let turn = DMat3::from_quat(DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 1.0, 2.0));
        let scaled = |x, y, z| turn * DMat3::from_diagonal(DVec3::new(x, y, z));
        assert_eq!(stretch(&scaled(2e-9, 2e-9, -2e-9)), Stretch::None);
        assert_eq!(stretch(&scaled(1.0, 1.0, 1.001)), Stretch::Some);
        assert_eq!(stretch(&scaled(1.0, 1.0, 1e-4)), Stretch::TooMuch);
        assert_eq!(stretch(&scaled(1.0, 1.0, 0.0)), Stretch::TooMuch);
        assert_eq!(stretch(&scaled(1.0, 1.0, f64::NAN)), Stretch::TooMuch);
        let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.6, 0.8, 0.0), DVec3::Z);
        assert_eq!(stretch(&(turn * shear)), Stretch::Some);
    }
}
