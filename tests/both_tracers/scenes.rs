//! Small scenes, each for one way through the lanes.

use std::sync::Arc;

use glam::{DMat4, DQuat, DVec3};
use softbox::camera::{Camera, Framing};
use softbox::color::Rgb;
use softbox::geometry::{Corner, Mesh, MeshTriangle};
use softbox::image::Image;
use softbox::scene::{
    EnvironmentMap, Geometry, Instance, LightKind, Scene, SceneBuilder, Surface, cornell_box,
};

use crate::support::{glowing, inside_out, sphere_mesh};

/// A scene with the camera that looks at it.
pub(crate) type View = (Scene, Camera);

const LEFT: DVec3 = DVec3::new(-0.45, 0.4, -0.3);
const RIGHT: DVec3 = DVec3::new(0.45, 0.4, 0.35);

fn camera(eye: DVec3, target: DVec3, degrees: f64) -> Camera {
    Camera {
        eye,
        target,
        framing: Framing::Horizontal(degrees.to_radians()),
        ..Camera::default()
    }
}

fn into_the_box(builder: SceneBuilder) -> View {
    let camera = camera(DVec3::new(0.0, 0.75, 4.8), DVec3::new(0.0, 0.75, 0.0), 31.0);
    (builder.finish(), camera)
}

/// A box whose ceiling light is switched off.
fn dark_box(name: &str) -> SceneBuilder {
    let mut builder = cornell_box(name);
    for material in &mut builder.scene_mut().materials {
        material.emission = Rgb::ZERO;
    }
    builder
}

fn metal(alpha: f32) -> Surface {
    Surface::Microfacet {
        alpha,
        eta: Rgb::new(0.2, 0.92, 1.1),
        k: Rgb::new(3.9, 2.45, 2.14),
    }
}

fn glass() -> Surface {
    Surface::Glass {
        reflectance: Rgb::ONE,
        transmittance: Rgb::new(0.9, 1.0, 0.8),
        ior: 1.45,
    }
}

/// A ball that nearly touches the light, and one far below.
pub(crate) fn ceiling_light() -> View {
    let mut builder = cornell_box("ceiling light");
    let grey = builder.diffuse("grey", Rgb::splat(0.8));
    let black = builder.diffuse("black", Rgb::new(0.0, 0.5, 0.0));
    builder.sphere("high", DVec3::new(0.1, 1.28, 0.1), 0.2, grey);
    builder.sphere("low", RIGHT, 0.4, black);
    into_the_box(builder)
}

/// The front only, or the front and the back.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Side {
    Front,
    Both,
}

pub(crate) const SIDES: [Side; 2] = [Side::Front, Side::Both];

/// A surface that shines; one that shines on both sides reflects, too.
fn lamp(builder: &mut SceneBuilder, side: Side) -> usize {
    match side {
        Side::Front => builder.emitter("lamp", Rgb::new(6.0, 5.0, 4.0)),
        Side::Both => glowing(builder, 0.4, 5.0),
    }
}

/// A slanted light upright in the middle of the room. One wall lies on its plane, one stands on its
/// edge, one runs right behind it, a ball is cut by it.
pub(crate) fn light_between_walls(side: Side) -> View {
    let mut builder = dark_box("light between walls");
    let lamp = lamp(&mut builder, side);
    let grey = builder.diffuse("grey", Rgb::splat(0.8));
    let (corner, u, v) = (
        DVec3::new(0.0, 0.5, -0.25),
        DVec3::new(0.0, 0.1, 0.6),
        DVec3::new(0.0, 0.4, 0.1),
    );
    builder.quad("lamp", corner, u, v, lamp);
    builder.quad("on its plane", corner + v, u, v, grey);
    builder.quad("below, too", corner - v, u, v, grey);
    builder.quad("on its edge", corner, DVec3::X * 0.4, u, grey);
    builder.quad("behind", corner + DVec3::X * 1e-3, v, u, grey);
    builder.sphere("cut", corner + u, 0.15, grey);
    into_the_box(builder)
}

/// Everything is near the light.
pub(crate) fn glowing_ceiling() -> View {
    let mut builder = dark_box("glowing ceiling");
    let lamp = builder.emitter("lamp", Rgb::new(1.0, 0.9, 0.8));
    let corner = DVec3::new(-1.0, 1.495, -1.0);
    builder.quad("lamp", corner, DVec3::X * 2.0, DVec3::Z * 2.0, lamp);
    let grey = builder.diffuse("grey", Rgb::splat(0.8));
    builder.sphere("ball", LEFT, 0.4, grey);
    into_the_box(builder)
}

/// One triangle is all that shines.
pub(crate) fn triangle_light(side: Side) -> View {
    let mut builder = dark_box("triangle light");
    let lamp = lamp(&mut builder, side);
    let corners = [
        DVec3::new(-0.5, 1.4, -0.6),
        DVec3::new(0.6, 1.2, -0.4),
        DVec3::new(0.0, 1.3, 0.7),
    ];
    builder.mesh("lamp", corners.to_vec(), &[[0, 1, 2]], lamp);
    let grey = builder.diffuse("grey", Rgb::splat(0.8));
    builder.sphere("ball", RIGHT, 0.4, grey);
    builder.sphere("cut", corners[0], 0.3, grey);
    into_the_box(builder)
}

/// A light node without a mesh, upright.
pub(crate) fn light_node() -> View {
    let mut builder = dark_box("light node");
    let kind = LightKind::Area {
        radiance: Rgb::new(8.0, 7.0, 6.0),
    };
    let place = DMat4::from_translation(DVec3::new(-0.8, 0.9, 0.7))
        * turned(DVec3::new(1.0, -0.3, -0.6))
        * DMat4::from_scale(DVec3::new(0.5, 0.3, 1.0));
    builder.light("panel", kind, place);
    let grey = builder.diffuse("grey", Rgb::splat(0.8));
    builder.sphere("ball", RIGHT, 0.4, grey);
    into_the_box(builder)
}

fn turned(towards: DVec3) -> DMat4 {
    DMat4::from_quat(DQuat::from_rotation_arc(DVec3::NEG_Z, towards.normalize()))
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Sky {
    Constant,
    Ambient,
    Picture,
}

pub(crate) const SKIES: [Sky; 3] = [Sky::Constant, Sky::Ambient, Sky::Picture];

/// Balls on a ground below a panel and a sky.
pub(crate) fn light_and_sky(sky: Sky) -> View {
    let mut builder = SceneBuilder::new("light and sky");
    let ground = builder.diffuse("ground", Rgb::new(0.5, 0.45, 0.4));
    let rough = builder.surface("metal", metal(0.25));
    let panel = builder.emitter("panel", Rgb::new(4.0, 3.0, 2.0));
    let corner = DVec3::new(-3.0, 0.0, -3.0);
    builder.quad("ground", corner, DVec3::Z * 6.0, DVec3::X * 6.0, ground);
    builder.sphere("ball", DVec3::new(-0.6, 0.5, 0.0), 0.5, ground);
    builder.sphere("metal", DVec3::new(0.6, 0.5, 0.0), 0.5, rough);
    let corner = DVec3::new(-0.5, 1.3, -0.5);
    builder.quad("panel", corner, DVec3::X, DVec3::Z, panel);
    let environment = &mut builder.scene_mut().environment;
    match sky {
        Sky::Constant => environment.sky = Rgb::new(0.5, 0.7, 1.0),
        Sky::Ambient => environment.ambient = Rgb::new(1.0, 0.8, 0.6),
        Sky::Picture => {
            let mut texels = vec![Rgb::new(0.1, 0.2, 0.3); 24 * 12];
            texels[3 * 24 + 17] = Rgb::new(60.0, 50.0, 40.0);
            environment.map = Some(EnvironmentMap {
                path: "sunny".into(),
                image: Arc::new(Image::from_pixels(24, 12, texels)),
            });
        }
    }
    let camera = camera(DVec3::new(0.5, 1.2, 4.0), DVec3::new(0.0, 0.6, 0.0), 45.0);
    (builder.finish(), camera)
}

/// Point, spot and sun, alone or with the light of the ceiling.
pub(crate) fn delta_lights(with_area: bool) -> View {
    let name = "delta lights";
    let mut builder = if with_area {
        cornell_box(name)
    } else {
        dark_box(name)
    };
    let at = |x, y, z| DMat4::from_translation(DVec3::new(x, y, z));
    let point = LightKind::Point {
        intensity: Rgb::new(1.0, 0.7, 0.4),
    };
    builder.light("point", point, at(-0.5, 1.2, 0.2));
    let spot = LightKind::Spot {
        intensity: Rgb::new(2.0, 4.0, 3.0),
        cone_angle: 1.2,
        exponent: 2.0,
    };
    let down = turned(DVec3::new(-0.4, -1.0, -0.5));
    builder.light("spot", spot, at(0.6, 1.4, 0.6) * down);
    let sun = LightKind::Directional {
        irradiance: Rgb::new(0.5, 0.6, 1.0),
    };
    builder.light("sun", sun, turned(DVec3::new(0.3, -0.4, -1.0)));
    let grey = builder.diffuse("grey", Rgb::splat(0.8));
    builder.sphere("left", LEFT, 0.4, grey);
    builder.sphere("right", RIGHT, 0.4, grey);
    into_the_box(builder)
}

/// Panels, bulbs, a glowing mesh and point lights, enough for a tree.
pub(crate) fn many_lights() -> View {
    let mut builder = dark_box("many lights");
    for i in 0..40_u32 {
        let (row, column) = (f64::from(i / 8), f64::from(i % 8));
        let at = DVec3::new(-0.8 + 0.2 * column, 1.0 + 0.05 * row, -0.8 + 0.35 * row);
        let lamp = builder.emitter("lamp", Rgb::new(9.0, 6.0, 1.0 + (i % 5) as f32));
        let point = LightKind::Point {
            intensity: Rgb::new(0.03, 0.02, 0.04),
        };
        match i % 4 {
            0 => builder.quad("panel", at, DVec3::X * 0.1, DVec3::Z * 0.1, lamp),
            1 => builder.sphere("bulb", at, 0.04, lamp),
            2 => builder.light("point", point, DMat4::from_translation(at)),
            _ => builder.quad("upright", at, DVec3::Y * 0.1, DVec3::Z * 0.1, lamp),
        }
    }
    let lamp = builder.emitter("lamp", Rgb::new(1.0, 2.0, 3.0));
    let (positions, triangles) = sphere_mesh(0.2, (0.3, 2.8), 4, 7);
    let positions = positions.iter().map(|&p| p + LEFT).collect();
    builder.mesh("lantern", positions, &inside_out(&triangles), lamp);
    let grey = builder.diffuse("grey", Rgb::splat(0.8));
    builder.sphere("ball", RIGHT, 0.4, grey);
    into_the_box(builder)
}

/// A ball with normals of its own, so coarse that they differ from those of its triangles.
fn smooth_ball() -> Mesh {
    let (positions, triangles) = sphere_mesh(1.0, (0.1, 3.0), 5, 9);
    let corner = |position| Corner {
        position,
        normal: position,
    };
    Mesh {
        name: "ball".to_owned(),
        normals: positions.iter().map(|p| p.normalize().as_vec3()).collect(),
        positions,
        triangles: triangles
            .iter()
            .map(|t| MeshTriangle {
                corners: t.map(corner),
                material_slot: 0,
            })
            .collect(),
    }
}

fn place(scene: &mut Scene, geometry: usize, at: DMat4, material: usize) {
    scene.instances.push(Instance {
        name: "ball".to_owned(),
        geometry,
        world_from_object: at,
        materials: vec![material],
    });
}

/// Mirror and glass under one light, which light samples suffice for, or under two of which one is a
/// ball, which are shared with the scattered ray.
pub(crate) fn caustics(with_lamp: bool) -> View {
    let mut builder = cornell_box("caustics");
    let reflectance = Rgb::new(1.0, 0.9, 0.8);
    let mirror = builder.surface("mirror", Surface::Mirror { reflectance });
    let glass = builder.surface("glass", glass());
    let grey = builder.diffuse("grey", Rgb::splat(0.6));
    builder.sphere("glass", RIGHT, 0.3, glass);
    builder.sphere("grey", DVec3::new(0.1, 0.2, -0.4), 0.2, grey);
    let (u, v) = (DVec3::new(0.0, 0.7, 0.1), DVec3::new(0.1, 0.0, 0.8));
    builder.quad("mirror", DVec3::new(-0.9, 0.2, -0.5), u, v, mirror);
    if with_lamp {
        let lamp = builder.emitter("lamp", Rgb::new(3.0, 6.0, 9.0));
        builder.sphere("lamp", LEFT, 0.1, lamp);
    }
    into_the_box(builder)
}

/// Every material next to plain ones, on spheres and on smooth meshes.
pub(crate) fn materials() -> View {
    let mut builder = cornell_box("materials");
    let white = Rgb::ONE;
    let surfaces = [
        Surface::Diffuse {
            reflectance: Rgb::new(0.9, 0.5, 0.2),
        },
        Surface::Mirror { reflectance: white },
        glass(),
        metal(0.3),
    ];
    builder
        .scene_mut()
        .geometries
        .push(Arc::new(Geometry::Mesh(smooth_ball())));
    let mesh = builder.scene_mut().geometries.len() - 1;
    for (surface, i) in surfaces.into_iter().zip(0..) {
        let material = builder.surface("ball", surface);
        let x = -0.7 + 0.45 * f64::from(i);
        builder.sphere("ball", DVec3::new(x, 0.3, 0.4), 0.2, material);
        let at = DMat4::from_translation(DVec3::new(x, 0.8, -0.2));
        let at = at * DMat4::from_scale(DVec3::splat(0.2));
        place(builder.scene_mut(), mesh, at, material);
    }
    into_the_box(builder)
}

/// Turned, mirrored and stretched copies of one smooth mesh.
pub(crate) fn smooth_copies() -> View {
    let mut builder = cornell_box("smooth copies");
    let grey = builder.diffuse("grey", Rgb::splat(0.8));
    let clear = builder.surface("glass", glass());
    let scene = builder.scene_mut();
    scene
        .geometries
        .push(Arc::new(Geometry::Mesh(smooth_ball())));
    let mesh = scene.geometries.len() - 1;
    for i in 0..12_u32 {
        let (row, column) = (f64::from(i / 4), f64::from(i % 4));
        let at = DVec3::new(-0.7 + 0.45 * column, 0.25 + 0.4 * row, -0.5 + 0.4 * row);
        let size = DVec3::new(0.15, 0.2, if i % 2 == 0 { 0.15 } else { -0.12 });
        let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), f64::from(i));
        let at = DMat4::from_scale_rotation_translation(size, turn, at);
        place(scene, mesh, at, if i % 5 == 4 { clear } else { grey });
    }
    into_the_box(builder)
}
