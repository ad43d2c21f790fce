use std::f64::consts::PI;

use glam::{DVec2, Vec2, Vec3};
use softbox::sampling::{
    Distribution2d, UNIFORM_HEMISPHERE_PDF, UNIFORM_SPHERE_PDF, cosine_hemisphere,
    cosine_hemisphere_pdf, uniform_cone, uniform_cone_pdf, uniform_disk, uniform_hemisphere,
    uniform_sphere, uniform_triangle,
};

use crate::directions::Directions;
use crate::harness::Case;

fn directional(
    name: &str,
    directions: Directions,
    warp: impl Fn(Vec2) -> Vec3 + 'static,
    pdf: impl Fn(Vec3) -> f32 + 'static,
) -> Case {
    Case {
        name: name.to_owned(),
        sample: Box::new(move |numbers| Some(directions.place(warp(numbers.u)))),
        density: Box::new(move |place| directions.density(place, |w| f64::from(pdf(w)))),
        integral: Some(1.0),
    }
}

fn upper(pdf: f32, w: Vec3) -> f32 {
    if w.z >= 0.0 { pdf } else { 0.0 }
}

fn cone(one_minus_cos: f32, radius: f64) -> Case {
    directional(
        &format!("cone of 1 - cos = {one_minus_cos}"),
        Directions::around(Vec3::Z, radius),
        move |u| uniform_cone(u, one_minus_cos),
        move |w| {
            let half_sin2 = f64::from(w.x * w.x + w.y * w.y) / (1.0 + f64::from(w.z.max(0.0)));
            let inside =
                (w.z > 0.0 && half_sin2 < f64::from(one_minus_cos)) || one_minus_cos == 2.0;
            if inside {
                uniform_cone_pdf(one_minus_cos)
            } else {
                0.0
            }
        },
    )
}

fn disk() -> Case {
    Case {
        name: "disk".to_owned(),
        sample: Box::new(|numbers| Some((uniform_disk(numbers.u).as_dvec2() + DVec2::ONE) * 0.5)),
        density: Box::new(|place| {
            let inside = (2.0 * place - DVec2::ONE).length_squared() <= 1.0;
            if inside { 4.0 / PI } else { 0.0 }
        }),
        integral: Some(1.0),
    }
}

fn triangle() -> Case {
    Case {
        name: "triangle".to_owned(),
        sample: Box::new(|numbers| {
            let (b1, b2) = uniform_triangle(numbers.u);
            Some(DVec2::new(f64::from(b1), f64::from(b2)))
        }),
        density: Box::new(|place| if place.x + place.y <= 1.0 { 2.0 } else { 0.0 }),
        integral: Some(1.0),
    }
}

fn tabulated() -> Case {
    let weights: Vec<f32> = (0..16 * 12)
        .map(|i| {
            if i / 16 == 3 || i % 5 == 0 {
                0.0
            } else {
                ((i * 37) % 11) as f32
            }
        })
        .collect();
    let table = Distribution2d::new(16, &weights).expect("most weights are positive");
    let same = table.clone();
    Case {
        name: "table of 16 x 12".to_owned(),
        sample: Box::new(move |numbers| Some(table.sample_continuous(numbers.u).0.as_dvec2())),
        density: Box::new(move |place| f64::from(same.pdf(place.as_vec2()))),
        integral: Some(1.0),
    }
}

pub(crate) fn cases() -> Vec<Case> {
    let whole = Directions::around(Vec3::Z, 3.0);
    vec![
        directional("uniform hemisphere", whole, uniform_hemisphere, |w| {
            upper(UNIFORM_HEMISPHERE_PDF, w)
        }),
        directional("cosine hemisphere", whole, cosine_hemisphere, |w| {
            cosine_hemisphere_pdf(w.z)
        }),
        directional("sphere", whole, uniform_sphere, |_| UNIFORM_SPHERE_PDF),
        cone(1e-8, 1e-4),
        cone(1e-3, 0.03),
        cone(0.5, 0.5),
        cone(2.0, 3.0),
        disk(),
        triangle(),
        tabulated(),
    ]
}

/// A uniform hemisphere taken for a cosine one, a polar disk without its square root, and a cosine
/// that is off by five percent.
pub(crate) fn wrong_cases() -> Vec<Case> {
    let whole = Directions::around(Vec3::Z, 3.0);
    let unrooted = Case {
        sample: Box::new(|numbers| {
            let phi = 2.0 * PI * f64::from(numbers.u.y);
            let disk = f64::from(numbers.u.x) * DVec2::new(phi.cos(), phi.sin());
            Some((disk + DVec2::ONE) * 0.5)
        }),
        ..disk()
    };
    vec![
        directional("uniform for cosine", whole, uniform_hemisphere, |w| {
            cosine_hemisphere_pdf(w.z)
        }),
        unrooted,
        directional("tilted", whole, cosine_hemisphere, |w| {
            cosine_hemisphere_pdf(w.z) * (1.0 + 0.05 * w.x.signum())
        }),
    ]
}
