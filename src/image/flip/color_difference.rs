use std::f32::consts::PI;

use glam::{Mat3, Vec3};

use crate::color::Rgb;
use crate::image::Image;

use super::plane::{Plane, kernel, normalize};

/// Section 4.1.3: exponent that compresses large distances.
const EXPONENT: f32 = 0.7;
/// Section 4.1.3: distances up to this part of the largest one …
const KNEE_AT: f32 = 0.4;
/// … are mapped to 0 up to this.
const KNEE_TO: f32 = 0.95;

/// A picture in the linear opponent space YCxCz, one plane for each channel.
pub(super) struct OpponentImage {
    pub(super) achromatic: Plane,
    red_green: Plane,
    blue_yellow: Plane,
}

impl OpponentImage {
    /// From linear Rec.709, clamped to 0..1.
    pub(super) fn new(image: &Image<Rgb>) -> Self {
        let spaces = ColorSpaces::new();
        let opponent: Vec<Vec3> = image
            .pixels()
            .iter()
            .map(|&p| spaces.opponent_of(clip(p)))
            .collect();
        let plane = |channel: usize| {
            let values = opponent.iter().map(|c| c[channel]).collect();
            Plane::new(image.width(), image.height(), values)
        };
        Self {
            achromatic: plane(0),
            red_green: plane(1),
            blue_yellow: plane(2),
        }
    }

    /// Section 4.1.1: what the eye resolves, as Hunt-adjusted L*a*b*.
    fn seen(&self, pixels_per_degree: f32) -> Vec<Vec3> {
        let spaces = ColorSpaces::new();
        let ppd = pixels_per_degree;
        let a = blur(&self.achromatic, &[(1.0, 0.0047)], ppd);
        let rg = blur(&self.red_green, &[(1.0, 0.0053)], ppd);
        let by = blur(&self.blue_yellow, &[(34.1, 0.04), (13.5, 0.025)], ppd);
        let channels = a.values().iter().zip(rg.values()).zip(by.values());
        channels
            .map(|((&y, &cx), &cz)| {
                let rgb = spaces.rgb_of(Vec3::new(y, cx, cz));
                hunt(spaces.lab(clip(rgb)))
            })
            .collect()
    }
}

/// Section 4.1: the difference of colour in each pixel, 0..1.
pub(super) fn color_difference(
    test: &OpponentImage,
    reference: &OpponentImage,
    pixels_per_degree: f32,
) -> Plane {
    let spaces = ColorSpaces::new();
    let [green, blue] = [Rgb::Y, Rgb::Z].map(|c| hunt(spaces.lab(c)));
    let largest = hyab(green, blue).powf(EXPONENT);
    let knee = KNEE_AT * largest;
    let redistribute = |error: f32| {
        if error < knee {
            KNEE_TO / knee * error
        } else {
            KNEE_TO + (error - knee) / (largest - knee) * (1.0 - KNEE_TO)
        }
    };
    let (a, b) = (
        test.seen(pixels_per_degree),
        reference.seen(pixels_per_degree),
    );
    let pairs = a.iter().zip(&b);
    let errors = pairs.map(|(&a, &b)| redistribute(hyab(a, b).powf(EXPONENT)));
    test.achromatic.with_values(errors.collect())
}

/// Section 4.1.1: a contrast sensitivity function as a sum of Gaussians a·√(π/b)·exp(−π²x²/b), x in
/// degrees; `terms` are the pairs (a, b).
fn blur(plane: &Plane, terms: &[(f32, f32)], pixels_per_degree: f32) -> Plane {
    let widest = terms.iter().map(|t| t.1).fold(0.0, f32::max);
    let radius = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as usize;
    let parts = terms.iter().map(|&(a, b)| {
        let raw = kernel(radius, |x| {
            (-(PI * x / pixels_per_degree).powi(2) / b).exp()
        });
        // A product of two such kernels sums to the square of one's sum.
        let weight = a * (PI / b).sqrt() * raw.iter().sum::<f32>().powi(2);
        let gaussian = normalize(raw);
        (weight, plane.filter(&gaussian, &gaussian))
    });
    let mean = |(w0, p0): (f32, Plane), (w1, p1): (f32, Plane)| {
        let sum = w0 + w1;
        (sum, p0.combine(&p1, |v0, v1| (w0 * v0 + w1 * v1) / sum))
    };
    let (_, blurred) = parts
        .reduce(mean)
        .expect("every channel has at least one Gaussian");
    blurred
}

/// Section 4.1.2: |ΔL| plus the Euclidean distance in the chromatic plane (Abasi et al. 2020).
fn hyab(a: Vec3, b: Vec3) -> f32 {
    let d = a - b;
    d.x.abs() + d.y.hypot(d.z)
}

/// Section 4.1.2: colours look more colourful when brighter (Hunt 1952).
fn hunt(lab: Vec3) -> Vec3 {
    Vec3::new(lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z)
}

/// Clamped to what a display shows; NaN becomes 0.
fn clip(rgb: Rgb) -> Rgb {
    Rgb::from_array(
        rgb.to_array()
            .map(|c| if c > 0.0 { c.min(1.0) } else { 0.0 }),
    )
}

/// Linear Rec.709 and the spaces that FLIP needs, relative to the white of Rec.709 itself.
struct ColorSpaces {
    /// X/Xn, Y/Yn, Z/Zn from linear Rec.709.
    xyz_from_rgb: Mat3,
    rgb_from_xyz: Mat3,
}

impl ColorSpaces {
    fn new() -> Self {
        // IEC 61966-2-1, each row divided by its sum, the white point.
        let rows = [
            Vec3::new(0.412_391, 0.357_584, 0.180_481),
            Vec3::new(0.212_639, 0.715_169, 0.072_192),
            Vec3::new(0.019_331, 0.119_195, 0.950_532),
        ];
        let [x, y, z] = rows.map(|row| row / row.element_sum());
        let xyz_from_rgb = Mat3::from_cols(x, y, z).transpose();
        Self {
            xyz_from_rgb,
            rgb_from_xyz: xyz_from_rgb.inverse(),
        }
    }

    /// YCxCz: a linear form of L*a*b*.
    fn opponent_of(&self, rgb: Rgb) -> Vec3 {
        let c = self.xyz_from_rgb * rgb;
        Vec3::new(116.0 * c.y - 16.0, 500.0 * (c.x - c.y), 200.0 * (c.y - c.z))
    }

    fn rgb_of(&self, opponent: Vec3) -> Rgb {
        let y = (opponent.x + 16.0) / 116.0;
        let xyz = Vec3::new(y + opponent.y / 500.0, y, y - opponent.z / 200.0);
        self.rgb_from_xyz * xyz
    }

    /// CIE 1976 L*a*b*.
    fn lab(&self, rgb: Rgb) -> Vec3 {
        const DELTA: f32 = 6.0 / 29.0;
        let f = |t: f32| {
            if t > DELTA.powi(3) {
                t.cbrt()
            } else {
                t / (3.0 * DELTA * DELTA) + 4.0 / 29.0
            }
        };
        let [x, y, z] = (self.xyz_from_rgb * rgb).to_array().map(f);
        Vec3::new(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spaces_agree_with_published_values() {
        let spaces = ColorSpaces::new();
        // L*a*b* of the sRGB primaries under D65.
        for (rgb, lab) in [
            (Rgb::X, Vec3::new(53.24, 80.09, 67.20)),
            (Rgb::Y, Vec3::new(87.73, -86.18, 83.18)),
            (Rgb::Z, Vec3::new(32.30, 79.19, -107.86)),
            (Rgb::ONE, Vec3::new(100.0, 0.0, 0.0)),
        ] {
            assert!(
                (spaces.lab(rgb) - lab).length() < 0.05,
                "{}",
                spaces.lab(rgb)
            );
            let back = spaces.rgb_of(spaces.opponent_of(rgb));
            assert!((back - rgb).length() < 1e-5, "{back}");
        }
    }
}
