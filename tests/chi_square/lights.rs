use std::sync::Arc;

use glam::{DVec3, Vec3};
use softbox::color::Rgb;
use softbox::geometry::{Shapes, Sphere};
use softbox::image::Image;
use softbox::light::{
    AreaDensity, AreaLight, AreaShape, EnvironmentLight, Light, LightHit, LightSampleContext,
    SphereLight,
};

use crate::directions::Directions;
use crate::harness::Case;

/// All points of a light on the half line, in double precision.
pub(crate) fn hits(shapes: &Shapes, light: &Light, from: Vec3, wi: Vec3) -> Vec<LightHit> {
    let (o, d) = (from.as_dvec3(), wi.as_dvec3());
    let flat = |corner: Vec3, u: Vec3, v: Vec3, whole: bool, primitive: u32| {
        let (corner, u, v) = (corner.as_dvec3(), u.as_dvec3(), v.as_dvec3());
        let normal = u.cross(v);
        let t = (corner - o).dot(normal) / d.dot(normal);
        let p = o + t * d - corner;
        let n2 = normal.length_squared();
        let (a, b) = (p.cross(v).dot(normal) / n2, u.cross(p).dot(normal) / n2);
        let far = if whole { a.max(b) } else { a + b };
        (t > 0.0 && a >= 0.0 && b >= 0.0 && far <= 1.0).then(|| hit(o, d, t, normal, primitive))
    };
    match light {
        Light::Area(area) => match area.shape() {
            AreaShape::Rectangle {
                corner,
                edge_u,
                edge_v,
            } => flat(*corner, *edge_u, *edge_v, true, u32::MAX)
                .into_iter()
                .collect(),
            AreaShape::Triangles { primitives } => primitives
                .iter()
                .filter_map(|&id| {
                    let [p0, p1, p2] = shapes.vertices(id as usize);
                    flat(p0, p1 - p0, p2 - p0, false, id)
                })
                .collect(),
        },
        Light::Sphere(sphere) => {
            let ball = shapes
                .sphere(sphere.primitive)
                .expect("the light's sphere exists");
            let to_center = ball.center.as_dvec3() - o;
            let along = to_center.dot(d) / d.length_squared();
            let radius = f64::from(ball.radius);
            let half2 = radius * radius - (to_center - along * d).length_squared();
            let half = half2.max(0.0).sqrt() / d.length();
            let nearest = if along - half > 0.0 {
                along - half
            } else {
                along + half
            };
            let reached = half2 >= 0.0 && nearest > 0.0;
            let normal = nearest * d - to_center;
            reached
                .then(|| hit(o, d, nearest, normal, sphere.primitive))
                .into_iter()
                .collect()
        }
        _ => vec![LightHit::INFINITE],
    }
}

fn hit(o: DVec3, d: DVec3, t: f64, normal: DVec3, primitive: u32) -> LightHit {
    LightHit {
        point: (o + t * d).as_vec3(),
        normal: normal.normalize().as_vec3(),
        distance: (t * d.length()) as f32,
        primitive,
    }
}

/// A light seen from `from`; `radius` is its size in radians about `axis`.
fn case(name: &str, shapes: Shapes, light: Light, from: Vec3, view: (Vec3, f64)) -> Case {
    lit_case(
        name,
        shapes,
        light,
        LightSampleContext::all_around(from),
        view,
    )
}

/// The same for a surface.
fn lit_case(
    name: &str,
    shapes: Shapes,
    light: Light,
    from: LightSampleContext,
    (axis, radius): (Vec3, f64),
) -> Case {
    let directions = Directions::around(axis, radius);
    let scene = Arc::new((shapes, light));
    let same = Arc::clone(&scene);
    let total = move |scene: &(Shapes, Light), wi: Vec3| -> f64 {
        hits(&scene.0, &scene.1, from.point, wi)
            .into_iter()
            .map(|hit| f64::from(scene.1.pdf(&scene.0, &from, wi, hit)))
            .sum()
    };
    Case {
        name: name.to_owned(),
        sample: Box::new(move |numbers| {
            let (shapes, light) = &*scene;
            let s = light.sample(shapes, &from, numbers.choice, numbers.u)?;
            let off = |hit: &LightHit| {
                if hit.distance.is_finite() {
                    hit.point.distance(s.point) / s.distance
                } else {
                    0.0
                }
            };
            // Rounding may take the very edge off the light.
            let met = hits(shapes, light, from.point, s.wi)
                .into_iter()
                .filter(|hit| off(hit) < 1e-5)
                .min_by(|a, b| off(a).total_cmp(&off(b)));
            if let Some(hit) = met {
                let queried = light.pdf(shapes, &from, s.wi, hit);
                assert!(
                    (s.pdf / queried - 1.0).abs() < 2e-4,
                    "{light:?} {from:?} {s:?} {queried}"
                );
            }
            Some(directions.place(s.wi))
        }),
        density: Box::new(move |place| directions.density(place, |wi| total(&same, wi))),
        integral: None,
    }
}

fn rectangle(density: AreaDensity, two_sided: bool) -> Light {
    let shape = AreaShape::Rectangle {
        corner: Vec3::new(-0.4, 1.0, -0.3),
        edge_u: Vec3::new(0.8, 0.0, 0.0),
        edge_v: Vec3::new(0.1, 0.0, 0.6),
    };
    let area = AreaLight::new(&Shapes::default(), shape, Rgb::ONE, two_sided);
    Light::Area(area.with_density(density))
}

/// Triangles all of which shine, on one side.
fn of_triangles(positions: Vec<Vec3>, triangles: &[[u32; 3]]) -> (Shapes, Light) {
    let shapes = Shapes {
        positions,
        triangles: triangles.to_vec(),
        spheres: vec![],
    };
    let primitives = (0..triangles.len() as u32).collect();
    let shape = AreaShape::Triangles { primitives };
    let light = AreaLight::new(&shapes, shape, Rgb::ONE, false);
    (shapes, Light::Area(light))
}

/// A tetrahedron, a flat needle and a degenerate triangle.
fn mesh() -> (Shapes, Light) {
    let positions = vec![
        Vec3::ZERO,
        Vec3::X,
        Vec3::Y,
        Vec3::Z,
        Vec3::new(2.0, 0.3, 0.1),
        Vec3::new(2.01, 0.3, 1.9),
    ];
    let tetrahedron = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let others = [[1, 4, 5], [1, 1, 5]];
    of_triangles(positions, &[&tetrahedron[..], &others].concat())
}

fn sphere(two_sided: bool) -> (Shapes, Light) {
    let shapes = Shapes {
        spheres: vec![Sphere {
            center: Vec3::new(0.2, 1.0, -0.5),
            radius: 0.5,
        }],
        ..Shapes::default()
    };
    let light = SphereLight {
        primitive: 0,
        radiance: Rgb::ONE,
        two_sided,
    };
    (shapes, Light::Sphere(light))
}

/// Two triangles that are one parallelogram.
fn pair() -> (Shapes, Light) {
    let positions = vec![
        Vec3::new(-0.4, 1.0, -0.3),
        Vec3::new(0.4, 1.0, -0.3),
        Vec3::new(0.5, 1.0, 0.3),
        Vec3::new(-0.3, 1.0, 0.3),
    ];
    of_triangles(positions, &[[0, 1, 2], [0, 2, 3]])
}

/// One triangle, more than a half of [`pair`].
fn triangle() -> (Shapes, Light) {
    let positions = vec![
        Vec3::new(-0.4, 1.0, -0.3),
        Vec3::new(0.5, 1.0, -0.2),
        Vec3::new(0.1, 1.0, 0.3),
    ];
    of_triangles(positions, &[[0, 1, 2]])
}

/// Near and far, under the light and beside it, whole and partly below the horizon.
fn flat_cases(what: &str, make: fn() -> (Shapes, Light), height: f32) -> Vec<Case> {
    let places = [
        ("below", Vec3::new(0.1, -0.2, 0.05), 0.5),
        ("aslant", Vec3::new(3.0, 0.7, 0.2), 0.15),
        ("under it", Vec3::new(0.1, 0.9, 0.05), 2.0),
        ("almost on it", Vec3::new(0.1, 0.999, 0.05), 3.0),
        ("under its edge", Vec3::new(0.45, 0.7, 0.1), 1.0),
        ("near its edge", Vec3::new(0.6, height, 0.1), 0.8),
        ("beside its first edge", Vec3::new(0.1, 0.97, 0.33), 0.8),
    ];
    let normals = [
        ("all around", Vec3::ZERO),
        ("upright", Vec3::Y),
        ("turned", Vec3::new(-0.8, 0.36, 0.48)),
        ("away", Vec3::new(0.8, 0.6, 0.0)),
    ];
    let mut cases = vec![];
    for (place, point, size) in places {
        for (facing, normal) in normals {
            let (shapes, light) = make();
            let name = format!("{what} {place} {facing}");
            let from = LightSampleContext { point, normal };
            let view = (Vec3::new(0.05, 1.0, 0.0) - point, size);
            cases.push(lit_case(&name, shapes, light, from, view));
        }
    }
    cases
}

pub(crate) fn surface_cases() -> Vec<Case> {
    let none = Shapes::default;
    let mut cases = vec![];
    for (name, from, size) in [
        ("below", Vec3::new(0.1, 0.0, 0.05), 0.5),
        ("near", Vec3::new(0.1, 0.9, 0.05), 2.0),
        ("aslant", Vec3::new(3.0, 0.7, 0.2), 0.15),
        ("afar", Vec3::new(2.5, -15.0, 4.5), 0.04),
    ] {
        let view = (Vec3::Y - from, size);
        let light = rectangle(AreaDensity::Correct, false);
        cases.push(case(
            &format!("rectangle {name}"),
            none(),
            light,
            from,
            view,
        ));
    }
    cases.extend(flat_cases("pair of triangles", pair, 0.97));
    // So near the plane that its corners become needles of the sphere the quadrature misses parts.
    cases.extend(flat_cases("triangle", triangle, 0.9));
    let above = Vec3::new(0.5, 1.6, 0.1);
    let light = rectangle(AreaDensity::Correct, true);
    cases.push(case(
        "back of a two-sided rectangle",
        none(),
        light,
        above,
        (Vec3::Y - above, 1.0),
    ));
    for from in [
        Vec3::new(2.0, 2.0, 2.0),
        Vec3::new(-1.0, 0.2, 0.3),
        Vec3::new(0.4, -0.5, 1.2),
    ] {
        let (shapes, light) = mesh();
        let view = (Vec3::new(0.7, 0.3, 0.4) - from, 0.7);
        cases.push(case(
            &format!("mesh from {from}"),
            shapes,
            light,
            from,
            view,
        ));
    }
    for (from, size) in [
        (Vec3::new(0.2, 0.4, -0.5), 0.8),
        (Vec3::new(0.2, 0.499, -0.5), 1.5),
        (Vec3::new(2.0, -1.0, 3.0), 0.12),
        (Vec3::new(20.0, -10.0, 70.0), 0.007),
    ] {
        let (shapes, light) = sphere(false);
        let view = (Vec3::new(0.2, 1.0, -0.5) - from, size);
        cases.push(case(
            &format!("sphere from {from}"),
            shapes,
            light,
            from,
            view,
        ));
    }
    let (shapes, light) = sphere(true);
    let inside = Vec3::new(0.4, 1.1, -0.3);
    cases.push(case(
        "inside of a sphere",
        shapes,
        light,
        inside,
        (Vec3::Z, 3.0),
    ));
    cases
}

fn picture(width: usize, height: usize, texel: impl Fn(usize, usize) -> Rgb) -> Arc<Image<Rgb>> {
    let pixels = (0..width * height)
        .map(|i| texel(i % width, i / width))
        .collect();
    Arc::new(Image::from_pixels(width, height, pixels))
}

/// One texel a hundred thousand times as bright as the rest.
fn sun() -> Arc<Image<Rgb>> {
    picture(64, 32, |x, y| {
        if (x, y) == (40, 9) {
            Rgb::splat(1e4)
        } else {
            Rgb::splat(0.1)
        }
    })
}

fn black_rows() -> Arc<Image<Rgb>> {
    picture(16, 8, |x, y| {
        if y == 0 || y == 3 {
            Rgb::ZERO
        } else {
            Rgb::new(0.1, 0.3, 0.5) * ((x * 7 + y) % 5) as f32
        }
    })
}

pub(crate) fn environment_cases() -> Vec<Case> {
    let sun_theta = std::f32::consts::PI * 9.5 / 32.0;
    let sun_phi = std::f32::consts::TAU * 40.5 / 64.0;
    let to_sun = Vec3::new(
        -sun_theta.sin() * sun_phi.cos(),
        sun_theta.cos(),
        sun_theta.sin() * sun_phi.sin(),
    );
    let (dark, dim, bright) = (Rgb::ZERO, Rgb::splat(0.2), Rgb::new(1.0, 2.0, 0.5));
    [
        ("sky", bright, dark, None, (Vec3::Y, 3.0)),
        ("ambient", dark, bright, None, (Vec3::Y, 3.0)),
        ("sky and ambient", dim, bright, None, (Vec3::X, 3.0)),
        ("black rows", dark, dark, Some(black_rows()), (Vec3::Y, 3.0)),
        ("sun", dark, dark, Some(sun()), (to_sun, 0.06)),
        ("all parts", dim, bright, Some(black_rows()), (Vec3::Y, 3.0)),
    ]
    .into_iter()
    .map(|(name, sky, ambient, map, view)| {
        let light = Light::Environment(EnvironmentLight::new(sky, ambient, map));
        Case {
            integral: Some(1.0),
            ..case(name, Shapes::default(), light, Vec3::ZERO, view)
        }
    })
    .collect()
}

/// The density of the course's program.
pub(crate) fn wrong_cases() -> Vec<Case> {
    let from = Vec3::new(0.1, -0.5, 0.05);
    let light = rectangle(AreaDensity::Course, false);
    vec![case(
        "course",
        Shapes::default(),
        light,
        from,
        (Vec3::Y - from, 0.5),
    )]
}
