//! The scenes that come with softbox.

use std::ops::ControlFlow;
use std::path::PathBuf;

use glam::{DVec3, Vec3};
use softbox::io::{Loaded, Severity, load_scene};
use softbox::scene::{Dialect, Geometry, Instance, LightKind, Scene};

/// File, triangles of all instances, placed spheres, placed lights.
const SCENES: [(&str, usize, usize, usize); 7] = [
    ("cornell-empty", 12, 0, 1),
    ("cornell-spheres", 12, 2, 1),
    ("cornell-mirror-glass", 12, 2, 1),
    ("cornell-microfacet", 12, 2, 1),
    ("lights", 26, 1, 3),
    ("many-lights", 154, 1, 0),
    ("open-sky", 14, 3, 0),
];

fn load(name: &str) -> Loaded {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "assets"].iter().collect();
    let path = path.join(name).with_extension("dae");
    load_scene(&path, &mut |_| ControlFlow::Continue(())).expect("a scene of our own")
}

/// World positions of the corners of an instance's triangles; none for spheres.
fn world_triangles(scene: &Scene, instance: &Instance) -> Vec<[DVec3; 3]> {
    let Geometry::Mesh(mesh) = scene.geometries[instance.geometry].as_ref() else {
        return Vec::new();
    };
    let world = |position: u32| {
        let local = mesh.positions[position as usize];
        instance.world_from_object.transform_point3(local)
    };
    let triangles = mesh.triangles.iter();
    triangles
        .map(|t| t.corners.map(|corner| world(corner.position)))
        .collect()
}

fn is_close(a: DVec3, b: DVec3) -> bool {
    (a - b).length() < 1e-12
}

fn is_emitter(scene: &Scene, instance: &Instance) -> bool {
    let mut materials = instance.materials.iter();
    materials.any(|&index| scene.materials[index].emission != Vec3::ZERO)
}

#[test]
fn all_load_without_a_word_of_doubt() {
    for (name, triangles, spheres, lights) in SCENES {
        let Loaded { scene, report } = load(name);
        let is_sphere =
            |i: &&Instance| matches!(*scene.geometries[i.geometry], Geometry::Sphere { .. });
        let found = (
            report.read.instanced_triangles,
            scene.instances.iter().filter(is_sphere).count(),
            scene.lights.len(),
        );
        assert_eq!(found, (triangles, spheres, lights), "{name}");
        let mut notes = report.notes.iter();
        assert!(
            notes.all(|note| note.severity == Severity::Read),
            "{name}:\n{report}"
        );
        assert_eq!(
            (scene.dialect, scene.cameras.len()),
            (Dialect::Course, 1),
            "{name}"
        );
        assert!(scene.has_light(), "{name}");
        assert_eq!(scene.environment.sky != Vec3::ZERO, name == "open-sky");
    }
}

/// Closed meshes are wound outwards, grounds look up, lamps look down.
#[test]
fn surfaces_face_the_right_way() {
    for (name, ..) in SCENES {
        let Loaded { scene, .. } = load(name);
        for instance in &scene.instances {
            let triangles = world_triangles(&scene, instance);
            let normals = triangles
                .iter()
                .map(|[a, b, c]| (b - a).cross(c - a).normalize());
            if is_emitter(&scene, instance) {
                assert!(normals.clone().all(|n| is_close(n, DVec3::NEG_Y)), "{name}");
            }
            if ["ground", "floor"].contains(&instance.name.as_str()) {
                assert!(normals.clone().all(|n| is_close(n, DVec3::Y)), "{name}");
            }
            if instance.name.ends_with("block") {
                let center = instance.world_from_object.transform_point3(DVec3::ZERO);
                let outward = normals
                    .zip(&triangles)
                    .all(|(n, [a, ..])| n.dot(*a - center) > 0.0);
                assert!(outward && triangles.len() == 12, "{name}");
            }
        }
    }
}

#[test]
fn the_light_of_each_cornell_box_is_its_panel() {
    for (name, ..) in SCENES
        .iter()
        .filter(|(name, ..)| name.starts_with("cornell"))
    {
        let Loaded { scene, .. } = load(name);
        let light = &scene.lights[0];
        let radiance = Vec3::splat(10.0);
        assert_eq!(light.kind, LightKind::Area { radiance });
        let panel = scene.instances.iter().find(|i| is_emitter(&scene, i));
        let panel = world_triangles(&scene, panel.expect("a panel"));
        for (x, y) in [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)] {
            let corner = light
                .world_from_light
                .transform_point3(DVec3::new(x, y, 0.0));
            let mut corners = panel.iter().flatten();
            assert!(corners.any(|other| *other == corner), "{name}: {corner}");
        }
        let facing = light.world_from_light.transform_vector3(DVec3::NEG_Z);
        assert_eq!(facing, DVec3::NEG_Y, "{name}");
        // The course's rule looks from where the file's camera stands, through the open side.
        let camera = scene.cameras[0].world_from_camera;
        let towards = camera.transform_point3(DVec3::NEG_Z).normalize();
        assert!(is_close(towards, DVec3::Z), "{name}");
        let bounds = scene.bounds().expect("a box");
        assert_eq!(
            bounds,
            (DVec3::new(-1.0, 0.0, -1.0), DVec3::new(1.0, 1.5, 1.0))
        );
    }
}
