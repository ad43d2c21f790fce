use glam::Vec3;
use softbox::guide::{LobeSphere, Lobes};

use crate::directions::Directions;
use crate::harness::Case;

fn sphere(center: Vec3, radius: f32, weight: f32) -> LobeSphere {
    LobeSphere {
        center,
        radius2: radius * radius,
        weight,
    }
}

/// From the origin, looked at around `axis`, half of the cells within `radius` radians.
fn case(name: &str, spheres: &[LobeSphere], axis: Vec3, radius: f64) -> Case {
    let lobes = Lobes::new(spheres, 0.5);
    let directions = Directions::around(axis, radius);
    let from = Vec3::ZERO;
    Case {
        name: name.to_owned(),
        sample: Box::new(move |numbers| {
            let wi = lobes.sample(from, numbers.choice, numbers.u);
            Some(directions.place(wi))
        }),
        density: Box::new(move |place| {
            directions.density(place, |wi| f64::from(lobes.pdf(from, wi)))
        }),
        integral: Some(1.0),
    }
}

pub(crate) fn cases() -> Vec<Case> {
    let far = sphere(Vec3::new(0.3, 0.5, -0.2), 0.04, 1.0);
    let near = sphere(Vec3::new(-0.2, 0.1, 0.3), 0.3, 2.0);
    let inside = sphere(Vec3::new(0.0, 0.0, 0.1), 0.2, 1.0);
    let row = |i: u8| {
        let x = 0.1 * f32::from(i);
        sphere(Vec3::new(x - 0.4, 0.5, x), 0.1, 1.0 + x)
    };
    let all: Vec<LobeSphere> = (0..8).map(row).collect();
    vec![
        case("a narrow lobe", &[far], far.center, 0.06),
        case("a wide lobe", &[near], near.center, 3.0),
        case("a lobe around the point", &[inside], Vec3::Z, 3.0),
        case("two lobes", &[far, near], near.center, 3.0),
        case("eight that overlap", &all, Vec3::Y, 3.0),
    ]
}
