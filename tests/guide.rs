//! The guide towards lights seen through mirrors and glass: where there is one, that edits remake it, and
//! that it is worth having. What it may not change is held by `estimators`, `both_tracers` and `double`.

use std::ops::ControlFlow;

use glam::{DMat4, DVec3};
use softbox::camera::{Camera, Framing, RayCamera};
use softbox::color::Rgb;
use softbox::integrator::{PathCounts, PathId, PathSettings, PathTracer, Wavefront};
use softbox::scene::{
    Instancing, LightKind, PrepareCache, PrepareSettings, PreparedScene, Scene, SceneBuilder,
    Surface, cornell_box, prepare, prepare_with,
};
use softbox::settings::{MaxDepth, Mode};

const MIRROR: Surface = Surface::Mirror {
    reflectance: Rgb::ONE,
};
const GREY: Surface = Surface::Diffuse {
    reflectance: Rgb::splat(0.5),
};

fn ball(mut builder: SceneBuilder, surface: Surface) -> Scene {
    let material = builder.surface("ball", surface);
    builder.sphere("ball", DVec3::new(0.3, 0.4, 0.2), 0.35, material);
    builder.finish()
}

/// The box without its light.
fn dark_box() -> SceneBuilder {
    let mut builder = cornell_box("dark box");
    for material in &mut builder.scene_mut().materials {
        material.emission = Rgb::ZERO;
    }
    builder
}

fn prepared(scene: &Scene, settings: PrepareSettings) -> PreparedScene {
    prepare(scene, &settings, &|_, _| ControlFlow::Continue(())).expect("nothing asks it to stop")
}

fn is_guided(scene: &Scene) -> bool {
    prepared(scene, PrepareSettings::default())
        .guide()
        .is_some()
}

#[test]
fn only_area_light_on_mirrors_or_glass_has_a_guide() {
    let lit = ball(cornell_box("mirror"), MIRROR);
    assert!(is_guided(&lit));
    assert!(!is_guided(&ball(cornell_box("grey"), GREY)));
    let mut point = dark_box();
    let intensity = Rgb::ONE;
    let place = DMat4::from_translation(DVec3::new(0.0, 1.2, 0.0));
    point.light("point", LightKind::Point { intensity }, place);
    point.scene_mut().environment.sky = Rgb::ONE;
    assert!(!is_guided(&ball(point, MIRROR)));
    let course = PrepareSettings {
        course_compatible: true,
        ..PrepareSettings::default()
    };
    assert!(prepared(&lit, course).guide().is_none());
}

#[test]
fn the_same_scene_has_the_same_guide_and_an_edit_another() {
    let mut cache = PrepareCache::default();
    let mut of = |scene: &Scene| {
        let settings = PrepareSettings::default();
        let progress = |_: &'static str, _: f32| ControlFlow::Continue(());
        let prepared = prepare_with(scene, &settings, &mut cache, &progress);
        prepared.expect("nothing asks it to stop").guide().cloned()
    };
    let scene = ball(cornell_box("mirror"), MIRROR);
    let first = of(&scene);
    assert!(first.is_some());
    assert_eq!(of(&scene), first);
    let glass = Surface::Glass {
        reflectance: Rgb::ONE,
        transmittance: Rgb::ONE,
        ior: 1.5,
    };
    let other = of(&ball(cornell_box("glass"), glass));
    assert!(other.is_some() && other != first);
    assert_eq!(of(&ball(cornell_box("grey"), GREY)), None);
    assert_eq!(of(&scene), first);
}

#[test]
fn shared_meshes_are_found() {
    let mut builder = cornell_box("shared");
    let mirror = builder.surface("mirror", MIRROR);
    let (u, v) = (DVec3::X * 0.5, DVec3::new(0.0, 0.4, -0.3));
    builder.quad("mirror", DVec3::new(-0.3, 0.2, 0.0), u, v, mirror);
    let scene = builder.finish();
    let shared = PrepareSettings {
        instancing: Instancing::Always,
        ..PrepareSettings::default()
    };
    let shared = prepared(&scene, shared);
    assert!(shared.instance_stats().instances > 0);
    assert!(shared.guide().is_some() && is_guided(&scene));
}

/// Mean square of the differences between two halves of the samples of each pixel.
fn noise(scene: &PreparedScene, mode: Mode) -> f64 {
    const SIZE: u32 = 24;
    let camera = Camera {
        eye: DVec3::new(0.0, 0.75, 4.8),
        target: DVec3::new(0.0, 0.75, 0.0),
        framing: Framing::Horizontal(31_f64.to_radians()),
        ..Camera::default()
    };
    let camera = RayCamera::new(&camera, SIZE, SIZE, scene.normalization());
    let settings = PathSettings {
        mode,
        light_samples: 1,
        max_depth: MaxDepth(4),
        only_last_bounce: false,
        seed: 3,
        replicates: 1,
        reuse: 1,
    };
    let tracer = PathTracer::new(scene, &camera, settings);
    let mean = |pixel: u32, first: u32| {
        let ids = (first..first + 64).map(|sample| PathId {
            pixel: [pixel % SIZE, pixel / SIZE],
            sample,
        });
        let ids: Vec<PathId> = ids.collect();
        let mut radiance = vec![Rgb::ZERO; ids.len()];
        Wavefront::default().trace(&tracer, &ids, &mut radiance, &mut PathCounts::default());
        radiance.iter().map(|r| r.as_dvec3()).sum::<DVec3>() / 64.0
    };
    let differences = (0..SIZE * SIZE).map(|pixel| mean(pixel, 0) - mean(pixel, 64));
    differences.map(|d| d.length_squared()).sum()
}

#[test]
fn noise_of_a_mirror_is_less_than_half() {
    let scene = ball(cornell_box("mirror"), MIRROR);
    let scene = prepared(&scene, PrepareSettings::default());
    let (guided, plain) = (noise(&scene, Mode::Best), noise(&scene, Mode::Importance));
    assert!(guided < 0.5 * plain, "{guided} {plain}");
}
