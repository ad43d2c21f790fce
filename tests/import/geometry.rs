//! Meshes and spheres.

use crate::collada_text::{PLACE, VERTEX, document, square};
use crate::{area, faults, first_mesh, has_note, indices, load, mesh_of};
use glam::{DVec3, Vec3};
use softbox::geometry::Corner;
use softbox::io::Severity;
use softbox::scene::Geometry;

#[test]
fn every_kind_of_primitive_covers_the_square() {
    for (primitive, count) in [
        (
            format!("<triangles count='2'>{VERTEX}<p>0 1 2 0 2 3</p></triangles>"),
            2,
        ),
        (
            format!(
                "<polylist count='2'>{VERTEX}<vcount>3 3</vcount><p>0 1 2 0 2 3</p></polylist>"
            ),
            2,
        ),
        (
            format!("<polylist count='1'>{VERTEX}<vcount>4</vcount><p>0 1 2 3</p></polylist>"),
            2,
        ),
        (
            format!("<polygons count='1'>{VERTEX}<p>0 1 2 3</p></polygons>"),
            2,
        ),
        (
            format!("<polygons count='2'>{VERTEX}<p>0 1 4</p><p>1 2 3 0 4</p></polygons>"),
            4,
        ),
        (
            format!("<tristrips count='1'>{VERTEX}<p>0 1 3 2</p></tristrips>"),
            2,
        ),
        (
            format!("<tristrips count='1'>{VERTEX}<p>0 1 3 3 3 1 2</p></tristrips>"),
            2,
        ),
        (
            format!("<trifans count='1'>{VERTEX}<p>4 0 1 2 3 0</p></trifans>"),
            4,
        ),
    ] {
        let (mesh, loaded) = mesh_of(&primitive);
        assert_eq!(faults(&loaded), Vec::<String>::new(), "{primitive}");
        assert_eq!(mesh.triangles.len(), count, "{primitive}");
        assert!((area(&mesh) - 1.0).abs() < 1e-15, "{primitive}");
    }
}

#[test]
fn lines_beside_faces_are_skipped_with_a_note() {
    let (mesh, loaded) = mesh_of(&format!(
        "<lines count='1'>{VERTEX}<p>0 1</p></lines><triangles count='1'>{VERTEX}<p>0 1 2</p></triangles>"
    ));
    assert_eq!(indices(&mesh), [[0, 1, 2]]);
    assert!(has_note(&loaded, Severity::Dropped, "<lines>"));
}

#[test]
fn a_polygon_with_a_hole_stays_open() {
    let text = document(
        "<library_geometries><geometry id='g'><mesh>\
         <source id='p'><float_array id='pa' count='24'>0 0 5 4 0 5 4 4 5 0 4 5 1 1 5 3 1 5 3 3 5 1 3 5</float_array>\
         <technique_common><accessor source='#pa' count='8' stride='3'/></technique_common></source>\
         <vertices id='v'><input semantic='POSITION' source='#p'/></vertices>\
         <polygons count='1'><input semantic='VERTEX' source='#v' offset='0'/>\
         <ph><p>0 1 2 3</p><h>4 5 6 7</h></ph></polygons></mesh></geometry></library_geometries>",
        PLACE,
    );
    let loaded = load(&text);
    let mesh = first_mesh(&loaded.scene);
    assert_eq!((mesh.triangles.len(), area(mesh)), (8, 12.0));
    assert_eq!(faults(&loaded), Vec::<String>::new());
}

#[test]
fn offsets_strides_and_parameters_find_the_numbers() {
    let text = document(
        "<library_geometries><geometry id='g'><mesh>\
         <source id='p'><float_array id='pa' count='19'>\
         99 0 -7 0 0 9  2 -7 0 0 9  2 -7 0 3 9  0 -7 0 3 9</float_array>\
         <technique_common><accessor source='#pa' count='3' offset='1' stride='5'>\
         <param name='X'/><param/><param name='Z'/><param name='Y'/><param/></accessor></technique_common></source>\
         <source id='uv'><float_array id='uva' count='2'>0 0</float_array></source>\
         <vertices id='v'><input semantic='POSITION' source='#p'/></vertices>\
         <triangles count='1'><input semantic='TEXCOORD' source='#uv' offset='0' set='0'/>\
         <input semantic='VERTEX' source='#v' offset='2'/><input semantic='COLOR' source='#uv' offset='3'/>\
         <p>9 9 0 9  9 9 1 9  9 9 2 9</p></triangles></mesh></geometry></library_geometries>",
        PLACE,
    );
    let loaded = load(&text);
    let mesh = first_mesh(&loaded.scene);
    assert_eq!(indices(mesh), [[0, 1, 2]]);
    assert_eq!(
        mesh.positions[..3],
        [
            DVec3::ZERO,
            DVec3::new(2.0, 0.0, 0.0),
            DVec3::new(2.0, 3.0, 0.0)
        ]
    );
}

#[test]
fn normals_come_from_corners_or_vertices_and_are_unit() {
    let input = "<input semantic='NORMAL' source='#n' offset='1'/>";
    let (mesh, loaded) = mesh_of(&format!(
        "<triangles count='1'>{VERTEX}{input}<p>0 0 1 1 2 7</p></triangles>"
    ));
    let normals = mesh.triangles[0].corners.map(|corner| corner.normal);
    assert_eq!(normals, [0, Corner::NO_NORMAL, Corner::NO_NORMAL]);
    assert_eq!(mesh.normals[0], Vec3::Z);
    assert!(has_note(
        &loaded,
        Severity::Warning,
        "2 corners have no usable normal"
    ));

    let by_vertex = square(&format!(
        "<triangles count='1'>{VERTEX}<p>0 1 0</p><p>0 1 2</p></triangles>"
    ))
    .replace(
        "</vertices>",
        "<input semantic='NORMAL' source='#n'/></vertices>",
    );
    let loaded = load(&document(&by_vertex, PLACE));
    let mesh = first_mesh(&loaded.scene);
    assert_eq!(mesh.triangles[0].corners[0].normal, 0);
}

#[test]
fn spheres_keep_their_radius_and_uneven_scales_are_noted() {
    let sphere = "<library_geometries><geometry id='g' name='ball'><extra><technique profile='CGL'><sphere><radius>.5</radius></sphere></technique></extra></geometry></library_geometries>";
    let loaded = load(&document(
        sphere,
        "<node><scale>2 1 1</scale><instance_geometry url='#g'/></node>",
    ));
    let Geometry::Sphere { name, radius } = loaded.scene.geometries[0].as_ref() else {
        panic!("a sphere was expected");
    };
    assert_eq!((name.as_str(), *radius), ("ball", 0.5));
    assert!(has_note(&loaded, Severity::Guessed, "uneven scale"));
    assert_eq!(loaded.scene.instances[0].materials.len(), 1);
}
