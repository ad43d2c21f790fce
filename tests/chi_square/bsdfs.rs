use glam::Vec3;
use softbox::bsdf::{Bsdf, Diffuse, Microfacet};
use softbox::color::Rgb;

use crate::directions::Directions;
use crate::harness::Case;

fn toward(cos: f32, phi: f32) -> Vec3 {
    let sin = ((1.0 - cos) * (1.0 + cos)).sqrt();
    Vec3::new(sin * phi.cos(), sin * phi.sin(), cos)
}

/// `radius` is the width of the lobe about the mirror direction in radians; wide lobes are looked at
/// from the normal, so that the horizon is an edge of the cells.
fn case(name: String, bsdf: Bsdf, wo: Vec3, radius: f64, integral: Option<f64>) -> Case {
    let axis = if radius < 1.0 {
        Vec3::new(-wo.x, -wo.y, wo.z)
    } else {
        Vec3::Z
    };
    let directions = Directions::around(axis, radius);
    Case {
        name,
        sample: Box::new(move |numbers| {
            let sample = bsdf.sample(wo, numbers.choice, numbers.u)?;
            let queried = bsdf.pdf(wo, sample.wi);
            assert!((sample.pdf / queried - 1.0).abs() < 1e-4, "{bsdf:?} {wo}");
            Some(directions.place(sample.wi))
        }),
        density: Box::new(move |place| directions.density(place, |wi| f64::from(bsdf.pdf(wo, wi)))),
        integral,
    }
}

/// Seven viewing directions: the normal, slanted, grazing, and from below.
const VIEWS: [(f32, f32); 7] = [
    (1.0, 0.0),
    (0.9, 1.0),
    (0.5, 2.0),
    (0.1, 4.0),
    (0.01, 0.3),
    (-0.6, 5.0),
    (-0.01, 3.0),
];

pub(crate) fn cases() -> Vec<Case> {
    let diffuse = Bsdf::Diffuse(Diffuse::new(Rgb::splat(0.5)));
    let (eta, k) = (Rgb::new(0.2, 0.92, 1.1), Rgb::new(3.9, 2.45, 2.1));
    VIEWS
        .into_iter()
        .flat_map(|(cos, phi)| {
            let wo = toward(cos, phi);
            let rough = [(0.01, 0.03), (0.1, 0.3), (0.5, 3.0), (1.0, 3.0)];
            let metal = rough.map(|(alpha, radius)| {
                let bsdf = Bsdf::Microfacet(Microfacet::new(alpha, eta, k));
                case(
                    format!("metal {alpha} seen at {cos}"),
                    bsdf,
                    wo,
                    radius,
                    None,
                )
            });
            metal.into_iter().chain([case(
                format!("diffuse seen at {cos}"),
                diffuse,
                wo,
                3.0,
                Some(1.0),
            )])
        })
        .collect()
}
