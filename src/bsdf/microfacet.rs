use glam::{Vec2, Vec3};

use super::beckmann::Beckmann;
use super::{BsdfSample, Lobe, fresnel, same_side};
use crate::color::Rgb;

/// A rough conductor in air that reflects on both sides: Beckmann's distribution, Smith's
/// height-correlated masking and shadowing, Fresnel's equations per channel.
///
/// Cook and Torrance 1982, "A Reflectance Model for Computer Graphics"; Heitz 2014, "Understanding
/// the Masking-Shadowing Function in Microfacet-Based BRDFs". Light that would bounce between
/// facets is lost, so rough metals are darker than smooth ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Microfacet {
    distribution: Beckmann,
    eta: Rgb,
    k: Rgb,
}

impl Microfacet {
    /// A conductor of root-mean-square slope `alpha` (below 10⁻³ counts as 10⁻³) and complex index of
    /// refraction `eta` + i·`k` per channel.
    pub fn new(alpha: f32, eta: Rgb, k: Rgb) -> Self {
        Self {
            distribution: Beckmann::new(alpha),
            eta,
            k,
        }
    }

    /// The root-mean-square slope, at least 10⁻³.
    pub fn alpha(&self) -> f32 {
        self.distribution.alpha()
    }

    /// Real part of the index of refraction per channel.
    pub fn eta(&self) -> Rgb {
        self.eta
    }

    /// Imaginary part of the index of refraction per channel.
    pub fn k(&self) -> Rgb {
        self.k
    }

    pub(super) fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        let Some((wo, wi, m)) = half_vector(wo, wi) else {
            return Rgb::ZERO;
        };
        let d = self.distribution.density(m);
        if d == 0.0 {
            return Rgb::ZERO;
        }
        let hidden = self.distribution.lambda(wo) + self.distribution.lambda(wi);
        let geometry = d / (4.0 * wo.z * (wi.z * (1.0 + hidden)));
        let value = self.fresnel(wo.dot(m)) * geometry;
        if value.is_finite() { value } else { Rgb::ZERO }
    }

    pub(super) fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        half_vector(wo, wi).map_or(0.0, |(wo, _, m)| {
            let pdf = self.distribution.reflected_visible_density(wo, m);
            if pdf.is_finite() { pdf } else { 0.0 }
        })
    }

    /// Reflects `wo` in a visible microfacet normal; `None` when that leads below the surface, which
    /// is what the density lacks of 1.
    pub(super) fn sample(&self, wo: Vec3, u: Vec2) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let flip = Vec3::new(1.0, 1.0, 1.0_f32.copysign(wo.z));
        let above = wo * flip;
        let m = self.distribution.sample_visible(above, u);
        let wi = (m * (2.0 * above.dot(m)) - above).normalize() * flip;
        let pdf = self.pdf(wo, wi);
        (pdf > 0.0).then(|| BsdfSample {
            wi,
            value: self.eval(wo, wi),
            pdf,
            lobe: Lobe::Glossy,
        })
    }

    pub(super) fn is_black(&self) -> bool {
        self.eta == Rgb::ONE && self.k == Rgb::ZERO
    }

    /// The reflectance of the smooth conductor at normal incidence.
    pub(super) fn albedo(&self) -> Rgb {
        self.fresnel(1.0)
    }

    fn fresnel(&self, cos: f32) -> Rgb {
        fresnel::conductor(cos.clamp(0.0, 1.0), self.eta, self.k)
    }
}

/// Both directions turned to z > 0 and the unit vector half-way between; `None` when they lie on
/// different sides.
fn half_vector(wo: Vec3, wi: Vec3) -> Option<(Vec3, Vec3, Vec3)> {
    if !same_side(wo, wi) {
        return None;
    }
    let flip = Vec3::new(1.0, 1.0, 1.0_f32.copysign(wo.z));
    let (wo, wi) = (wo * flip, wi * flip);
    let m = (wo + wi).try_normalize()?;
    Some((wo, wi, m))
}
