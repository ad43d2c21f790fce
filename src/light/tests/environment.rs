use std::f32::consts::PI;
use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::{corners, irradiance, random, seen_from};
use crate::color::{Rgb, luminance};
use crate::geometry::Shapes;
use crate::image::Image;
use crate::light::{EnvironmentLight, Light};

fn picture() -> Arc<Image<Rgb>> {
    let pixels = (0..16 * 8)
        .map(|i| match i {
            0..16 | 48..64 => Rgb::ZERO,
            100 => Rgb::splat(500.0),
            _ => Rgb::new(0.1, 0.2, 0.3) * (i % 7) as f32,
        })
        .collect();
    Arc::new(Image::from_pixels(16, 8, pixels))
}

/// The orientation that the importer promises: top row at +y, column φ/2π, φ = atan2(−z, x) + π.
#[test]
fn the_picture_is_the_right_way_up_and_round() {
    let mut pixels = vec![Rgb::ZERO; 8 * 4];
    for (i, pixel) in pixels.iter_mut().enumerate() {
        *pixel = Rgb::splat(i as f32);
    }
    let map = Arc::new(Image::from_pixels(8, 4, pixels));
    let light = EnvironmentLight::new(Rgb::ZERO, Rgb::ZERO, Some(map));
    let seen = |x: f32, y: f32, z: f32| light.radiance(Vec3::new(x, y, z).normalize(), true).x;
    assert_eq!(seen(0.0, 1.0, 0.0) as usize / 8, 0);
    assert_eq!(seen(0.0, -1.0, 0.0) as usize / 8, 3);
    // φ just above π along +x; −z is a quarter turn further.
    assert_eq!(seen(1.0, 0.1, -0.1) as usize, 8 + 4);
    assert_eq!(seen(0.1, 0.1, -1.0) as usize, 8 + 5);
    assert_eq!(seen(-0.1, 0.1, 1.0) as usize, 8 + 1);
}

/// C9 of the closed forms, with b = 0: sky and ambient; the camera does not see the ambient part.
#[test]
fn constant_environments_give_their_irradiance() {
    let none = Shapes::default();
    let light = Light::Environment(EnvironmentLight::new(
        Rgb::splat(0.5),
        Rgb::splat(2.0),
        None,
    ));
    let e = irradiance(&light, &none, Vec3::ZERO, Vec3::Y);
    assert!((e / f64::from(2.5 * PI) - 1.0).abs() < 0.02, "{e}");
    assert_eq!(light.radiance_from_infinity(Vec3::Y, true), Rgb::splat(0.5));
    assert_eq!(
        light.radiance_from_infinity(Vec3::Y, false),
        Rgb::splat(2.5)
    );
    assert_eq!(
        light.radiance_from_infinity(Vec3::NEG_Y, false),
        Rgb::splat(0.5)
    );
    assert!((light.power(&none, 1.0) / (PI * PI * 6.0) - 1.0).abs() < 1e-5);
    let black = Light::Environment(EnvironmentLight::new(Rgb::ZERO, Rgb::ZERO, None));
    assert!(
        black
            .sample(&none, &seen_from(Vec3::ZERO), 0.5, Vec2::splat(0.5))
            .is_none()
    );
    assert_eq!((black.power(&none, 1.0), black.is_infinite()), (0.0, true));
}

/// A picture alone is sampled without variance: luminance over density is its flux.
#[test]
fn the_picture_is_its_own_density() {
    let none = Shapes::default();
    let light = Light::Environment(EnvironmentLight::new(Rgb::ZERO, Rgb::ZERO, Some(picture())));
    let flux = light.power(&none, 1.0) / PI;
    let every_number = (0..20_000).map(random).chain(corners().map(|u| (u.x, u)));
    for (choice, u) in every_number {
        let Some(s) = light.sample(&none, &seen_from(Vec3::ZERO), choice, u) else {
            continue;
        };
        assert!((s.wi.length() - 1.0).abs() < 1e-6);
        let ratio = luminance(s.radiance) / s.pdf;
        assert!((ratio / flux - 1.0).abs() < 1e-4, "{u}: {ratio} {flux}");
    }
}
