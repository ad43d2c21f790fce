//! Nodes, cameras, axes and references.

use crate::collada_text::{PLACE, VERTEX, document, square};
use crate::{has_note, load};
use glam::DVec3;
use softbox::io::{Loaded, Severity};
use softbox::scene::UpAxis;

#[test]
fn cameras_keep_their_angles_and_order() {
    let libraries = "<library_cameras>\
         <camera id='a'><optics><technique_common><perspective><xfov>60</xfov><aspect_ratio>2</aspect_ratio></perspective></technique_common></optics></camera>\
         <camera id='b'><optics><technique_common><perspective><yfov>30</yfov></perspective></technique_common></optics></camera>\
         <camera id='c'><optics><technique_common><orthographic><xmag>1</xmag></orthographic></technique_common></optics></camera></library_cameras>";
    let nodes = "<node name='B'><translate>1 2 3</translate><instance_camera url='#b'/></node>\
         <node name='A'><instance_camera url='#a'/></node><node name='C'><instance_camera url='#c'/></node>";
    let loaded = load(&document(libraries, nodes));
    let cameras = &loaded.scene.cameras;
    let names: Vec<&str> = cameras.iter().map(|camera| camera.name.as_str()).collect();
    assert_eq!(names, ["B", "A", "C"]);
    assert_eq!(cameras[0].fov.y, Some(30_f64.to_radians()));
    assert_eq!(cameras[0].fov.x, None);
    assert_eq!(
        cameras[0].world_from_camera.transform_point3(DVec3::ZERO),
        DVec3::new(1.0, 2.0, 3.0)
    );
    assert_eq!(
        (cameras[1].fov.x, cameras[1].fov.aspect),
        (Some(60_f64.to_radians()), Some(2.0))
    );
    assert!(cameras[2].fov.x.is_some());
    assert!(has_note(&loaded, Severity::Guessed, "orthographic"));
}

#[test]
fn up_axis_and_unit_are_read_and_applied_as_agreed() {
    let base = document(
        &square(&format!("<triangles>{VERTEX}<p>0 1 2</p></triangles>")),
        PLACE,
    );
    for (name, axis, corner) in [
        ("X_UP", UpAxis::X, DVec3::new(0.0, 1.0, 0.0)),
        ("Y_UP", UpAxis::Y, DVec3::new(1.0, 0.0, 0.0)),
        ("Z_UP", UpAxis::Z, DVec3::new(-1.0, 0.0, 0.0)),
    ] {
        let Loaded { scene, report } = load(&base.replace("Y_UP", name));
        let to_world = scene.instances[0].world_from_object;
        assert_eq!(scene.up_axis, axis);
        assert_eq!(to_world.transform_point3(DVec3::X), corner);
        assert_eq!(to_world.determinant(), 1.0);
        assert_eq!(
            (scene.metres_per_unit, report.read.up_axis.as_str()),
            (0.01, name)
        );
    }
    let loaded = load(&base.replace("<up_axis>Y_UP</up_axis>", ""));
    assert_eq!(loaded.scene.up_axis, UpAxis::Y);
    assert!(has_note(&loaded, Severity::Guessed, "<up_axis>"));
}

#[test]
fn nodes_nest_and_are_instanced() {
    let libraries = format!(
        "{}<library_nodes><node id='pair'><translate>0 0 1</translate><instance_geometry url='#g'/>\
         <node><translate>0 0 1</translate><instance_geometry url='#g'/></node></node></library_nodes>",
        square(&format!("<triangles>{VERTEX}<p>0 1 2</p></triangles>"))
    );
    let nodes = "<node><translate>5 0 0</translate><instance_node url='#pair'/></node>\
         <node><scale>-1 1 1</scale><instance_node url='#pair'/></node>";
    let Loaded { scene, report } = load(&document(&libraries, nodes));
    let places = scene
        .instances
        .iter()
        .map(|i| i.world_from_object.w_axis.truncate());
    assert_eq!(
        places.collect::<Vec<_>>(),
        [
            DVec3::new(5.0, 0.0, 1.0),
            DVec3::new(5.0, 0.0, 2.0),
            DVec3::new(0.0, 0.0, 1.0),
            DVec3::new(0.0, 0.0, 2.0)
        ]
    );
    assert_eq!(scene.geometries.len(), 1);
    assert!(scene.instances[0].world_from_object.determinant() > 0.0);
    assert!(scene.instances[2].world_from_object.determinant() < 0.0);
    let read = &report.read;
    assert_eq!(
        (read.triangles, read.instanced_triangles, read.nodes),
        (1, 4, 6)
    );
}

#[test]
fn skins_show_their_bind_pose() {
    let libraries = format!(
        "{}<library_controllers><controller id='c'><skin source='#g'>\
         <bind_shape_matrix>2 0 0 0 0 2 0 0 0 0 2 7 0 0 0 1</bind_shape_matrix></skin></controller>\
         <controller id='outer'><morph source='#c'/></controller></library_controllers>",
        square(&format!("<triangles>{VERTEX}<p>0 1 2</p></triangles>"))
    );
    let nodes = "<node><translate>1 0 0</translate><instance_controller url='#outer'/></node>";
    let loaded = load(&document(&libraries, nodes));
    let to_world = loaded.scene.instances[0].world_from_object;
    assert_eq!(
        to_world.transform_point3(DVec3::X),
        DVec3::new(3.0, 0.0, 7.0)
    );
    assert!(has_note(&loaded, Severity::Guessed, "bind pose"));
}

#[test]
fn references_match_with_percent_codes_and_blanks() {
    let text = document(
        &square(&format!("<triangles>{VERTEX}<p>0 1 2</p></triangles>")),
        PLACE,
    );
    let text = text.replace("id=\"g\"", "id=\"my mesh^1\"");
    for reference in ["#my mesh^1", "#my%20mesh%5E1", "# my mesh^1 ", "my mesh^1"] {
        let text = text.replace("\"#g\"", &format!("\"{reference}\""));
        assert_eq!(load(&text).scene.instances.len(), 1, "{reference}");
    }
}
