//! Materials and lights.

use crate::collada_text::{PLACE, VERTEX, document, square};
use crate::{first_mesh, has_note, load};
use glam::{DVec3, Vec3};
use softbox::io::{Loaded, Severity};
use softbox::scene::{Dialect, LightKind, Surface};

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
