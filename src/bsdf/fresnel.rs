use crate::color::Rgb;

/// What a smooth boundary of two dielectrics does to a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Boundary {
    /// The share of unpolarised light that is reflected, 0..=1.
    pub(super) reflected: f32,
    /// Cosine of the transmitted ray to the normal on the far side; 0 under total reflection.
    pub(super) cos_transmitted: f32,
}

/// Fresnel's equations for unpolarised light at a dielectric boundary.
///
/// `cos_incident` in 0..=1 is taken on the incident side, `eta` = n_far / n_near.
/// Born and Wolf 1999, "Principles of Optics", section 1.5.2.
pub(super) fn dielectric(cos_incident: f32, eta: f32) -> Boundary {
    // η²cos²t; written so that η = 1 gives back the incident cosine without cancellation.
    let scaled2 = (eta - 1.0) * (eta + 1.0) + cos_incident * cos_incident;
    if scaled2 <= 0.0 {
        return Boundary {
            reflected: 1.0,
            cos_transmitted: 0.0,
        };
    }
    let scaled = scaled2.sqrt();
    let cos_transmitted = (scaled / eta).min(1.0);
    let perpendicular = (cos_incident - scaled) / (cos_incident + scaled);
    let eta2_cos = eta * eta * cos_incident;
    let parallel = (eta2_cos - scaled) / (eta2_cos + scaled);
    Boundary {
        reflected: 0.5 * (perpendicular * perpendicular + parallel * parallel),
        cos_transmitted,
    }
}

/// The share of unpolarised light that a conductor in air reflects, per channel.
///
/// `cos_incident` in 0..=1; `eta` and `k` are the real and the imaginary part of the index of
/// refraction. Born and Wolf 1999, "Principles of Optics", section 14.4.
pub(super) fn conductor(cos_incident: f32, eta: Rgb, k: Rgb) -> Rgb {
    let channel = |i: usize| conductor_channel(cos_incident, eta[i], k[i]);
    Rgb::new(channel(0), channel(1), channel(2))
}

fn conductor_channel(cos: f32, eta: f32, k: f32) -> f32 {
    let cos2 = cos * cos;
    let sin2 = 1.0 - cos2;
    // (a + ib)² = (η + ik)² − sin²; η² − sin² is written so that η = 1 leaves cos² exactly.
    let real = (eta - 1.0) * (eta + 1.0) + cos2 - k * k;
    let modulus = real.hypot(2.0 * eta * k);
    // The larger square root first; the other follows from ab = ηk without cancellation.
    let larger = (0.5 * (modulus + real.abs())).sqrt();
    let a = if real >= 0.0 {
        larger
    } else if larger > 0.0 {
        eta * k / larger
    } else {
        0.0
    };
    let (sum_s, cross_s) = (modulus + cos2, 2.0 * a * cos);
    if sum_s + cross_s <= 0.0 {
        return 1.0;
    }
    let perpendicular = (sum_s - cross_s) / (sum_s + cross_s);
    let (sum_p, cross_p) = (cos2 * modulus + sin2 * sin2, cross_s * sin2);
    let parallel = if sum_p + cross_p > 0.0 {
        perpendicular * (sum_p - cross_p) / (sum_p + cross_p)
    } else {
        perpendicular
    };
    (0.5 * (perpendicular + parallel)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cosines() -> impl Iterator<Item = f32> {
        (0..=1000).map(|i| i as f32 / 1000.0)
    }

    /// C11's single boundary: ((n − 1)/(n + 1))² at normal incidence, 1 at grazing incidence.
    #[test]
    fn dielectric_has_the_known_ends_and_total_reflection() {
        assert!((dielectric(1.0, 1.5).reflected - 0.04).abs() < 1e-7);
        assert!((dielectric(1.0, 1.0 / 1.5).reflected - 0.04).abs() < 1e-7);
        assert_eq!(dielectric(0.0, 1.5).reflected, 1.0);
        let critical = (1.0_f32 - 1.0 / 2.25).sqrt();
        assert_eq!(dielectric(critical - 1e-4, 1.0 / 1.5).reflected, 1.0);
        assert!(dielectric(critical + 1e-4, 1.0 / 1.5).reflected < 1.0);
        // Brewster's angle: tan = n; no parallel part, so half of the perpendicular one.
        let brewster = dielectric(1.0 / (1.0_f32 + 2.25).sqrt(), 1.5).reflected;
        assert!((brewster - 0.5 * (1.25_f32 / 3.25).powi(2)).abs() < 1e-6);
    }

    #[test]
    fn dielectric_is_the_same_from_both_sides_and_obeys_snell() {
        for cos in cosines().skip(10) {
            let into = dielectric(cos, 1.5);
            let back = dielectric(into.cos_transmitted, 1.0 / 1.5);
            assert!((into.reflected - back.reflected).abs() < 2e-4, "{cos}");
            let sines2 = (1.0 - cos * cos, 1.0 - into.cos_transmitted.powi(2));
            assert!((sines2.0 - 2.25 * sines2.1).abs() < 1e-6, "{cos}");
        }
    }

    #[test]
    fn equal_indices_reflect_nothing_even_at_grazing_angles() {
        for cos in [1e-15, 1e-8, 1e-4, 0.1, 1.0] {
            let boundary = dielectric(cos, 1.0);
            assert!(boundary.reflected < 1e-12, "{cos}");
            assert!((boundary.cos_transmitted / cos - 1.0).abs() < 1e-6, "{cos}");
        }
    }

    #[test]
    fn conductor_without_absorption_is_the_dielectric() {
        for eta in [0.4, 1.0, 1.5, 3.0] {
            for cos in cosines().skip(1) {
                let exact = dielectric(cos, eta).reflected;
                let ours = conductor_channel(cos, eta, 0.0);
                assert!((exact - ours).abs() < 2e-5, "{eta} {cos}: {exact} {ours}");
            }
        }
    }

    /// ((η − 1)² + k²) / ((η + 1)² + k²) at normal incidence; complex arithmetic in f64 elsewhere.
    #[test]
    fn conductor_agrees_with_complex_arithmetic() {
        type Complex = (f64, f64);
        let div = |a: Complex, b: Complex| {
            let n = b.0 * b.0 + b.1 * b.1;
            ((a.0 * b.0 + a.1 * b.1) / n, (a.1 * b.0 - a.0 * b.1) / n)
        };
        let norm2 = |a: Complex| a.0 * a.0 + a.1 * a.1;
        for (eta, k) in [(0.2004, 3.912), (1.102, 6.857), (2.5, 0.1), (0.05, 9.0)] {
            let normal = ((eta - 1.0_f64).powi(2) + k * k) / ((eta + 1.0).powi(2) + k * k);
            let at_normal = f64::from(conductor_channel(1.0, eta as f32, k as f32));
            assert!((normal - at_normal).abs() < 1e-5);
            for cos in cosines().skip(1).map(f64::from) {
                let n2: Complex = (eta * eta - k * k, 2.0 * eta * k);
                let inside: Complex = (n2.0 - (1.0 - cos * cos), n2.1);
                let modulus = norm2(inside).sqrt();
                let root: Complex = (
                    (0.5 * (modulus + inside.0)).max(0.0).sqrt(),
                    (0.5 * (modulus - inside.0)).max(0.0).sqrt(),
                );
                let s = norm2(div((cos - root.0, -root.1), (cos + root.0, root.1)));
                let p = norm2(div(
                    (n2.0 * cos - root.0, n2.1 * cos - root.1),
                    (n2.0 * cos + root.0, n2.1 * cos + root.1),
                ));
                let ours = f64::from(conductor_channel(cos as f32, eta as f32, k as f32));
                assert!((0.5 * (s + p) - ours).abs() < 1e-5, "{eta} {k} {cos}");
            }
        }
    }

    #[test]
    fn conductor_is_finite_at_the_ends() {
        for (eta, k) in [(0.0, 0.0), (1.0, 0.0), (1e-3, 1e3), (5.0, 0.0)] {
            for cos in [0.0, 1e-30, 1e-10, 1.0] {
                let reflected = conductor_channel(cos, eta, k);
                assert!((0.0..=1.0).contains(&reflected), "{eta} {k} {cos}");
            }
        }
    }
}
