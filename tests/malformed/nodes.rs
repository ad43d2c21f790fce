//! Faulty nodes and references.

use crate::collada_text::{PLACE, VERTEX, document, square};
use crate::{assert_error, good, warned};

#[test]
fn scenes_without_a_place_to_start_are_named() {
    assert_error("nothing inside", b"<COLLADA/>", "<visual_scene>");
    let libraries_only = good()
        .replace("<visual_scene", "<other_scene")
        .replace("</visual_scene", "</other_scene");
    assert_error(
        "no visual scene",
        libraries_only.as_bytes(),
        "<visual_scene>",
    );
}

#[test]
fn nodes_in_circles_or_too_many_are_named() {
    let circle = document(
        "<library_nodes><node id='a'><node><instance_node url='#b'/></node></node>\n\
         <node id='b' name='second'><instance_node url='#a'/></node></library_nodes>",
        "<node><instance_node url='#a'/></node>",
    );
    assert_error("circle of two", circle.as_bytes(), "line 5: the node \"a\"");
    let own = document("", "<node id='me'>\n<instance_node url='#me'/></node>");
    assert_error("own child", own.as_bytes(), "line 7: the node \"me\"");
    let deep = document(
        "",
        &format!("{}{}", "<node>".repeat(100_000), "</node>".repeat(100_000)),
    );
    assert_error("100,000 deep", deep.as_bytes(), "line 6: nodes are nested");
    let mut doubling = "<node id='n0'/>".to_owned();
    for level in 1..64 {
        let previous = format!("<instance_node url='#n{}'/>", level - 1);
        doubling += &format!("<node id='n{level}'>{previous}{previous}</node>");
    }
    let libraries = format!("<library_nodes>{doubling}</library_nodes>");
    let doubling = document(&libraries, "<node><instance_node url='#n63'/></node>");
    assert_error("2^63 nodes", doubling.as_bytes(), "expands to more than");
}

/// What a node beside a good one does wrong; the node; the warning.
const NODES: [(&str, &str, &str); 23] = [
    (
        "geometry gone",
        "<node><instance_geometry url='#none'/></node>",
        "no <geometry> has the id",
    ),
    (
        "no url",
        "<node><instance_geometry/></node>",
        "there is no url",
    ),
    (
        "other file",
        "<node><instance_geometry url='other.dae#g'/></node>",
        "in another file",
    ),
    (
        "light gone",
        "<node><instance_light url='#none'/></node>",
        "no <light> has the id",
    ),
    (
        "camera gone",
        "<node><instance_camera url=''/></node>",
        "no <camera> has the id",
    ),
    (
        "node gone",
        "<node><instance_node url='#none'/></node>",
        "no <node> has the id",
    ),
    (
        "controller gone",
        "<node><instance_controller url='#none'/></node>",
        "no <controller> has the id",
    ),
    (
        "controllers in a circle",
        "<node><instance_controller url='#c'/></node>",
        "circle",
    ),
    (
        "controller of nothing",
        "<node><instance_controller url='#d'/></node>",
        "has the id",
    ),
    (
        "empty controller",
        "<node><instance_controller url='#e'/></node>",
        "neither",
    ),
    (
        "spline",
        "<node><instance_geometry url='#spline'/></node>",
        "splines",
    ),
    (
        "empty mesh",
        "<node><instance_geometry url='#empty'/></node>",
        "no usable faces",
    ),
    (
        "sphere of no size",
        "<node><instance_geometry url='#dot'/></node>",
        "no positive radius",
    ),
    (
        "flat",
        "<node><scale>1 0 1</scale><instance_geometry url='#g'/></node>",
        "flatten",
    ),
    (
        "nan matrix",
        "<node><matrix>nan 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix><instance_geometry url='#g'/></node>",
        "<matrix> has too few",
    ),
    (
        "short matrix",
        "<node><matrix>1 2 3</matrix></node>",
        "<matrix> has too few",
    ),
    (
        "huge scale",
        "<node><scale>1e20 1 1</scale><node><scale>1e20 1 1</scale><instance_geometry url='#g'/></node></node>",
        "beyond 1e30",
    ),
    (
        "perspective matrix",
        "<node><matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0</matrix><instance_geometry url='#g'/></node>",
        "not affine",
    ),
    (
        "negative light",
        "<node><instance_light url='#dark'/></node>",
        "negative",
    ),
    (
        "light of nan",
        "<node><instance_light url='#nan'/></node>",
        "colour has too few",
    ),
    (
        "wide camera",
        "<node><instance_camera url='#wide'/></node>",
        "between 0 and 180",
    ),
    (
        "material gone",
        "<node><instance_geometry url='#g'><bind_material><technique_common><instance_material symbol='m' target='#none'/></technique_common></bind_material></instance_geometry></node>",
        "no <material> has the id",
    ),
    (
        "effect gone",
        "<node><instance_geometry url='#g'><bind_material><technique_common><instance_material symbol='m' target='#bare'/></technique_common></bind_material></instance_geometry></node>",
        "no <instance_effect>",
    ),
];

/// A good geometry and all kinds of faulty elements to refer to.
fn libraries() -> String {
    format!(
        "<library_materials><material id='bare'/></library_materials>\
             <library_controllers><controller id='c'><skin source='#c'/></controller>\
             <controller id='d'><morph source='#none'/></controller><controller id='e'/></library_controllers>\
             <library_lights><light id='dark'><technique_common><point><color>-1 0 0</color></point></technique_common></light>\
             <light id='nan'><technique_common><point><color>nan 0 0</color></point></technique_common></light></library_lights>\
             <library_cameras><camera id='wide'><optics><technique_common><perspective><xfov>200</xfov></perspective></technique_common></optics></camera></library_cameras>\
             <library_geometries><geometry id='spline'><spline/></geometry><geometry id='empty'><mesh/></geometry><geometry/>\
             <geometry id='dot'><extra><technique profile='CGL'><sphere><radius>0</radius></sphere></technique></extra></geometry></library_geometries>{}",
        square(&format!(
            "<triangles count='1'>{VERTEX}<p>0 1 2</p></triangles>"
        ))
    )
}

#[test]
fn dangling_and_missing_references_are_survived() {
    for (name, node, part) in NODES {
        let text = document(&libraries(), &format!("{PLACE}\n{node}"));
        assert_eq!(warned(name, &text, part), 1, "{name}");
    }
}
