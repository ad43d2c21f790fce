use std::f64::consts::PI;
use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;
use softbox::camera::{Camera, RayCamera};
use softbox::color::Rgb;
use softbox::image::Image;
use softbox::integrator::{
    MAX_CLUSTER, PathCounts, PathId, PathSettings, PathTracer, reference_cluster,
};
use softbox::scene::{EnvironmentMap, Scene, SceneBuilder, Surface};
use softbox::settings::{MaxDepth, Mode};

use crate::support::measure::{camera, measure, prepared, replicated, settings};
use crate::{PRECISION, check, plane};

/// A plane under a sky that grows brighter towards the zenith, its camera, and what it sees.
fn under_a_gradient() -> (Scene, Camera, f64) {
    let (a, b) = (0.5, 1.5);
    let rows = 512_usize;
    let row = |i: usize| {
        let cos = (PI * (i as f64 + 0.5) / rows as f64).cos();
        Rgb::splat((a + b * cos.max(0.0)) as f32)
    };
    let pixels = (0..rows)
        .flat_map(|i| std::iter::repeat_n(row(i), 8))
        .collect();
    let (mut builder, camera) = plane();
    builder.scene_mut().environment.map = Some(EnvironmentMap {
        path: PathBuf::from("gradient"),
        image: Arc::new(Image::from_pixels(8, rows, pixels)),
    });
    let irradiance = PI * a + 2.0 * PI / 3.0 * b;
    (builder.finish(), camera, 0.5 / PI * irradiance)
}

/// The squared error of n samples falls faster than 1 / n, in every mode: the samples are
/// low-discrepancy points and no number is used twice.
#[test]
fn the_error_falls_faster_than_with_independent_samples() {
    const REPLICATES: u32 = 1000;
    let (scene, camera, _) = under_a_gradient();
    let scene = prepared(&scene);
    for mode in Mode::ALL {
        let variance = |length: u32| {
            let settings = PathSettings {
                replicates: REPLICATES,
                ..settings(mode, MaxDepth(1))
            };
            let estimate = replicated(&scene, &camera, settings, (1, 1), length)[0];
            estimate.standard_error(0).powi(2) * f64::from(REPLICATES)
        };
        let (few, many) = (4_u32, 256_u32);
        let decades = (f64::from(many) / f64::from(few)).ln();
        let slope = (variance(many) / variance(few)).ln() / decades;
        // Each variance is known to √(2 / replicates).
        let error = (4.0 / f64::from(REPLICATES)).sqrt() / decades;
        assert!(slope + 4.0 * error < -1.0, "{mode:?}: {slope} ± {error}");
    }
}

#[test]
fn c9_environment_with_a_gradient() {
    let (scene, camera, exact) = under_a_gradient();
    let scene = prepared(&scene);
    for mode in Mode::ALL {
        let estimate = measure(&scene, &camera, settings(mode, MaxDepth(1)), 600_000);
        // Rows of constant radiance differ from the gradient by about 1e-5.
        let bound = 4.0 * estimate.standard_error(0) + 3e-5 * exact;
        assert!(
            (estimate.mean(0) - exact).abs() <= bound,
            "{mode:?} {} {exact}",
            estimate.mean(0)
        );
        assert!(estimate.standard_error(0) <= PRECISION * exact);
    }
}

/// Every sample is the exact value where all rays find the sky, although the normals of the pixels that
/// share their light differ.
#[test]
fn what_pixels_share_has_no_noise_where_the_sky_is_free() {
    let mut builder = SceneBuilder::new("ball");
    let material = builder.diffuse("grey", Rgb::splat(0.6));
    builder.sphere("ball", DVec3::ZERO, 1.0, material);
    builder.scene_mut().environment.sky = Rgb::splat(2.0);
    let scene = prepared(&builder.finish());
    let camera = camera(DVec3::Z * 4.0, DVec3::ZERO, 16.0);
    let settings = PathSettings {
        reuse: 0,
        ..settings(Mode::Best, MaxDepth(5))
    };
    let size = 8;
    let camera = RayCamera::new(&camera, size, size, scene.normalization());
    let tracer = PathTracer::new(&scene, &camera, settings);
    assert_eq!(tracer.cluster_size(), MAX_CLUSTER);
    let pixel = |i: u32| [i % size, i / size];
    for first in (0..size * size).step_by(MAX_CLUSTER) {
        let ids: Vec<_> = (first..first + MAX_CLUSTER as u32)
            .map(|i| PathId {
                pixel: pixel(i),
                sample: 3,
            })
            .collect();
        let mut radiance = [Rgb::ZERO; MAX_CLUSTER];
        reference_cluster(&tracer, &ids, &mut radiance, &mut PathCounts::default());
        for value in radiance {
            assert!((value - 1.2).abs().max_element() < 1e-5, "{value}");
        }
    }
}

#[test]
fn c10_mirror_and_glass_vanish_in_a_constant_sky() {
    let white = Rgb::ONE;
    for (name, surface) in [
        ("mirror", Surface::Mirror { reflectance: white }),
        (
            "glass",
            Surface::Glass {
                reflectance: white,
                transmittance: white,
                ior: 1.5,
            },
        ),
        (
            "refraction",
            Surface::Refraction {
                transmittance: white,
                ior: 1.45,
            },
        ),
    ] {
        let mut builder = SceneBuilder::new(name);
        let material = builder.surface(name, surface);
        builder.sphere(name, DVec3::ZERO, 1.0, material);
        builder.scene_mut().environment.sky = Rgb::ONE;
        let camera = camera(DVec3::Z * 4.0, DVec3::ZERO, 20.0);
        check(
            name,
            &builder.finish(),
            &camera,
            MaxDepth::INFINITE,
            (100_000, 1.0),
        );
    }
}
