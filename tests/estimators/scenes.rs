//! Scenes that hold between them every kind of light and material.

use std::f64::consts::PI;
use std::path::PathBuf;
use std::sync::Arc;

use glam::{DMat4, DQuat, DVec3};
use softbox::camera::Camera;
use softbox::color::Rgb;
use softbox::image::Image;
use softbox::scene::{EnvironmentMap, LightKind, Scene, SceneBuilder, Surface, cornell_box};

use crate::support::measure::camera;
use crate::support::scenes::{inside_out, sphere_mesh};

/// A scene with the camera that looks at it.
pub(crate) type View = (Scene, Camera);

const LEFT: DVec3 = DVec3::new(-0.45, 0.4, -0.3);
const RIGHT: DVec3 = DVec3::new(0.45, 0.4, 0.35);

fn into_the_box() -> Camera {
    camera(DVec3::new(0.0, 0.75, 4.8), DVec3::new(0.0, 0.75, 0.0), 31.0)
}

fn two_spheres(mut builder: SceneBuilder, left: Surface, right: Surface) -> View {
    let left = builder.surface("left", left);
    let right = builder.surface("right", right);
    builder.sphere("left", LEFT, 0.4, left);
    builder.sphere("right", RIGHT, 0.4, right);
    (builder.finish(), into_the_box())
}

pub(crate) fn diffuse_spheres() -> View {
    let grey = Surface::Diffuse {
        reflectance: Rgb::splat(0.8),
    };
    two_spheres(cornell_box("diffuse spheres"), grey, grey)
}

pub(crate) fn mirror_and_glass() -> View {
    let (white, tint) = (Rgb::ONE, Rgb::new(0.9, 1.0, 0.8));
    let mirror = Surface::Mirror { reflectance: white };
    let glass = Surface::Glass {
        reflectance: white,
        transmittance: tint,
        ior: 1.45,
    };
    two_spheres(cornell_box("mirror and glass"), mirror, glass)
}

pub(crate) fn conductors() -> View {
    let metal = |alpha| Surface::Microfacet {
        alpha,
        eta: Rgb::new(0.2, 0.92, 1.1),
        k: Rgb::new(3.9, 2.45, 2.14),
    };
    two_spheres(cornell_box("conductors"), metal(0.15), metal(0.5))
}

fn turned(towards: DVec3) -> DMat4 {
    DMat4::from_quat(DQuat::from_rotation_arc(DVec3::NEG_Z, towards.normalize()))
}

/// The lights that only sampling finds: name, kind, placement.
pub(crate) fn delta_lights() -> [(&'static str, LightKind, DMat4); 3] {
    let point = LightKind::Point {
        intensity: Rgb::new(1.0, 0.7, 0.4),
    };
    let spot = LightKind::Spot {
        intensity: Rgb::new(2.0, 4.0, 3.0),
        cone_angle: 70_f64.to_radians(),
        exponent: 2.0,
    };
    let sun = LightKind::Directional {
        irradiance: Rgb::new(0.5, 0.6, 1.0),
    };
    [
        (
            "point",
            point,
            DMat4::from_translation(DVec3::new(-0.5, 1.2, 0.2)),
        ),
        (
            "spot",
            spot,
            DMat4::from_translation(DVec3::new(0.6, 1.4, 0.6))
                * turned(DVec3::new(-0.4, -1.0, -0.5)),
        ),
        ("sun", sun, turned(DVec3::new(0.3, -0.4, -1.0))),
    ]
}

/// A box without its area light, with two spheres, and the lights that `keep` names.
pub(crate) fn delta_lit(keep: &[&str]) -> View {
    let mut builder = dark_box("delta lights");
    for (name, kind, place) in delta_lights() {
        if keep.contains(&name) {
            builder.light(name, kind, place);
        }
    }
    let grey = Surface::Diffuse {
        reflectance: Rgb::splat(0.8),
    };
    let metal = Surface::Microfacet {
        alpha: 0.3,
        eta: Rgb::new(0.2, 0.92, 1.1),
        k: Rgb::new(3.9, 2.45, 2.14),
    };
    two_spheres(builder, grey, metal)
}

/// A box whose ceiling light is switched off.
fn dark_box(name: &str) -> SceneBuilder {
    let mut builder = cornell_box(name);
    for material in &mut builder.scene_mut().materials {
        material.emission = Rgb::ZERO;
    }
    builder
}

pub(crate) fn many_small_lights() -> View {
    let mut builder = dark_box("16 small lights");
    for i in 0..16_u32 {
        let (row, column) = (f64::from(i / 4), f64::from(i % 4));
        // Powers from 1 to 16.
        let radiance = 2.0 * Rgb::new(1.0 + i as f32, 9.0, 16.0 - i as f32);
        let light = builder.emitter("light", radiance);
        builder.quad(
            "light",
            DVec3::new(-0.85 + 0.5 * column, 1.4, -0.85 + 0.5 * row),
            DVec3::X * 0.2,
            DVec3::Z * 0.2,
            light,
        );
    }
    let grey = Surface::Diffuse {
        reflectance: Rgb::splat(0.8),
    };
    two_spheres(builder, grey, grey)
}

/// A shelf of lights that look up, down and aside between the objects and the ceiling, so that most
/// are behind most surfaces; more than one level of a tree.
pub(crate) fn lights_in_between() -> View {
    let mut builder = dark_box("lights in between");
    for i in 0..72_u32 {
        let at = DVec3::new(
            -0.8 + 0.2 * f64::from(i % 9),
            0.9 + 0.1 * f64::from(i % 2),
            -0.8 + 0.2 * f64::from(i / 9),
        );
        let radiance = 3.0 * Rgb::new(1.0 + (i % 5) as f32, 4.0, 1.0 + (i % 7) as f32);
        let light = builder.emitter("light", radiance);
        let (u, v) = match i % 3 {
            0 => (DVec3::X, DVec3::Z),
            1 => (DVec3::Z, DVec3::X),
            _ => (DVec3::Y, DVec3::Z),
        };
        builder.quad("light", at, 0.07 * u, 0.07 * v, light);
    }
    let grey = Surface::Diffuse {
        reflectance: Rgb::splat(0.8),
    };
    let metal = Surface::Microfacet {
        alpha: 0.4,
        eta: Rgb::splat(1.1),
        k: Rgb::splat(3.0),
    };
    two_spheres(builder, grey, metal)
}

/// A ground with a diffuse and a metal sphere under the open sky.
fn outdoors(name: &str) -> (SceneBuilder, Camera) {
    let mut builder = SceneBuilder::new(name);
    let ground = builder.diffuse("ground", Rgb::new(0.5, 0.45, 0.4));
    let grey = builder.diffuse("grey", Rgb::splat(0.8));
    let metal = builder.surface(
        "metal",
        Surface::Microfacet {
            alpha: 0.25,
            eta: Rgb::new(0.2, 0.92, 1.1),
            k: Rgb::new(3.9, 2.45, 2.14),
        },
    );
    builder.quad(
        "ground",
        DVec3::new(-3.0, 0.0, -3.0),
        DVec3::Z * 6.0,
        DVec3::X * 6.0,
        ground,
    );
    builder.sphere("grey", DVec3::new(-0.6, 0.5, 0.0), 0.5, grey);
    builder.sphere("metal", DVec3::new(0.6, 0.5, 0.0), 0.5, metal);
    let camera = camera(DVec3::new(0.5, 1.2, 4.0), DVec3::new(0.0, 0.6, 0.0), 45.0);
    (builder, camera)
}

pub(crate) fn constant_sky() -> View {
    let (mut builder, camera) = outdoors("constant sky");
    builder.scene_mut().environment.sky = Rgb::new(0.5, 0.7, 1.0);
    (builder.finish(), camera)
}

/// A box with a window at the front, lit by the sky alone.
pub(crate) fn open_box() -> View {
    let grey = Surface::Diffuse {
        reflectance: Rgb::splat(0.8),
    };
    let mut builder = dark_box("open box");
    builder.scene_mut().environment.sky = Rgb::new(0.5, 0.7, 1.0);
    two_spheres(builder, grey, grey)
}

pub(crate) fn ambient() -> View {
    let (mut builder, camera) = outdoors("ambient");
    builder.scene_mut().environment.ambient = Rgb::new(1.0, 0.8, 0.6);
    (builder.finish(), camera)
}

/// A dim gradient, dark ground and a sun of one texel, a hundred times brighter.
pub(crate) fn sunny_map() -> EnvironmentMap {
    let (width, height) = (24, 12);
    let texel = |i: usize| {
        let (x, y) = (i % width, i / width);
        if (x, y) == (17, 3) {
            return Rgb::new(60.0, 50.0, 40.0);
        }
        let up = (PI * (y as f64 + 0.5) / height as f64).cos() as f32;
        Rgb::new(0.3, 0.4, 0.6) * up.max(0.0) + 0.02
    };
    EnvironmentMap {
        path: PathBuf::from("sunny"),
        image: Arc::new(Image::from_pixels(
            width,
            height,
            (0..width * height).map(texel).collect(),
        )),
    }
}

pub(crate) fn environment_with_sun() -> View {
    let (mut builder, camera) = outdoors("environment with a sun");
    builder.scene_mut().environment.map = Some(sunny_map());
    (builder.finish(), camera)
}

pub(crate) fn emissive_sphere() -> View {
    let mut builder = dark_box("emissive sphere");
    let light = builder.emitter("bulb", Rgb::new(9.0, 6.0, 3.0));
    builder.sphere("bulb", DVec3::new(0.1, 1.1, -0.2), 0.2, light);
    let grey = Surface::Diffuse {
        reflectance: Rgb::splat(0.8),
    };
    two_spheres(builder, grey, grey)
}

/// A bowl of many triangles that shines from its inside, downwards.
pub(crate) fn emissive_mesh() -> View {
    let mut builder = dark_box("emissive mesh");
    let light = builder.emitter("lamp", Rgb::new(3.0, 6.0, 9.0));
    let (positions, triangles) = sphere_mesh(0.3, (0.2, 1.5), 10, 24);
    let center = DVec3::new(0.0, 1.05, 0.1);
    let positions = positions
        .iter()
        .map(|&p| center + p * DVec3::new(1.0, 0.6, 1.4))
        .collect();
    builder.mesh("lamp", positions, &inside_out(&triangles), light);
    let grey = Surface::Diffuse {
        reflectance: Rgb::splat(0.8),
    };
    two_spheres(builder, grey, grey)
}

/// A light node without a mesh, upright, facing the spheres from the left.
pub(crate) fn lone_rectangle() -> View {
    let mut builder = dark_box("lone rectangle");
    let kind = LightKind::Area {
        radiance: Rgb::new(8.0, 7.0, 6.0),
    };
    let place = DMat4::from_translation(DVec3::new(-0.8, 0.9, 0.7))
        * turned(DVec3::new(1.0, -0.3, -0.6))
        * DMat4::from_scale(DVec3::new(0.5, 0.3, 1.0));
    builder.light("panel", kind, place);
    let grey = Surface::Diffuse {
        reflectance: Rgb::splat(0.8),
    };
    two_spheres(builder, grey, grey)
}

/// A panel and a sphere so large that uniform directions find them about every third time.
pub(crate) fn wide_lights() -> View {
    let (mut builder, camera) = outdoors("wide lights");
    let panel = builder.emitter("panel", Rgb::new(1.0, 0.9, 0.8));
    builder.quad(
        "panel",
        DVec3::new(-3.0, 1.9, -3.0),
        DVec3::X * 6.0,
        DVec3::Z * 5.0,
        panel,
    );
    let ball = builder.emitter("ball", Rgb::new(0.6, 0.8, 1.0));
    builder.sphere("ball", DVec3::new(0.0, 1.2, 6.5), 2.0, ball);
    (builder.finish(), camera)
}

/// Ceiling light, point light and map at once, each only if named in `keep`.
pub(crate) fn mixed(keep: &[&str]) -> View {
    let mut builder = if keep.contains(&"area") {
        cornell_box("mixed lights")
    } else {
        dark_box("mixed lights")
    };
    let (name, kind, place) = delta_lights()[0];
    if keep.contains(&name) {
        builder.light(name, kind, place);
    }
    if keep.contains(&"map") {
        builder.scene_mut().environment.map = Some(sunny_map());
    }
    let grey = Surface::Diffuse {
        reflectance: Rgb::splat(0.8),
    };
    let metal = Surface::Microfacet {
        alpha: 0.3,
        eta: Rgb::splat(1.1),
        k: Rgb::splat(3.0),
    };
    two_spheres(builder, grey, metal)
}
