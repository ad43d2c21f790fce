//! Scenes with many instances, and their pictures.

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;
use std::sync::Arc;

use glam::{DMat4, DQuat, DVec3, EulerRot};
use softbox::camera::{Camera, Framing, RayCamera};
use softbox::color::Rgb;
use softbox::geometry::{Corner, Mesh, MeshTriangle};
use softbox::integrator::{PathCounts, PathId, PathSettings, PathTracer, Wavefront};
use softbox::scene::{
    Geometry, Instance, Instancing, PrepareSettings, PreparedScene, Scene, SceneBuilder, prepare,
};
use softbox::settings::{MaxDepth, Mode};

pub(crate) const SETTINGS: PathSettings = PathSettings {
    mode: Mode::Best,
    light_samples: 1,
    max_depth: MaxDepth(5),
    only_last_bounce: false,
    seed: 3,
    replicates: 1,
    reuse: 1,
};

/// The same without rays that are aimed: light paths, which tell where to, part by rounding.
pub(crate) const UNGUIDED: PathSettings = PathSettings {
    mode: Mode::Importance,
    ..SETTINGS
};

/// A closed lumpy ball of radius about 1 with two material slots; 4 · `n`² − 4 · `n` triangles.
pub(crate) fn ball(n: u32, has_normals: bool) -> Mesh {
    let columns = 2 * n;
    let mut positions = Vec::new();
    for row in 0..=n {
        let theta = PI * f64::from(row) / f64::from(n);
        for column in 0..columns {
            let phi = TAU * f64::from(column) / f64::from(columns);
            let radius = 1.0 + 0.1 * (5.0 * theta).sin() * (3.0 * phi).cos() * theta.sin();
            let ring = theta.sin();
            positions.push(radius * DVec3::new(ring * phi.sin(), theta.cos(), ring * phi.cos()));
        }
    }
    let corner = |row: u32, column: u32| {
        // One vertex at each pole.
        let column = if row == 0 || row == n {
            0
        } else {
            column % columns
        };
        let position = row * columns + column;
        Corner {
            position,
            normal: if has_normals {
                position
            } else {
                Corner::NO_NORMAL
            },
        }
    };
    let mut triangles = Vec::new();
    for (r, c) in (0..n).flat_map(|r| (0..columns).map(move |c| (r, c))) {
        let [a, b, d, e] = [
            corner(r, c),
            corner(r + 1, c),
            corner(r + 1, c + 1),
            corner(r, c + 1),
        ];
        let mut add = |corners| {
            triangles.push(MeshTriangle {
                corners,
                material_slot: u16::from(r % 4 == 0),
            });
        };
        if r + 1 < n {
            add([a, b, d]);
        }
        if r > 0 {
            add([a, d, e]);
        }
    }
    let normals = positions.iter().map(|p| p.normalize().as_vec3());
    Mesh {
        name: "ball".to_owned(),
        normals: if has_normals {
            normals.collect()
        } else {
            Vec::new()
        },
        positions,
        triangles,
    }
}

/// Adds `mesh` at all `places`.
pub(crate) fn place(builder: &mut SceneBuilder, mesh: Mesh, materials: &[usize], places: &[DMat4]) {
    let scene = builder.scene_mut();
    scene.geometries.push(Arc::new(Geometry::Mesh(mesh)));
    for &world_from_object in places {
        scene.instances.push(Instance {
            name: format!("ball {}", scene.instances.len()),
            geometry: scene.geometries.len() - 1,
            world_from_object,
            materials: materials.to_vec(),
        });
    }
}

/// `n` numbers in [0, 1), the fractional parts of multiples of an irrational number.
fn spread(i: usize, step: f64) -> f64 {
    (i as f64 * step).fract()
}

/// Place number `i` of some inside of the box from `min` to `max`.
pub(crate) fn scattered(i: usize, (min, max): (DVec3, DVec3), scale: DVec3) -> DMat4 {
    let along = DVec3::new(
        spread(i, 0.754_877_666),
        spread(i, 0.569_840_290),
        spread(i, 0.618_033_988),
    );
    let turn = DQuat::from_euler(
        EulerRot::XYZ,
        TAU * spread(i, 0.414_213_562),
        TAU * spread(i, 0.732_050_807),
        0.3,
    );
    DMat4::from_scale_rotation_translation(scale, turn, min + along * (max - min))
}

pub(crate) fn prepared(scene: &Scene, instancing: Instancing) -> PreparedScene {
    let settings = PrepareSettings {
        instancing,
        ..PrepareSettings::default()
    };
    prepare(scene, &settings, &|_, _| ControlFlow::Continue(())).expect("nothing asks it to stop")
}

pub(crate) fn view(eye: DVec3, target: DVec3, degrees: f64) -> Camera {
    Camera {
        eye,
        target,
        framing: Framing::Horizontal(degrees.to_radians()),
        ..Camera::default()
    }
}

/// The radiance of every sample of a picture, sample by sample, and the work.
pub(crate) fn samples(
    scene: &PreparedScene,
    settings: PathSettings,
    camera: &Camera,
    (width, height): (u32, u32),
    count: u32,
) -> (Vec<Rgb>, PathCounts) {
    let camera = RayCamera::new(camera, width, height, scene.normalization());
    let tracer = PathTracer::new(scene, &camera, settings);
    let ids: Vec<PathId> = (0..width * height)
        .flat_map(|pixel| {
            (0..count).map(move |sample| PathId {
                pixel: [pixel % width, pixel / width],
                sample,
            })
        })
        .collect();
    let mut radiance = vec![Rgb::ZERO; ids.len()];
    let mut counts = PathCounts::default();
    let mut wavefront = Wavefront::default();
    for (ids, radiance) in ids.chunks(1_000).zip(radiance.chunks_mut(1_000)) {
        wavefront.trace(&tracer, ids, radiance, &mut counts);
    }
    (radiance, counts)
}
