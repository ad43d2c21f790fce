use glam::Vec3;

use super::{ball, square_of_triangles};
use crate::color::Rgb;
use crate::geometry::Shapes;
use crate::light::{
    AreaLight, DirectionalLight, EnvironmentLight, Light, LightSampler, PointFalloff, PointLight,
};

fn sky(ambient: Rgb) -> Light {
    Light::Environment(EnvironmentLight::new(Rgb::ONE, ambient, None))
}

fn sun() -> Light {
    Light::Directional(DirectionalLight {
        to_light: Vec3::Y,
        irradiance: Rgb::ONE,
    })
}

fn point(x: f32) -> Light {
    Light::Point(PointLight {
        position: Vec3::new(x, 1.0, 0.0),
        intensity: Rgb::ONE,
        falloff: PointFalloff::Correct,
    })
}

#[test]
fn a_sky_without_a_picture_is_left_to_scattered_rays() {
    let shapes = Shapes::default();
    assert!(LightSampler::new(&[sky(Rgb::ONE)], &shapes, 1.0).is_empty());
    let sampler = LightSampler::new(&[sky(Rgb::ZERO), sun()], &shapes, 1.0);
    for u in [0.0, 0.5, 0.999] {
        let choice = sampler
            .sample(Vec3::ZERO, Vec3::Y, u)
            .expect("the sun shines");
        assert_eq!((choice.light, choice.part, choice.pmf), (1, 0, 1.0));
    }
    assert_eq!(sampler.group_pmf(0), 0.0);
}

/// Lights from infinity, many parts and single ones: what is chosen has its own probability, and all
/// probabilities add to 1.
#[test]
fn probabilities_of_a_mixture_add_to_one() {
    let (shapes, shape) = square_of_triangles();
    let area = AreaLight::new(&shapes, shape, Rgb::ONE, false);
    let lights = [sun(), Light::Area(area), point(0.5), sun(), point(-0.5)];
    let sampler = LightSampler::new(&lights, &shapes, 1.7);
    let pmf = |light, part| sampler.pmf(Vec3::ZERO, Vec3::Y, light, part);
    // Two triangles make a parallelogram; the third has no area.
    let parts = lights.each_ref().map(|light| light.part_count() as u32);
    assert_eq!(parts, [1, 2, 1, 1, 1]);
    let (mut sum, mut chosen) = (0.0, [[0.0; 2]; 5]);
    for (light, parts) in (0..5).zip(parts) {
        sum += (0..parts).map(|part| pmf(light, part)).sum::<f32>();
    }
    assert!((sum - 1.0).abs() < 1e-5, "{sum}");
    for i in 0..10_000_u16 {
        let u = (f32::from(i) + 0.5) / 10_000.0;
        let choice = sampler
            .sample(Vec3::ZERO, Vec3::Y, u)
            .expect("all are seen");
        assert_eq!(choice.pmf, pmf(choice.light, choice.part));
        chosen[choice.light as usize][choice.part as usize] += 1e-4;
    }
    for ((light, shares), parts) in (0..5).zip(chosen).zip(parts) {
        for (part, share) in (0..parts).zip(shares) {
            assert!((share - pmf(light, part)).abs() < 3e-4, "{light} {part}");
        }
    }
    // The triangle without area.
    assert_eq!(pmf(1, 1), 0.0);
}

#[test]
fn one_light_is_not_chosen_but_taken() {
    let (shapes, light) = ball(Vec3::Y, 0.2, false);
    let sampler = LightSampler::new(&[light], &shapes, 1.0);
    let behind = sampler
        .sample(Vec3::ZERO, Vec3::NEG_Y, 0.9)
        .expect("no question is asked");
    assert_eq!((behind.light, behind.part, behind.pmf), (0, 0, 1.0));
    assert!(
        LightSampler::new(&[], &shapes, 1.0)
            .sample(Vec3::ZERO, Vec3::Y, 0.5)
            .is_none()
    );
}
