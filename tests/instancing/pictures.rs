use glam::{DMat4, DVec3};
use softbox::color::Rgb;
use softbox::integrator::{PathCounts, PathId, PathTracer, reference};
use softbox::scene::{Instancing, Scene, Surface, cornell_box};

use crate::scenes::{SETTINGS, UNGUIDED, ball, place, prepared, samples, scattered, view};

/// The Cornell box with turned, mirrored and stretched balls of two materials, with and without
/// normals in the file.
fn crowd() -> Scene {
    let mut builder = cornell_box("crowd");
    let grey = builder.diffuse("grey", Rgb::new(0.7, 0.5, 0.3));
    let mirror = builder.surface(
        "mirror",
        Surface::Mirror {
            reflectance: Rgb::splat(0.9),
        },
    );
    let glass = builder.surface(
        "glass",
        Surface::Glass {
            reflectance: Rgb::ONE,
            transmittance: Rgb::ONE,
            ior: 1.5,
        },
    );
    let room = (DVec3::new(-0.8, 0.2, -0.8), DVec3::new(0.8, 1.2, 0.8));
    let similar: Vec<DMat4> = (0..12)
        .map(|i| {
            let size = 0.08 + 0.01 * i as f64;
            let side = if i % 3 == 0 { -1.0 } else { 1.0 };
            scattered(i, room, DVec3::new(size, size, size * side))
        })
        .collect();
    place(&mut builder, ball(12, false), &[grey, mirror], &similar);
    let stretched: Vec<DMat4> = (20..26)
        .map(|i| scattered(i, room, DVec3::new(0.1, 0.2, -0.12)))
        .collect();
    place(&mut builder, ball(10, true), &[glass, grey], &stretched);
    place(&mut builder, ball(8, false), &[grey], &stretched);
    builder.finish()
}

fn mean(radiance: &[Rgb]) -> f64 {
    let sum = |c: &Rgb| f64::from(c.x + c.y + c.z);
    radiance.iter().map(sum).sum::<f64>() / radiance.len() as f64
}

#[test]
fn pictures_with_instances_are_those_with_copies() {
    let scene = crowd();
    let camera = view(DVec3::new(0.0, 0.75, 4.8), DVec3::new(0.0, 0.75, 0.0), 31.0);
    let (size, count) = ((64, 48), 16);
    let copies = prepared(&scene, Instancing::Never);
    assert_eq!(copies.instance_stats().instances, 0);
    let shared = prepared(&scene, Instancing::Always);
    let stats = shared.instance_stats();
    // Stretched balls without normals are copied; what is in the box besides is shared too.
    assert!(stats.instances >= 18 && stats.meshes >= 2, "{stats:?}");
    let total = copies.aggregate().primitive_count();
    assert_eq!(shared.aggregate().primitive_count(), total);
    let (a, counts) = samples(&copies, UNGUIDED, &camera, size, count);
    let (b, others) = samples(&shared, UNGUIDED, &camera, size, count);
    assert_eq!((counts.invalid_samples, others.invalid_samples), (0, 0));
    // Where rounding sends a path elsewhere, all that follows differs.
    let is_other = |(a, b): &(Rgb, Rgb)| (*a - *b).abs().max_element() > 1e-3 * (1.0 + a.length());
    let pairs = a.iter().copied().zip(b.iter().copied());
    let (others, same): (Vec<_>, Vec<_>) = pairs.partition(is_other);
    let other = others.len() as f64 / a.len() as f64;
    let (same_a, same_b): (Vec<Rgb>, Vec<Rgb>) = same.into_iter().unzip();
    let difference = (mean(&same_a) - mean(&same_b)).abs() / mean(&same_a);
    let pixel = |radiance: &[Rgb]| -> Vec<Rgb> {
        let sum = |samples: &[Rgb]| samples.iter().sum::<Rgb>() / samples.len() as f32;
        radiance.chunks(count as usize).map(sum).collect()
    };
    let (a, b) = (pixel(&a), pixel(&b));
    let mut apart: Vec<f32> = (a.iter().zip(&b))
        .map(|(a, b)| (*a - *b).abs().max_element() / (a.max_element() + 0.01))
        .collect();
    apart.sort_by(f32::total_cmp);
    let typical = apart[apart.len() * 9 / 10];
    assert!(
        difference < 1e-6,
        "means of the paths that go the same way differ by {difference:e}"
    );
    assert!(other < 1e-4, "{other:e} of the paths go elsewhere");
    assert!(
        typical < 1e-5,
        "nine of ten pixels differ by less than {typical:e}"
    );
}

#[test]
fn both_path_tracers_agree_on_instances() {
    let scene = prepared(&crowd(), Instancing::Always);
    let camera = view(DVec3::new(0.0, 0.75, 4.8), DVec3::new(0.0, 0.75, 0.0), 31.0);
    let (radiance, _) = samples(&scene, SETTINGS, &camera, (24, 18), 2);
    let camera = softbox::camera::RayCamera::new(&camera, 24, 18, scene.normalization());
    let tracer = PathTracer::new(&scene, &camera, SETTINGS);
    for (i, radiance) in radiance.iter().enumerate() {
        let i = i as u32;
        let id = PathId {
            pixel: [i / 2 % 24, i / 2 / 24],
            sample: i % 2,
        };
        assert_eq!(
            *radiance,
            reference(&tracer, id, &mut PathCounts::default())
        );
    }
}

/// No light gets into closed balls, whatever their size and place.
#[test]
fn closed_instances_are_dark_inside() {
    for (i, size) in [1e-3, 0.05, 1.0, 30.0].into_iter().enumerate() {
        let mut builder = softbox::scene::SceneBuilder::new("dark");
        let white = builder.diffuse("white", Rgb::splat(0.95));
        let places: Vec<DMat4> = (0..4)
            .map(|j| {
                let room = (DVec3::splat(-5.0 * size), DVec3::splat(5.0 * size));
                scattered(7 * i + j, room, DVec3::new(size, -size, size))
            })
            .collect();
        place(&mut builder, ball(9, false), &[white], &places);
        builder.scene_mut().environment.sky = Rgb::ONE;
        let scene = prepared(&builder.finish(), Instancing::Always);
        let center = places[0].transform_point3(DVec3::ZERO);
        let camera = view(center, center + DVec3::X, 100.0);
        let (radiance, counts) = samples(&scene, SETTINGS, &camera, (40, 40), 16);
        assert!(counts.closest_rays > 80_000, "paths stay alive: {counts:?}");
        let leaks = radiance.iter().filter(|r| **r != Rgb::ZERO).count();
        assert_eq!(leaks, 0, "size {size}");
    }
}

#[test]
fn only_what_pays_is_shared_and_never_what_emits() {
    let scene = |n: u32, copies: usize, emits: bool| {
        let mut builder = cornell_box("some");
        let lamp = builder.emitter("lamp", Rgb::ONE);
        let grey = builder.diffuse("grey", Rgb::splat(0.5));
        let room = (DVec3::splat(-0.5), DVec3::splat(0.5));
        let places: Vec<DMat4> = (0..copies)
            .map(|i| scattered(i, room, DVec3::splat(0.1)))
            .collect();
        let materials = [grey, if emits { lamp } else { grey }];
        place(&mut builder, ball(n, false), &materials, &places);
        prepared(&builder.finish(), Instancing::Auto)
            .instance_stats()
            .instances
    };
    // 4 · 100 · 99 = 39 600 triangles: six copies save 198 000, seven 237 600.
    assert_eq!(scene(100, 1, false), 0);
    assert_eq!(scene(100, 6, false), 0);
    assert_eq!(scene(100, 7, false), 7);
    assert_eq!(scene(100, 7, true), 0);
    // 224 triangles are too few.
    assert_eq!(scene(8, 1_500, false), 0);
}

#[test]
fn a_hundred_million_triangles_take_little_memory() {
    let mut builder = softbox::scene::SceneBuilder::new("forest");
    let grey = builder.diffuse("grey", Rgb::splat(0.6));
    let field = (DVec3::new(-50.0, 0.0, -50.0), DVec3::new(50.0, 1.0, 50.0));
    let places: Vec<DMat4> = (0..10_000)
        .map(|i| scattered(i, field, DVec3::splat(0.5)))
        .collect();
    place(&mut builder, ball(51, false), &[grey, grey], &places);
    builder.scene_mut().environment.sky = Rgb::ONE;
    let scene = prepared(&builder.finish(), Instancing::Auto);
    let stats = scene.instance_stats();
    assert_eq!((stats.instances, stats.meshes), (10_000, 1));
    assert_eq!(stats.unique_triangles, 10_200);
    assert_eq!(stats.virtual_triangles, 102_000_000);
    assert!(stats.bytes < 10_000_000, "{stats:?}");
    assert_eq!(scene.aggregate().stats().primitives, 0, "nothing is copied");
    let camera = view(DVec3::new(0.0, 8.0, 60.0), DVec3::ZERO, 60.0);
    let (radiance, counts) = samples(&scene, SETTINGS, &camera, (48, 32), 4);
    assert_eq!(counts.invalid_samples, 0);
    let (least, most) = (0.05, 1.0);
    assert!(
        (least..most).contains(&(mean(&radiance) / 3.0)),
        "{}",
        mean(&radiance)
    );
}
