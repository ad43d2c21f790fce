//! Meshes: sources and primitives to triangles.

mod builder;
mod faults;
mod inputs;
mod primitives;

use roxmltree::Node;

use super::polygon::Triangulator;
use super::xml::{Xml, child, course_technique, name_of};
use super::{numbers, transform};
use crate::geometry::Mesh;
use crate::io::report::{Notes, Severity};
use crate::scene::Geometry;
use builder::MeshBuilder;

/// A geometry and the material symbol of each of its slots.
pub(super) struct ReadGeometry {
    pub(super) geometry: Geometry,
    /// One per material slot; `None` where the file names no material.
    pub(super) symbols: Vec<Option<String>>,
}

/// Reads a `<geometry>`: the course's analytic sphere, or a mesh. `None`, with a note, when nothing
/// in it can be seen.
pub(super) fn read_geometry(
    xml: &Xml<'_, '_>,
    notes: &mut Notes,
    triangulator: &mut Triangulator,
    node: Node<'_, '_>,
) -> Option<ReadGeometry> {
    if let Some(sphere) = course_technique(node).and_then(|block| child(block, "sphere")) {
        return read_sphere(xml, notes, node, sphere);
    }
    let Some(mesh) = child(node, "mesh").or_else(|| child(node, "convex_mesh")) else {
        let message = "the geometry is no mesh and no sphere (splines and such are not read); it was left out";
        xml.note(notes, Severity::Dropped, node, message);
        return None;
    };
    let mut builder = MeshBuilder::new(xml, notes, triangulator);
    primitives::read_all(&mut builder, mesh);
    let (triangles, symbols) = builder.finish();
    if triangles.triangles.is_empty() {
        let message = "the mesh has no usable faces; it was left out";
        xml.note(notes, Severity::Warning, node, message);
        return None;
    }
    Some(ReadGeometry {
        geometry: Geometry::Mesh(Mesh {
            name: name_of(node),
            ..triangles
        }),
        symbols,
    })
}

fn read_sphere(
    xml: &Xml<'_, '_>,
    notes: &mut Notes,
    node: Node<'_, '_>,
    sphere: Node<'_, '_>,
) -> Option<ReadGeometry> {
    let radius = child(sphere, "radius").and_then(numbers::scalar);
    let Some(radius) = radius.filter(|radius| *radius > 0.0 && *radius <= transform::LARGEST)
    else {
        let message = "the sphere has no positive radius; it was left out";
        xml.note(notes, Severity::Warning, node, message);
        return None;
    };
    Some(ReadGeometry {
        geometry: Geometry::Sphere {
            name: name_of(node),
            radius,
        },
        symbols: vec![None],
    })
}
