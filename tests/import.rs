//! What the COLLADA reader makes of each feature of the format.

mod collada_text;

use std::ops::ControlFlow;
use std::path::Path;

use collada_text::{PLACE, VERTEX, document, load_bytes, square};
use glam::{DVec3, Vec3};
use softbox::geometry::{Corner, Mesh};
use softbox::io::{ImportError, LoadStage, Loaded, Severity, load_scene, read_collada};
use softbox::scene::{Dialect, Geometry, LightKind, Scene, Surface, UpAxis};

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
fn each_primitive_has_its_own_material() {
    let libraries = format!(
        "<library_effects><effect id='e'><profile_COMMON><technique><lambert><diffuse><color>0.1 0.2 0.3 1</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>\
         <library_materials><material id='m' name='blue'><instance_effect url='#e'/></material>\
         <material id='direct'><instance_effect url='#e'/></material></library_materials>{}",
        square(&format!(
            "<triangles material='sym' count='1'>{VERTEX}<p>0 1 2</p></triangles>\
             <triangles material='direct' count='1'>{VERTEX}<p>0 2 3</p></triangles>\
             <triangles material='gone' count='1'>{VERTEX}<p>0 1 4</p></triangles>\
             <triangles material='sym' count='1'>{VERTEX}<p>1 2 4</p></triangles>"
        ))
    );
    let node = "<node name='n'><instance_geometry url='#g'><bind_material><technique_common>\
         <instance_material symbol='sym' target='#m'/></technique_common></bind_material></instance_geometry></node>";
    let loaded = load(&document(&libraries, node));
    let scene = &loaded.scene;
    let slots = first_mesh(scene).triangles.iter().map(|t| t.material_slot);
    assert_eq!(slots.collect::<Vec<_>>(), [0, 1, 2, 0]);
    let instance = &scene.instances[0];
    let names = instance
        .materials
        .iter()
        .map(|&i| scene.materials[i].name.as_str());
    assert_eq!(names.collect::<Vec<_>>(), ["blue", "direct", "blue"]);
    assert!(has_note(
        &loaded,
        Severity::Guessed,
        "the first one was taken"
    ));
    let reflectance = Vec3::new(0.1, 0.2, 0.3);
    assert_eq!(scene.materials[0].surface, Surface::Diffuse { reflectance });

    let unbound = load(&document(&libraries, PLACE));
    let grey = unbound.scene.instances[0].materials[2];
    assert_eq!(unbound.scene.materials[grey].name, "default");
    assert!(has_note(
        &unbound,
        Severity::Guessed,
        "no material is bound"
    ));
}

/// The material that an effect of those contents makes.
fn material_of(effect: &str) -> (softbox::scene::Material, Loaded) {
    let libraries = format!(
        "<library_effects><effect id='e'>{effect}</effect></library_effects>\
         <library_materials><material id='m'><instance_effect url='#e'/></material></library_materials>{}",
        square(&format!(
            "<triangles material='m' count='1'>{VERTEX}<p>0 1 2</p></triangles>"
        ))
    );
    let loaded = load(&document(&libraries, PLACE));
    (loaded.scene.materials[0].clone(), loaded)
}

fn course_block(inner: &str) -> String {
    format!(
        "<profile_COMMON><technique><phong><diffuse><color>0.7 0.7 0.7 1</color></diffuse></phong></technique></profile_COMMON>\
         <extra><technique profile='CGL'>{inner}</technique></extra>"
    )
}

#[test]
fn course_surfaces_win_over_the_common_profile() {
    let surface = |inner: &str| material_of(&course_block(inner)).0.surface;
    assert_eq!(
        surface("<mirror><reflectance>1 0.8 0.4</reflectance></mirror>"),
        Surface::Mirror {
            reflectance: Vec3::new(1.0, 0.8, 0.4)
        }
    );
    assert_eq!(
        surface(
            "<glass><transmittance>1 0.5 1</transmittance><reflectance>1 1 1</reflectance><roughness>0</roughness><ior>1.5</ior></glass>"
        ),
        Surface::Glass {
            reflectance: Vec3::ONE,
            transmittance: Vec3::new(1.0, 0.5, 1.0),
            ior: 1.5
        }
    );
    assert_eq!(
        surface("<refraction><transmittance>1 1 1</transmittance><ior>1.33</ior></refraction>"),
        Surface::Refraction {
            transmittance: Vec3::ONE,
            ior: 1.33
        }
    );
    assert_eq!(
        surface("<microfacet><alpha>0.05</alpha><eta>0.2 0.3 0.4</eta><k>3 2 1</k></microfacet>"),
        Surface::Microfacet {
            alpha: 0.05,
            eta: Vec3::new(0.2, 0.3, 0.4),
            k: Vec3::new(3.0, 2.0, 1.0)
        }
    );
    let (emitter, loaded) = material_of(&course_block(
        "<emission><radiance>4 5 6</radiance></emission>",
    ));
    assert_eq!(emitter.emission, Vec3::new(4.0, 5.0, 6.0));
    let reflectance = Vec3::ZERO;
    assert_eq!(emitter.surface, Surface::Diffuse { reflectance });
    assert_eq!(loaded.scene.dialect, Dialect::Course);
    let (unknown, loaded) = material_of(&course_block("<velvet/>"));
    let reflectance = Vec3::splat(0.7);
    assert_eq!(unknown.surface, Surface::Diffuse { reflectance });
    assert!(has_note(&loaded, Severity::Dropped, "<velvet>"));
}

#[test]
fn odd_values_of_surfaces_are_held_and_noted() {
    let (material, loaded) = material_of(&course_block(
        "<mirror><reflectance>1.5 -1 0.5</reflectance></mirror>",
    ));
    let reflectance = Vec3::new(1.0, 0.0, 0.5);
    assert_eq!(material.surface, Surface::Mirror { reflectance });
    assert!(has_note(&loaded, Severity::Warning, "held to 0..1"));
    let (material, loaded) = material_of(&course_block(
        "<glass><transmittance>nan 1 1</transmittance><roughness>0.3</roughness><ior>-2</ior></glass>",
    ));
    assert_eq!(
        material.surface,
        Surface::Glass {
            reflectance: Vec3::ONE,
            transmittance: Vec3::ONE,
            ior: 1.45
        }
    );
    assert!(has_note(&loaded, Severity::Dropped, "roughness 0.3"));
    assert!(has_note(
        &loaded,
        Severity::Warning,
        "<ior> is not a positive number"
    ));
    assert!(has_note(&loaded, Severity::Guessed, "no <reflectance>"));
}

#[test]
fn common_shaders_give_their_diffuse_and_emission() {
    for shader in ["phong", "lambert", "blinn", "constant"] {
        let (material, _) = material_of(&format!(
            "<profile_COMMON><newparam sid='c'><float3>0.1 0.2 0.3</float3></newparam><technique><{shader}>\
             <emission><color>2 0 0 1</color></emission><diffuse><param ref='c'/></diffuse></{shader}></technique></profile_COMMON>\
             <extra><technique profile='GOOGLEEARTH'><double_sided>1</double_sided></technique></extra>"
        ));
        let reflectance = Vec3::new(0.1, 0.2, 0.3);
        assert_eq!(material.surface, Surface::Diffuse { reflectance });
        assert_eq!(
            (material.emission, material.double_sided),
            (Vec3::new(2.0, 0.0, 0.0), true)
        );
    }
    let (material, loaded) = material_of(
        "<profile_COMMON><technique><phong><diffuse><texture texture='t' texcoord='uv'/></diffuse>\
         <transparent><color>1 1 1 0.5</color></transparent><reflective><color>1 1 1 1</color></reflective></phong></technique></profile_COMMON>",
    );
    let reflectance = Vec3::splat(0.5);
    assert_eq!(material.surface, Surface::Diffuse { reflectance });
    for part in ["textures", "transparency", "reflections"] {
        assert!(has_note(&loaded, Severity::Dropped, part), "{part}");
    }
}

/// The lights of a scene whose only light has those contents, placed by `transform`.
fn lights_of(light: &str, transform: &str) -> Loaded {
    let libraries = format!("<library_lights><light id='l'>{light}</light></library_lights>");
    let node = format!("<node name='lamp'>{transform}<instance_light url='#l'/></node>");
    load(&document(&libraries, &node))
}

fn common_light(inner: &str) -> LightKind {
    let loaded = lights_of(&format!("<technique_common>{inner}</technique_common>"), "");
    loaded.scene.lights[0].kind
}

#[test]
fn lights_of_the_common_profile() {
    let color = Vec3::new(1.0, 2.0, 3.0);
    assert_eq!(
        common_light("<point><color>1 2 3</color></point>"),
        LightKind::Point { intensity: color }
    );
    assert_eq!(
        common_light(
            "<point><color>1 2 3</color><constant_attenuation>0</constant_attenuation><quadratic_attenuation>0.5</quadratic_attenuation></point>"
        ),
        LightKind::Point {
            intensity: 2.0 * color
        }
    );
    assert_eq!(
        common_light("<directional><color>1 2 3</color></directional>"),
        LightKind::Directional { irradiance: color }
    );
    assert_eq!(
        common_light(
            "<spot><color>1 2 3</color><falloff_angle>60</falloff_angle><falloff_exponent>2</falloff_exponent></spot>"
        ),
        LightKind::Spot {
            intensity: color,
            cone_angle: 60_f64.to_radians(),
            exponent: 2.0
        }
    );
    assert_eq!(
        common_light("<spot><color>1 2 3</color></spot>"),
        LightKind::Spot {
            intensity: color,
            cone_angle: std::f64::consts::PI,
            exponent: 0.0
        }
    );
    let linear = "<technique_common><point><color>1 1 1</color><linear_attenuation>1</linear_attenuation></point></technique_common>";
    assert!(has_note(
        &lights_of(linear, ""),
        Severity::Guessed,
        "attenuation"
    ));
}

#[test]
fn course_lights_win_and_stand_where_the_node_says() {
    let light = "<technique_common><point><color>9 9 9</color></point></technique_common>\
         <extra><technique profile='CMU462'><area><color>1 2 3</color></area></technique></extra>";
    // Local −z turned to −y, 2 wide and 4 deep, at height 3.
    let turn = "<translate>0 3 0</translate><rotate>1 0 0 -90</rotate><scale>2 4 1</scale>";
    let Loaded { scene, .. } = lights_of(light, turn);
    let radiance = Vec3::new(1.0, 2.0, 3.0);
    assert_eq!(scene.lights[0].kind, LightKind::Area { radiance });
    assert_eq!(scene.dialect, Dialect::Course);
    let matrix = scene.lights[0].world_from_light;
    let corner = matrix.transform_point3(DVec3::new(0.5, 0.5, 0.0));
    assert!(
        (corner - DVec3::new(1.0, 3.0, -2.0)).length() < 1e-12,
        "{corner}"
    );
    let facing = matrix.transform_vector3(DVec3::NEG_Z);
    assert!((facing - DVec3::NEG_Y).length() < 1e-12, "{facing}");
}

#[test]
fn ambient_light_and_sky_add_up() {
    let libraries = "<library_lights><light id='l'><technique_common><ambient><color>0.25 0.5 1</color></ambient></technique_common></light></library_lights>";
    let nodes = "<node><instance_light url='#l'/></node><node><instance_light url='#l'/></node>\
         <extra><technique profile='CGL_ENV'><radiance>0.7 0.8 0.9</radiance></technique></extra>";
    let Loaded { scene, .. } = load(&document(libraries, nodes));
    assert_eq!(scene.environment.ambient, Vec3::new(0.5, 1.0, 2.0));
    assert_eq!(scene.environment.sky, Vec3::new(0.7, 0.8, 0.9));
    assert_eq!((scene.lights.len(), scene.dialect), (0, Dialect::Plain));
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
fn encodings_namespaces_and_names_make_no_difference() {
    let text = document(
        &square(&format!("<triangles>{VERTEX}<p>0 1 2</p></triangles>")),
        PLACE,
    )
    .replace("name=\"square\"", "name=\"Würfel\"");
    let expected = load(&text).scene;
    assert_eq!(first_mesh(&expected).name, "Würfel");
    let utf16: Vec<u8> = [0xFF, 0xFE]
        .into_iter()
        .chain(text.encode_utf16().flat_map(u16::to_le_bytes))
        .collect();
    let latin1: Vec<u8> = text
        .replace("utf-8", "ISO-8859-1")
        .chars()
        .map(|c| u8::try_from(u32::from(c)).expect("Latin-1 letters only"))
        .collect();
    let with_mark = format!("\u{FEFF}{text}");
    let newer = text.replace("2005/11", "2008/03").replace("1.4.1", "1.5.0");
    let prefixed = text
        .replace("xmlns=", "xmlns:c=")
        .replace("<COLLADA", "<c:COLLADA")
        .replace("</COLLADA", "</c:COLLADA");
    let old_lines = text.replace('\n', "\r\n");
    for bytes in [
        &utf16,
        &latin1,
        with_mark.as_bytes(),
        newer.as_bytes(),
        prefixed.as_bytes(),
        old_lines.as_bytes(),
    ] {
        let loaded = load_bytes(bytes).expect("the same scene");
        assert_eq!(loaded.scene.geometries, expected.geometries);
        assert_eq!(faults(&loaded), Vec::<String>::new());
    }
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

#[test]
fn progress_runs_through_the_stages_and_can_be_stopped() {
    let folder = tempfile::TempDir::new().expect("a temporary folder");
    let path = folder.path().join("scene.xyz");
    let text = document(
        &square(&format!("<triangles>{VERTEX}<p>0 1 2</p></triangles>")),
        PLACE,
    );
    std::fs::write(&path, text).expect("a temporary file");
    let mut seen = Vec::new();
    let loaded = load_scene(&path, &mut |progress| {
        assert!((0.0..=1.0).contains(&progress.fraction));
        seen.push(progress.stage);
        ControlFlow::Continue(())
    });
    let loaded = loaded.expect("any extension will do for XML");
    assert_eq!(loaded.scene.name, "scene");
    assert_eq!(loaded.scene.path.as_deref(), Some(path.as_path()));
    assert!(seen.is_sorted());
    for stage in [
        LoadStage::Reading,
        LoadStage::Parsing,
        LoadStage::Nodes,
        LoadStage::Geometry,
        LoadStage::Materials,
    ] {
        assert!(seen.contains(&stage), "{stage:?}");
        let stopped = read_collada(&path, &mut |progress| {
            if progress.stage == stage {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        assert!(
            matches!(stopped, Err(ImportError::Cancelled { .. })),
            "{stage:?}"
        );
    }
}

#[test]
fn the_report_reads_well_and_goes_into_json() {
    let (_, loaded) = mesh_of(&format!(
        "<triangles count='5'>{VERTEX}<p>0 1 2 0 1 77</p></triangles>"
    ));
    let text = loaded.report.to_string();
    assert!(text.contains("1 triangles in 1 meshes"), "{text}");
    assert!(
        text.contains("warning line 8: triangles of geometry \"g\": 1 faces with an index"),
        "{text}"
    );
    assert!(text.contains("count says 5, the lists give 2"), "{text}");
    let json = serde_json::to_value(&loaded.report).expect("plain data");
    assert_eq!(json["read"]["triangles"], 1);
    assert_eq!(json["notes"][0]["severity"], "Warning");
}

#[test]
fn errors_can_cross_threads() {
    fn assert_can_cross<T: Send + Sync + 'static>(_: &T) {}
    let error = load_scene(Path::new("/nowhere/at all.dae"), &mut |_| {
        ControlFlow::Continue(())
    });
    assert_can_cross(&error.expect_err("there is no such file"));
}
