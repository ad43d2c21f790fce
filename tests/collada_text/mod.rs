//! Small COLLADA texts for tests, and how to read them.

use std::ops::ControlFlow;

use softbox::io::{ImportError, Loaded, load_scene};

/// Writes `bytes` to a file of its own and reads it.
pub(crate) fn load_bytes(bytes: &[u8]) -> Result<Loaded, ImportError> {
    let folder = tempfile::TempDir::new().expect("a temporary folder");
    let path = folder.path().join("test.dae");
    std::fs::write(&path, bytes).expect("a temporary file");
    load_scene(&path, &mut |_| ControlFlow::Continue(()))
}

/// A Y-up document around libraries and the nodes of its visual scene.
pub(crate) fn document(libraries: &str, nodes: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n\
         <COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">\n\
         <asset><unit meter=\"0.01\"/><up_axis>Y_UP</up_axis></asset>\n\
         {libraries}\n\
         <library_visual_scenes><visual_scene id=\"scene\">\n{nodes}\n</visual_scene></library_visual_scenes>\n\
         <scene><instance_visual_scene url=\"#scene\"/></scene>\n</COLLADA>\n"
    )
}

/// A geometry "g" with the unit square in the xy plane (corners 0 to 3 anticlockwise), a fifth
/// vertex at its centre, two normals (+z and a zero one) and the given primitives.
pub(crate) fn square(primitives: &str) -> String {
    format!(
        "<library_geometries><geometry id=\"g\" name=\"square\"><mesh>\n\
         <source id=\"p\"><float_array id=\"pa\" count=\"15\">0 0 0 1 0 0 1 1 0 0 1 0 0.5 0.5 0</float_array>\
         <technique_common><accessor source=\"#pa\" count=\"5\" stride=\"3\">\
         <param name=\"X\"/><param name=\"Y\"/><param name=\"Z\"/></accessor></technique_common></source>\n\
         <source id=\"n\"><float_array id=\"na\" count=\"6\">0 0 2 0 0 0</float_array>\
         <technique_common><accessor source=\"#na\" count=\"2\" stride=\"3\"/></technique_common></source>\n\
         <vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>\n\
         {primitives}\n</mesh></geometry></library_geometries>"
    )
}

/// The VERTEX input of [`square`] at offset 0.
pub(crate) const VERTEX: &str = "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>";

/// A node that places [`square`] without materials.
pub(crate) const PLACE: &str = "<node id=\"node\"><instance_geometry url=\"#g\"/></node>";
