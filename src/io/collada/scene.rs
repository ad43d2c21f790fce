use std::collections::HashMap;
use std::ffi::OsStr;
use std::sync::Arc;

use glam::DMat4;
use roxmltree::{Node, NodeId};

use super::binding::Materials;
use super::mesh::{ReadGeometry, read_geometry};
use super::nodes::{Placement, place_all};
use super::numbers;
use super::polygon::Triangulator;
use super::transform::world_from_file;
use super::values::light_color;
use super::xml::{Xml, at_path, child, children, is_course_technique};
use crate::color::Rgb;
use crate::io::progress::{LoadStage, Reporter};
use crate::io::report::{ImportReport, Notes, ReadCounts, Severity};
use crate::io::{ImportError, Loaded};
use crate::scene::{Dialect, Environment, Geometry, Instance, Scene, UpAxis};

/// Builds the scene from a document; `counts` is completed.
pub(super) fn build_scene(
    xml: &Xml<'_, '_>,
    mut notes: Notes,
    reporter: &mut Reporter<'_>,
    counts: ReadCounts,
) -> Result<Loaded, ImportError> {
    let path = reporter.path;
    let mut scene = Scene {
        name: path
            .file_stem()
            .map(OsStr::to_string_lossy)
            .unwrap_or_default()
            .into_owned(),
        path: Some(path.to_owned()),
        up_axis: read_up_axis(xml, &mut notes),
        metres_per_unit: read_unit(xml, &mut notes),
        ..Scene::default()
    };
    if xml.root.descendants().any(is_course_technique) {
        scene.dialect = Dialect::Course;
    }
    let visual_scene = find_visual_scene(xml, &mut notes, reporter)?;
    reporter.at(LoadStage::Nodes, 0.0)?;
    let root = world_from_file(scene.up_axis);
    let placed = place_all(xml, &mut notes, reporter, visual_scene, root)?;
    reporter.at(LoadStage::Nodes, 1.0)?;
    scene.environment = Environment {
        ambient: placed.ambient,
        sky: read_sky(xml, &mut notes, visual_scene),
        ..Environment::default()
    };
    scene.lights = placed.lights;
    scene.cameras = placed.cameras;
    let geometries = read_geometries(xml, &mut notes, reporter, &placed.geometry)?;
    instantiate(&mut scene, xml, &mut notes, &placed.geometry, geometries);
    reporter.at(LoadStage::Materials, 1.0)?;
    note_absences(xml, &mut notes, &scene);
    let read = complete_counts(counts, &scene, placed.nodes);
    let notes = notes.finish();
    Ok(Loaded {
        scene,
        report: ImportReport { read, notes },
    })
}

fn read_up_axis(xml: &Xml<'_, '_>, notes: &mut Notes) -> UpAxis {
    let declared = at_path(xml.root, &["asset", "up_axis"]);
    let Some(element) = declared else {
        let message = "the file has no <up_axis>; Y_UP was taken";
        xml.note(notes, Severity::Guessed, xml.root, message);
        return UpAxis::Y;
    };
    match numbers::words(element).next() {
        Some("X_UP") => UpAxis::X,
        Some("Y_UP") => UpAxis::Y,
        Some("Z_UP") => UpAxis::Z,
        _ => {
            let message = "<up_axis> is none of X_UP, Y_UP, Z_UP; Y_UP was taken";
            xml.note(notes, Severity::Warning, element, message);
            UpAxis::Y
        }
    }
}

fn read_unit(xml: &Xml<'_, '_>, notes: &mut Notes) -> f64 {
    let unit = at_path(xml.root, &["asset", "unit"]);
    let Some((unit, text)) = unit.and_then(|unit| Some((unit, unit.attribute("meter")?))) else {
        return 1.0;
    };
    let metres = text.trim().parse::<f64>().ok();
    metres
        .filter(|metres| metres.is_finite() && *metres > 0.0)
        .unwrap_or_else(|| {
            let message = "the unit is no positive number of metres; 1 was taken";
            xml.note(notes, Severity::Warning, unit, message);
            1.0
        })
}

fn find_visual_scene<'a, 'input>(
    xml: &Xml<'a, 'input>,
    notes: &mut Notes,
    reporter: &Reporter<'_>,
) -> Result<Node<'a, 'input>, ImportError> {
    let instance = at_path(xml.root, &["scene", "instance_visual_scene"]);
    let named = instance.and_then(|instance| xml.follow(notes, instance, "url", "visual_scene"));
    if let Some(named) = named {
        return Ok(named);
    }
    let first = children(xml.root, "library_visual_scenes")
        .find_map(|library| child(library, "visual_scene"));
    let Some(first) = first else {
        return Err(ImportError::NoVisualScene {
            path: reporter.path.to_owned(),
        });
    };
    let message = "<scene> names no visual scene; the first one was taken";
    xml.note(notes, Severity::Guessed, first, message);
    Ok(first)
}

/// Radiance of the whole sphere: profile CGL_ENV in an `<extra>` of the visual scene.
fn read_sky(xml: &Xml<'_, '_>, notes: &mut Notes, visual_scene: Node<'_, '_>) -> Rgb {
    let mut sky = Rgb::ZERO;
    for extra in children(visual_scene, "extra") {
        for technique in children(extra, "technique") {
            if technique.attribute("profile") != Some("CGL_ENV") {
                continue;
            }
            if let Some(radiance) = child(technique, "radiance") {
                sky += light_color(xml, notes, radiance, Rgb::ZERO);
            }
        }
    }
    sky
}

type Geometries = HashMap<NodeId, Option<ReadGeometry>>;

/// Reads each geometry that is placed, once.
fn read_geometries(
    xml: &Xml<'_, '_>,
    notes: &mut Notes,
    reporter: &mut Reporter<'_>,
    placements: &[Placement<'_, '_>],
) -> Result<Geometries, ImportError> {
    let mut wanted: Vec<Node<'_, '_>> = Vec::new();
    let mut found = Geometries::new();
    for placement in placements {
        if found.insert(placement.geometry.id(), None).is_none() {
            wanted.push(placement.geometry);
        }
    }
    let total: usize = wanted.iter().map(|node| node.range().len()).sum();
    let mut triangulator = Triangulator::default();
    let mut done = 0;
    for node in wanted {
        reporter.at(LoadStage::Geometry, done as f32 / total.max(1) as f32)?;
        let geometry = read_geometry(xml, notes, &mut triangulator, node);
        found.insert(node.id(), geometry);
        done += node.range().len();
    }
    reporter.at(LoadStage::Geometry, 1.0)?;
    Ok(found)
}

/// Turns placements into instances with materials.
fn instantiate(
    scene: &mut Scene,
    xml: &Xml<'_, '_>,
    notes: &mut Notes,
    placements: &[Placement<'_, '_>],
    mut geometries: Geometries,
) {
    let mut materials = Materials::default();
    let mut known: HashMap<NodeId, (usize, Vec<Option<String>>)> = HashMap::new();
    for placement in placements {
        let id = placement.geometry.id();
        if let Some(read) = geometries.remove(&id).flatten() {
            known.insert(id, (scene.geometries.len(), read.symbols));
            scene.geometries.push(Arc::new(read.geometry));
        }
        let Some((geometry, symbols)) = known.get(&id) else {
            continue;
        };
        let is_sphere = matches!(*scene.geometries[*geometry], Geometry::Sphere { .. });
        if is_sphere && is_uneven(&placement.world_from_object) {
            let message = "a sphere stays a sphere: of its uneven scale only that along x counts";
            xml.note(notes, Severity::Guessed, placement.instance, message);
        }
        scene.instances.push(Instance {
            name: placement.name.clone(),
            geometry: *geometry,
            world_from_object: placement.world_from_object,
            materials: materials.bind(xml, notes, placement.instance, symbols),
        });
    }
    scene.materials = materials.list;
}

/// True when the axes have different lengths.
fn is_uneven(matrix: &DMat4) -> bool {
    let [x, y, z] =
        [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|axis| axis.truncate().length());
    (x - y).abs().max((x - z).abs()) > 1e-4 * x
}

fn note_absences(xml: &Xml<'_, '_>, notes: &mut Notes, scene: &Scene) {
    let mut note = |severity, message| xml.note(notes, severity, xml.root, message);
    if scene.instances.is_empty() {
        note(Severity::Warning, "the scene has nothing to see");
    }
    if !scene.has_light() {
        note(Severity::Guessed, "the scene has no light");
    }
    if scene.cameras.is_empty() {
        note(Severity::Guessed, "the scene has no camera");
    }
}

fn complete_counts(counts: ReadCounts, scene: &Scene, nodes: usize) -> ReadCounts {
    let triangles = |geometry: &Geometry| match geometry {
        Geometry::Mesh(mesh) => mesh.triangles.len(),
        Geometry::Sphere { .. } => 0,
    };
    let all = || scene.geometries.iter().map(Arc::as_ref);
    let spheres = all()
        .filter(|g| matches!(g, Geometry::Sphere { .. }))
        .count();
    let instanced = scene
        .instances
        .iter()
        .map(|i| triangles(&scene.geometries[i.geometry]));
    ReadCounts {
        up_axis: match scene.up_axis {
            UpAxis::X => "X_UP",
            UpAxis::Y => "Y_UP",
            UpAxis::Z => "Z_UP",
        }
        .to_owned(),
        metres_per_unit: scene.metres_per_unit,
        is_course_dialect: scene.dialect == Dialect::Course,
        nodes,
        meshes: scene.geometries.len() - spheres,
        spheres,
        triangles: all().map(triangles).sum(),
        instanced_triangles: instanced.sum(),
        instances: scene.instances.len(),
        materials: scene.materials.len(),
        lights: scene.lights.len(),
        cameras: scene.cameras.len(),
        ..counts
    }
}
