//! Scenes that between them use every material, light and kind of surface.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use glam::{DMat4, DVec3};
use softbox::camera::{Camera, Framing};
use softbox::color::Rgb;
use softbox::image::Image;
use softbox::scene::{
    EnvironmentMap, LightKind, Material, PrepareSettings, PreparedScene, Scene, SceneBuilder,
    Surface, cornell_box, prepare,
};

/// A scene and from where it is seen.
pub(crate) struct View {
    scene: Scene,
    pub(crate) camera: Camera,
}

impl View {
    fn new(builder: SceneBuilder, eye: DVec3, target: DVec3, degrees: f64) -> Self {
        Self {
            scene: builder.finish(),
            camera: Camera {
                eye,
                target,
                framing: Framing::Horizontal(degrees.to_radians()),
                ..Camera::default()
            },
        }
    }

    /// A scene in the Cornell box from where the box is seen whole.
    fn of_box(builder: SceneBuilder) -> Self {
        let (eye, target) = (DVec3::new(0.0, 0.75, 4.8), DVec3::new(0.0, 0.75, 0.0));
        Self::new(builder, eye, target, 31.0)
    }

    pub(crate) fn prepared(&self, settings: &PrepareSettings) -> PreparedScene {
        prepare(&self.scene, settings, &|_, _| ControlFlow::Continue(()))
            .expect("nothing asks it to stop")
    }
}

const MIRROR: Surface = Surface::Mirror {
    reflectance: Rgb::splat(0.9),
};
const GLASS: Surface = Surface::Glass {
    reflectance: Rgb::splat(0.95),
    transmittance: Rgb::new(0.9, 0.95, 1.0),
    ior: 1.45,
};
const CLEAR: Surface = Surface::Refraction {
    transmittance: Rgb::new(1.0, 0.9, 0.8),
    ior: 1.3,
};
/// Near the place of the left and of the right object in the box.
const LEFT: DVec3 = DVec3::new(-0.45, 0.35, -0.3);
const RIGHT: DVec3 = DVec3::new(0.45, 0.35, 0.2);

fn metal(alpha: f32) -> Surface {
    Surface::Microfacet {
        alpha,
        eta: Rgb::new(0.2, 0.92, 1.1),
        k: Rgb::new(3.9, 2.45, 2.1),
    }
}

pub(crate) fn diffuse() -> View {
    let mut builder = cornell_box("diffuse");
    let grey = builder.diffuse("grey", Rgb::new(0.7, 0.6, 0.5));
    let glow = builder.emitter("glow", Rgb::new(3.0, 2.0, 1.0));
    turned_box(&mut builder, LEFT, DVec3::new(0.25, 0.34, 0.25), grey);
    builder.sphere("ball", RIGHT, 0.34, grey);
    builder.sphere("lamp", DVec3::new(0.6, 1.1, -0.5), 0.12, glow);
    View::of_box(builder)
}

pub(crate) fn mirror_and_glass() -> View {
    let mut builder = cornell_box("mirror and glass");
    let [mirror, glass, clear] =
        [MIRROR, GLASS, CLEAR].map(|surface| builder.surface("smooth", surface));
    builder.sphere("mirror", LEFT, 0.34, mirror);
    builder.sphere("glass", RIGHT, 0.34, glass);
    let middle = DVec3::new(0.1, 0.9, -0.5);
    turned_box(&mut builder, middle, DVec3::splat(0.2), clear);
    View::of_box(builder)
}

pub(crate) fn rough_metal() -> View {
    let mut builder = cornell_box("metal");
    let [polished, brushed, rough] =
        [0.05, 0.2, 0.5].map(|alpha| builder.surface("metal", metal(alpha)));
    builder.sphere("polished", LEFT, 0.34, polished);
    builder.sphere("rough", RIGHT, 0.34, rough);
    let middle = DVec3::new(0.05, 0.5, -0.6);
    turned_box(&mut builder, middle, DVec3::new(0.2, 0.48, 0.2), brushed);
    View::of_box(builder)
}

/// Lights of every kind that only sampling finds, and an area light as a node.
pub(crate) fn delta_lights() -> View {
    let mut builder = cornell_box("lights");
    let white = builder.diffuse("white ball", Rgb::splat(0.8));
    let rough = builder.surface("metal", metal(0.3));
    builder.sphere("ball", RIGHT, 0.34, white);
    builder.sphere("metal", LEFT, 0.34, rough);
    let at = |x, y, z| DMat4::from_translation(DVec3::new(x, y, z));
    let point = LightKind::Point {
        intensity: Rgb::new(0.5, 1.0, 0.5),
    };
    builder.light("point", point, at(-0.6, 1.0, 0.4));
    let spot = LightKind::Spot {
        intensity: Rgb::new(3.0, 1.0, 1.0),
        cone_angle: 0.9,
        exponent: 2.5,
    };
    let tilt = DMat4::from_rotation_x(-1.2);
    builder.light("spot", spot, at(0.3, 1.3, 0.6) * tilt);
    let sun = LightKind::Directional {
        irradiance: Rgb::new(0.5, 0.5, 1.0),
    };
    let slant = DMat4::from_rotation_y(0.3) * DMat4::from_rotation_x(-0.4);
    builder.light("sun", sun, slant);
    let panel = LightKind::Area {
        radiance: Rgb::new(1.0, 2.0, 4.0),
    };
    let size = DMat4::from_scale(DVec3::new(0.2, 0.4, 1.0));
    builder.light("panel", panel, at(0.7, 1.2, 0.1) * tilt * size);
    View::of_box(builder)
}

/// Some hundred lights of all kinds, enough for a tree of several levels, and a sun.
pub(crate) fn many_lights() -> View {
    let mut builder = SceneBuilder::new("many lights");
    let white = builder.diffuse("white", Rgb::splat(0.7));
    let rough = builder.surface("metal", metal(0.3));
    let corner = DVec3::new(-2.0, 0.0, -2.0);
    builder.quad("floor", corner, DVec3::Z * 4.0, DVec3::X * 4.0, white);
    builder.sphere("ball", RIGHT, 0.34, white);
    builder.sphere("metal", LEFT, 0.34, rough);
    let point = LightKind::Point {
        intensity: Rgb::new(0.02, 0.04, 0.03),
    };
    let spot = LightKind::Spot {
        intensity: Rgb::new(0.3, 0.2, 0.1),
        cone_angle: 1.2,
        exponent: 1.0,
    };
    let sun = LightKind::Directional {
        irradiance: Rgb::new(0.1, 0.1, 0.2),
    };
    builder.light("sun", sun, DMat4::from_rotation_x(-1.0));
    for i in 0..150_u32 {
        let (row, column) = (f64::from(i / 15), f64::from(i % 15));
        let height = 1.2 + 0.3 * (row * 1.7 + column).sin();
        let at = DVec3::new(-1.75 + 0.25 * column, height, -1.75 + 0.39 * row);
        let glow = builder.emitter("glow", Rgb::new(1.0, 2.0, 4.0) * (1.0 + (i % 4) as f32));
        let place = DMat4::from_translation(at);
        match i % 5 {
            0 => builder.light("point", point, place),
            1 => builder.light("spot", spot, place * DMat4::from_rotation_x(-1.3)),
            2 => builder.sphere("lamp", at, 0.03, glow),
            3 => turned_box(&mut builder, at, DVec3::splat(0.04), glow),
            _ => builder.quad("panel", at, DVec3::X * 0.1, DVec3::Z * 0.1, glow),
        }
    }
    View::of_box(builder)
}

/// Sky, ambient light and a picture with a sun.
pub(crate) fn outdoors() -> View {
    let mut builder = SceneBuilder::new("outdoors");
    let ground = builder.diffuse("ground", Rgb::new(0.4, 0.5, 0.3));
    let brushed = builder.surface("metal", metal(0.2));
    let glass = builder.surface("glass", GLASS);
    let corner = DVec3::new(-3.0, 0.0, -3.0);
    builder.quad("ground", corner, DVec3::Z * 6.0, DVec3::X * 6.0, ground);
    builder.sphere("ball", DVec3::new(-0.9, 0.5, 0.0), 0.5, ground);
    builder.sphere("metal", DVec3::new(0.2, 0.5, -0.3), 0.5, brushed);
    builder.sphere("glass", DVec3::new(1.1, 0.4, 0.7), 0.39, glass);
    let mut texels: Vec<Rgb> = (0..24 * 13)
        .map(|i| Rgb::new(0.1, 0.2, 0.4) + Rgb::splat((i * 7 % 11) as f32 * 0.05))
        .collect();
    texels[3 * 24 + 17] = Rgb::new(40.0, 35.0, 30.0);
    let environment = &mut builder.scene_mut().environment;
    environment.map = Some(EnvironmentMap {
        path: "sky".into(),
        image: Image::from_pixels(24, 13, texels).into(),
    });
    environment.sky = Rgb::new(0.05, 0.05, 0.1);
    environment.ambient = Rgb::splat(0.2);
    let (eye, target) = (DVec3::new(0.3, 1.6, 4.5), DVec3::new(0.1, 0.4, 0.0));
    View::new(builder, eye, target, 45.0)
}

/// Coarse rings whose normals are interpolated: diffuse, metal, glass, and one that glows.
pub(crate) fn smooth_meshes() -> View {
    let mut builder = cornell_box("meshes");
    let grey = builder.diffuse("grey", Rgb::splat(0.7));
    let rough = builder.surface("metal", metal(0.3));
    let glass = builder.surface("glass", GLASS);
    let glowing = glowing(&mut builder);
    ring(&mut builder, LEFT, grey);
    ring(&mut builder, RIGHT, rough);
    ring(&mut builder, LEFT + DVec3::Y * 0.6, glass);
    ring(&mut builder, RIGHT + DVec3::Y * 0.6, glowing);
    View::of_box(builder)
}

pub(crate) fn seen_through_a_lens() -> View {
    let view = diffuse();
    let camera = Camera {
        lens_radius: 0.1,
        focal_distance: 4.0,
        ..view.camera
    };
    View { camera, ..view }
}

/// A triangle that shines, upright between a ball that it cuts and two walls that it touches; with
/// `is_lamp` the base of a pyramid all of which shines.
pub(crate) fn triangles_that_shine(is_lamp: bool) -> View {
    let mut builder = SceneBuilder::new("triangles that shine");
    let grey = builder.diffuse("grey", Rgb::splat(0.7));
    let lamp = glowing(&mut builder);
    let [a, b, c] = [
        DVec3::new(-0.4, 0.3, 0.1),
        DVec3::new(0.6, 0.2, -0.2),
        DVec3::new(0.1, 1.1, 0.05),
    ];
    let top = DVec3::new(0.2, 0.6, 0.4);
    let faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];
    let faces = if is_lamp { &faces[..] } else { &faces[..1] };
    builder.mesh("lamp", vec![a, b, c, top], faces, lamp);
    builder.sphere("ball", b, 0.3, grey);
    builder.quad("on its edge", a, b - a, DVec3::Z, grey);
    builder.quad("behind", a - DVec3::Z * 0.51, DVec3::X, DVec3::Y, grey);
    builder.quad(
        "floor",
        DVec3::new(-2.0, 0.0, 2.0),
        DVec3::X * 4.0,
        DVec3::Z * -4.0,
        grey,
    );
    let target = DVec3::new(0.1, 0.5, 0.0);
    View::new(builder, DVec3::new(-0.3, 1.2, 3.0), target, 35.0)
}

/// A ball in a sphere that emits inwards, all far from the origin and in large units.
pub(crate) fn inside_a_lamp() -> View {
    let mut builder = SceneBuilder::new("lamp");
    let grey = builder.diffuse("grey", Rgb::splat(0.7));
    let glowing = glowing(&mut builder);
    let center = DVec3::new(3e5, -1e5, 7e4);
    builder.sphere("room", center, 200.0, glowing);
    builder.sphere("ball", center - DVec3::Y * 50.0, 50.0, grey);
    View::new(builder, center + DVec3::new(0.0, 30.0, 150.0), center, 60.0)
}

/// A coarse barrel of radiance 1 that reflects, with interpolated normals, alone in the dark. It is
/// convex, so it does not see itself.
pub(crate) fn barrel_lamp() -> View {
    const COLUMNS: u32 = 11;
    const ROWS: u32 = 6;
    let mut builder = SceneBuilder::new("lamp");
    let material = builder.material(Material {
        name: "lamp".to_owned(),
        surface: Surface::Diffuse {
            reflectance: Rgb::splat(0.9),
        },
        emission: Rgb::ONE,
        double_sided: true,
    });
    let center = DVec3::new(0.13, 0.57, 0.29);
    let positions = (0..ROWS * COLUMNS)
        .map(|i| {
            let (sin, cos) = (TAU * f64::from(i % COLUMNS) / f64::from(COLUMNS)).sin_cos();
            let height = f64::from(i / COLUMNS) / f64::from(ROWS - 1) - 0.5;
            let radius = 0.5 - height * height;
            center + DVec3::new(radius * cos, height, radius * sin)
        })
        .collect();
    let triangles: Vec<[u32; 3]> = (0..(ROWS - 1) * COLUMNS)
        .flat_map(|i| {
            let next = i - i % COLUMNS + (i + 1) % COLUMNS;
            let (above, above_next) = (i + COLUMNS, next + COLUMNS);
            [[i, above, above_next], [i, above_next, next]]
        })
        .collect();
    builder.mesh("barrel", positions, &triangles, material);
    View::new(builder, center + DVec3::Z * 3.0, center, 25.0)
}

/// A surface that reflects and emits, on both sides.
fn glowing(builder: &mut SceneBuilder) -> usize {
    builder.material(Material {
        name: "glowing".to_owned(),
        surface: Surface::Diffuse {
            reflectance: Rgb::splat(0.3),
        },
        emission: Rgb::new(2.0, 1.0, 0.5),
        double_sided: true,
    })
}

/// A closed box of half extent `half` around `middle`, turned about the vertical axis.
fn turned_box(builder: &mut SceneBuilder, middle: DVec3, half: DVec3, material: usize) {
    let place = DMat4::from_translation(middle) * DMat4::from_rotation_y(0.3);
    let positions = (0..8_u32)
        .map(|corner| {
            let side = |bit: u32| f64::from((corner >> bit) & 1) * 2.0 - 1.0;
            place.transform_point3(half * DVec3::new(side(0), side(1), side(2)))
        })
        .collect();
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles: Vec<[u32; 3]> = quads
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .collect();
    builder.mesh("box", positions, &triangles, material);
}

/// A torus of 13 × 9 quads that faces the camera, front outside.
fn ring(builder: &mut SceneBuilder, center: DVec3, material: usize) {
    const AROUND: u32 = 13;
    const ALONG: u32 = 9;
    let at = |i: u32, j: u32| {
        let (sin, cos) = (TAU * f64::from(i) / f64::from(AROUND)).sin_cos();
        let (height, out) = (TAU * f64::from(j) / f64::from(ALONG)).sin_cos();
        let radial = DVec3::new(cos, sin, 0.0);
        center + radial * (0.2 + 0.09 * out) + DVec3::Z * (0.09 * height)
    };
    let pairs = || (0..AROUND).flat_map(|i| (0..ALONG).map(move |j| (i, j)));
    let positions = pairs().map(|(i, j)| at(i, j)).collect();
    let vertex = |i: u32, j: u32| i % AROUND * ALONG + j % ALONG;
    let triangles: Vec<[u32; 3]> = pairs()
        .flat_map(|(i, j)| {
            let [a, b] = [vertex(i, j), vertex(i + 1, j)];
            let [c, d] = [vertex(i + 1, j + 1), vertex(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    builder.mesh("ring", positions, &triangles, material);
}
