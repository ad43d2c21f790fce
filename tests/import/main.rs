//! What the COLLADA reader makes of each feature of the format.

mod appearance;
#[path = "../collada_text/mod.rs"]
mod collada_text;
mod files;
mod geometry;
mod placement;

use collada_text::{PLACE, document, load_bytes, square};
use softbox::geometry::Mesh;
use softbox::io::{Loaded, Severity};
use softbox::scene::{Geometry, Scene};

fn load(text: &str) -> Loaded {
    load_bytes(text.as_bytes()).expect("a readable scene")
}

/// The mesh of the first geometry of a scene with one square of those primitives.
fn mesh_of(primitives: &str) -> (Mesh, Loaded) {
    let loaded = load(&document(&square(primitives), PLACE));
    (first_mesh(&loaded.scene).clone(), loaded)
}

fn first_mesh(scene: &Scene) -> &Mesh {
    match scene.geometries[0].as_ref() {
        Geometry::Mesh(mesh) => mesh,
        Geometry::Sphere { .. } => panic!("a mesh was expected"),
    }
}

/// Area along +z of all triangles; those wound the other way count as negative.
fn area(mesh: &Mesh) -> f64 {
    let triangles = mesh.triangles.iter();
    let areas = triangles.map(|t| {
        let [a, b, c] = t
            .corners
            .map(|corner| mesh.positions[corner.position as usize]);
        0.5 * (b - a).cross(c - a).z
    });
    areas.sum()
}

fn indices(mesh: &Mesh) -> Vec<[u32; 3]> {
    let triangles = mesh.triangles.iter();
    triangles.map(|t| t.corners.map(|c| c.position)).collect()
}

fn faults(loaded: &Loaded) -> Vec<String> {
    let notes = loaded.report.notes.iter();
    notes
        .filter(|note| note.severity >= Severity::Dropped)
        .map(ToString::to_string)
        .collect()
}

fn has_note(loaded: &Loaded, severity: Severity, part: &str) -> bool {
    let mut notes = loaded.report.notes.iter();
    notes.any(|note| note.severity == severity && note.message.contains(part))
}
