use glam::Vec3;

use super::{ball, corners, seen_from, square, square_of_triangles};
use crate::color::Rgb;
use crate::light::{AreaLight, AreaShape, Light, LightSampler};

/// Test S6 of the stress list: in the plane of the light, on it, at its corner, extremely near; and
/// lights of no area, no colour or with NaN.
#[test]
fn degenerate_placements_give_usable_samples_or_none() {
    let (shapes, triangles) = square_of_triangles();
    let (ball_shapes, sphere) = ball(Vec3::Y, 0.5, true);
    let flat = AreaShape::Rectangle {
        corner: Vec3::ZERO,
        edge_u: Vec3::X,
        edge_v: Vec3::X,
    };
    let area = |shape: AreaShape, two_sided| {
        Light::Area(AreaLight::new(&shapes, shape, Rgb::ONE, two_sided))
    };
    let lights = [
        (area(square(), true), &shapes),
        (area(triangles, true), &shapes),
        (area(flat.clone(), true), &shapes),
        (sphere, &ball_shapes),
    ];
    let height = 1.0_f32;
    let places = [
        Vec3::new(0.0, height, 0.0),
        Vec3::new(-0.5, height, -0.5),
        Vec3::new(3.0, height, 0.2),
        Vec3::new(0.0, height.next_down(), 0.0),
        Vec3::new(0.0, height.next_up(), 0.0),
        Vec3::new(0.0, 0.5, 0.0),
        Vec3::new(0.0, 0.5_f32.next_down(), 0.0),
        Vec3::new(1e30, 0.0, 0.0),
        Vec3::splat(f32::NAN),
    ];
    for (light, shapes) in lights {
        for from in places {
            for u in corners() {
                let Some(s) = light.sample(shapes, &seen_from(from), u.x, u) else {
                    continue;
                };
                assert!(s.pdf > 0.0 && s.pdf.is_finite() && s.distance > 0.0);
                assert!(s.wi.is_finite() && s.point.is_finite() && s.normal.is_finite());
            }
        }
    }
    assert_eq!(area(flat, true).power(&shapes, 1.0), 0.0);
    let rectangle = |radiance| Light::Area(AreaLight::new(&shapes, square(), radiance, false));
    let broken = [Rgb::ZERO, Rgb::splat(f32::NAN)].map(rectangle);
    let bright = |r: f32| rectangle(Rgb::splat(r));
    let lights = [
        broken[0].clone(),
        bright(1.0),
        broken[1].clone(),
        bright(3.0),
    ];
    let sampler = LightSampler::new(&lights, &shapes, 1.0);
    let place = (Vec3::ZERO, Vec3::Y);
    for i in 0..1000 {
        let u = (i as f32 + 0.5) / 1000.0;
        let choice = sampler.sample(place.0, place.1, u).expect("two shine");
        let expected = if i < 250 { (1, 0.25) } else { (3, 0.75) };
        assert_eq!((choice.light, choice.pmf), expected);
    }
    let none = LightSampler::new(&broken, &shapes, 1.0);
    assert!(none.is_empty() && none.sample(place.0, place.1, 0.5).is_none());
    let pmf = |light| sampler.pmf(place.0, place.1, light, 0);
    assert_eq!(pmf(0) + pmf(2) + pmf(7), 0.0);
}
