use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::{Bsdf, Diffuse, Glass, Lobe, Microfacet, Mirror, Refraction};
use crate::color::Rgb;
use crate::sampling::{ONE_MINUS_EPSILON, PathSampler, Slot};

const ALPHAS: [f32; 5] = [1e-3, 0.01, 0.1, 0.5, 1.0];

/// Reflects everything, as a conductor with unbounded absorption does.
fn white_metal(alpha: f32) -> Bsdf {
    Bsdf::Microfacet(Microfacet::new(alpha, Rgb::ZERO, Rgb::splat(1.0)))
}

fn gold(alpha: f32) -> Bsdf {
    let (eta, k) = (Rgb::new(0.143, 0.375, 1.442), Rgb::new(3.983, 2.386, 1.603));
    Bsdf::Microfacet(Microfacet::new(alpha, eta, k))
}

fn clear_glass(ior: f32) -> Bsdf {
    Bsdf::Glass(Glass::new(Rgb::ONE, Rgb::ONE, ior))
}

fn random(i: u32, slot: Slot) -> Vec2 {
    PathSampler::new(11, [i, 0], 0).get_2d(0, slot)
}

fn direction(cos: f32, phi: f32) -> Vec3 {
    let sin = ((1.0 - cos) * (1.0 + cos)).sqrt();
    Vec3::new(sin * phi.cos(), sin * phi.sin(), cos)
}

/// Test S13 of the stress list.
#[test]
fn diffuse_and_rough_metal_are_reciprocal() {
    for bsdf in [Bsdf::Diffuse(Diffuse::new(Rgb::splat(0.7)))]
        .into_iter()
        .chain(ALPHAS.map(gold))
    {
        for i in 0..5000 {
            let (a, b) = (random(i, Slot::Scatter), random(i, Slot::Lens));
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            let wo = direction(side * (a.x + 1e-3).min(1.0), 2.0 * PI * a.y);
            let wi = direction(side * (b.x + 1e-3).min(1.0), 2.0 * PI * b.y);
            let (there, back) = (bsdf.eval(wo, wi), bsdf.eval(wi, wo));
            assert!((there - back).abs().max_element() <= 1e-5 * there.max_element());
        }
    }
}

/// Test S13 for dielectrics: f(a, b)·n_b² = f(b, a)·n_a², and the way back is found.
#[test]
fn refraction_is_reciprocal_up_to_the_squared_indices() {
    let bsdf = Bsdf::Refraction(Refraction::new(Rgb::splat(0.8), 1.5));
    for i in 1..=1000 {
        let wo = direction(i as f32 / 1000.0, 0.7);
        let into = bsdf.sample(wo, 0.0, Vec2::ZERO).expect("light enters");
        let out = bsdf.sample(into.wi, 0.0, Vec2::ZERO).expect("light leaves");
        assert!((out.wi - wo).length() < 2e-4, "{wo} {}", out.wi);
        let round_trip = into.weight() * out.weight();
        assert!((round_trip - Rgb::splat(0.64)).abs().max_element() < 1e-6);
    }
}

/// Test S14: the share of light that is reflected, by quadrature over the random numbers.
#[test]
fn nothing_reflects_more_than_it_receives() {
    let n: u16 = 256;
    for alpha in ALPHAS {
        let bsdf = white_metal(alpha);
        for cos in [0.01, 0.1, 0.5, 0.9, 1.0] {
            let wo = direction(cos, 0.4);
            let mut sum = 0.0_f64;
            for i in 0..n {
                for j in 0..n {
                    let u = Vec2::new(f32::from(i) + 0.5, f32::from(j) + 0.5) / f32::from(n);
                    let weight = bsdf.sample(wo, 0.5, u).map_or(0.0, |s| s.weight().x);
                    assert!(
                        (0.0..=1.0 + 1e-3).contains(&weight),
                        "{alpha} {cos} {weight}"
                    );
                    sum += f64::from(weight);
                }
            }
            let albedo = sum / f64::from(n).powi(2);
            assert!(albedo <= 1.0 + 1e-4, "{alpha} {cos}: {albedo}");
            let kept = if alpha < 0.2 && cos >= 0.1 { 0.9 } else { 0.3 };
            assert!(albedo > kept, "{alpha} {cos}: {albedo}");
        }
    }
}

/// Test S14 by a second route that uses neither the sampler nor its density: uniform quadrature over
/// the hemisphere.
#[test]
fn albedo_by_sampling_is_albedo_by_quadrature() {
    for (alpha, cos) in [(0.3, 0.9), (0.5, 0.3), (1.0, 0.7), (0.5, 0.05)] {
        let (bsdf, wo) = (gold(alpha), direction(cos, 0.0));
        let (n, m) = (1500_u16, 720_u16);
        let mut quadrature = 0.0_f64;
        for i in 0..n {
            for j in 0..m {
                let z = (f32::from(i) + 0.5) / f32::from(n);
                let wi = direction(z, 2.0 * PI * (f32::from(j) + 0.5) / f32::from(m));
                quadrature += f64::from(bsdf.eval(wo, wi).y * wi.z);
            }
        }
        quadrature *= 2.0 * f64::from(PI) / (f64::from(n) * f64::from(m));
        let grid: u16 = 512;
        let mut sampled = 0.0_f64;
        for k in 0..u32::from(grid) * u32::from(grid) {
            let (i, j) = (k % u32::from(grid), k / u32::from(grid));
            let u = Vec2::new(i as f32 + 0.5, j as f32 + 0.5) / f32::from(grid);
            sampled += f64::from(bsdf.sample(wo, 0.5, u).map_or(0.0, |s| s.weight().y));
        }
        sampled /= f64::from(grid).powi(2);
        assert!(
            (sampled / quadrature - 1.0).abs() < 2e-3,
            "{alpha} {cos}: {sampled} {quadrature}"
        );
    }
}

/// Test S14 for smooth dielectrics: reflected and transmitted shares add to 1 from both sides.
#[test]
fn glass_loses_nothing() {
    for ior in [1.0, 1.33, 1.5, 2.4] {
        for cos in [-1.0, -0.7, -0.3, -0.01, 0.01, 0.3, 0.7, 1.0] {
            let (bsdf, wo) = (clear_glass(ior), direction(cos, 2.0));
            let (mut power, mut probability) = (0.0, 0.0);
            for u in [0.0, ONE_MINUS_EPSILON] {
                let Some(s) = bsdf.sample(wo, u, Vec2::ZERO) else {
                    continue;
                };
                let eta = if cos > 0.0 { ior } else { 1.0 / ior };
                let scale = if s.wi.z * cos < 0.0 { eta * eta } else { 1.0 };
                assert_eq!(s.lobe, Lobe::Delta);
                assert!((s.wi.length() - 1.0).abs() < 1e-5);
                assert!((s.weight().x * scale - 1.0).abs() < 1e-5, "{ior} {cos}");
                if s.pdf < 1.0 || probability == 0.0 {
                    power += s.pdf * s.weight().x * scale;
                    probability += s.pdf;
                }
            }
            assert!((power - 1.0).abs() < 1e-5, "{ior} {cos}: {power}");
            assert!(
                (probability - 1.0).abs() < 1e-6,
                "{ior} {cos}: {probability}"
            );
        }
    }
}

/// C11 of the closed forms: a slab of index 1.5 at normal incidence, all internal reflections.
#[test]
fn a_slab_transmits_what_the_series_says() {
    let bsdf = clear_glass(1.5);
    let (up, down) = (Vec3::Z, Vec3::NEG_Z);
    let one_way = |wo: Vec3, u: f32| {
        let s = bsdf.sample(wo, u, Vec2::ZERO).expect("both ways are open");
        f64::from(s.weight().x * s.pdf)
    };
    let (enter, leave) = (
        one_way(up, ONE_MINUS_EPSILON),
        one_way(down, ONE_MINUS_EPSILON),
    );
    let inside = one_way(down, 0.0);
    let transmitted = enter * leave / (1.0 - inside * inside);
    let reflected = one_way(up, 0.0) + enter * inside * leave / (1.0 - inside * inside);
    assert!((transmitted - 0.923_076_9).abs() < 1e-6, "{transmitted}");
    assert!((reflected - 0.076_923_1).abs() < 1e-6, "{reflected}");
}

/// C10 in small: a walk through a glass sphere keeps radiance 1 once it is outside again.
#[test]
fn a_glass_sphere_is_invisible_in_a_constant_environment() {
    for bsdf in [
        clear_glass(1.5),
        Bsdf::Refraction(Refraction::new(Rgb::ONE, 1.5)),
    ] {
        for i in 0..2000 {
            let (mut wo, mut weight) = (direction(random(i, Slot::Lens).x.max(1e-3), 0.0), 1.0);
            for bounce in 0..200 {
                let u = PathSampler::new(1, [i, 1], 0).get_2d(bounce, Slot::Lobe);
                let s = bsdf
                    .sample(wo, u.x, u)
                    .expect("a dielectric scatters everywhere");
                weight *= s.weight().x;
                if s.wi.z > 0.0 {
                    break;
                }
                // The next point of the sphere sees the ray under the same angle, from inside.
                wo = Vec3::new(s.wi.x, s.wi.y, s.wi.z);
            }
            assert!((weight - 1.0).abs() < 1e-4, "{weight}");
        }
    }
}

#[test]
fn smooth_surfaces_have_no_density_and_reflect_on_both_sides() {
    let mirror = Bsdf::Mirror(Mirror::new(Rgb::new(0.9, 0.8, 0.7)));
    let wo = direction(-0.3, 1.0);
    let s = mirror
        .sample(wo, 0.5, Vec2::splat(0.5))
        .expect("mirrors reflect");
    assert_eq!(s.wi, Vec3::new(-wo.x, -wo.y, wo.z));
    assert_eq!(s.weight(), Rgb::new(0.9, 0.8, 0.7));
    assert_eq!(
        (mirror.eval(wo, s.wi), mirror.pdf(wo, s.wi)),
        (Rgb::ZERO, 0.0)
    );
    assert!(mirror.is_delta() && !gold(0.1).is_delta());
    assert!(Bsdf::Diffuse(Diffuse::new(Rgb::ZERO)).is_black() && !gold(0.1).is_black());
}

/// A narrow lobe is the mirror: same direction, Fresnel's reflectance.
#[test]
fn polished_metal_approaches_the_mirror() {
    let (bsdf, wo) = (gold(1e-3), direction(0.6, 0.3));
    for i in 0..1000 {
        let s = bsdf
            .sample(wo, 0.5, random(i, Slot::Scatter))
            .expect("lobe is above");
        assert!((s.wi - Vec3::new(-wo.x, -wo.y, wo.z)).length() < 0.02);
        assert!((0.8..1.0).contains(&s.weight().x), "{}", s.weight());
    }
}

/// Tests S7 and S8: every sample is usable or absent, and has the density that a query gives.
#[test]
fn samples_are_finite_for_all_numbers_and_angles() {
    let edge = [0.0, f32::EPSILON * 0.5, 0.25, ONE_MINUS_EPSILON];
    let models = ALPHAS.map(gold).into_iter().chain([
        Bsdf::Diffuse(Diffuse::new(Rgb::ONE)),
        clear_glass(1.5),
        clear_glass(1.0),
        Bsdf::Refraction(Refraction::new(Rgb::ONE, 1.5)),
        Bsdf::Mirror(Mirror::new(Rgb::ONE)),
    ]);
    for bsdf in models {
        for cos in [1.0, 0.5, 1e-2, 1e-5, 1e-20, 1e-38, 0.0, -1e-10, -0.3, -1.0] {
            let wo = direction(cos, 1.1);
            for u in edge.iter().flat_map(|&x| edge.map(|y| Vec2::new(x, y))) {
                let Some(s) = bsdf.sample(wo, u.x, u) else {
                    continue;
                };
                assert!(s.wi.is_finite() && (s.wi.length() - 1.0).abs() < 1e-5);
                assert!(s.pdf > 0.0 && s.pdf.is_finite(), "{bsdf:?} {cos} {u}");
                assert!(s.weight().is_finite() && s.weight().min_element() >= 0.0);
                if s.lobe != Lobe::Delta {
                    assert_eq!(s.pdf, bsdf.pdf(wo, s.wi));
                    assert_eq!(s.value, bsdf.eval(wo, s.wi));
                }
            }
        }
    }
}
