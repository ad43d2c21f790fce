use std::f32::consts::{PI, TAU};
use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::{LightSample, usable_pdf};
use crate::color::{Rgb, luminance};
use crate::image::Image;
use crate::sampling::{
    Distribution1d, Distribution2d, UNIFORM_HEMISPHERE_PDF, UNIFORM_SPHERE_PDF, uniform_hemisphere,
    uniform_sphere,
};

/// Light from infinity: a constant sky, ambient light from above, and a picture, added up.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentLight {
    sky: Rgb,
    ambient: Rgb,
    map: Option<Map>,
    /// Chooses sky, ambient or map by power; nothing when all are black.
    parts: Option<Distribution1d>,
    /// ∫ luminance dω over the sphere, all parts.
    flux: f32,
}

/// A part of an [`EnvironmentLight`], as it is chosen for sampling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EnvironmentPart {
    /// The constant sphere.
    Sky,
    /// The constant upper half.
    Ambient,
    /// The picture, at this share of its width (from the left) and height (from the top).
    Map(Vec2),
}

impl EnvironmentLight {
    /// `sky` is the radiance of the whole sphere; `ambient` that of the half above y = 0, which camera
    /// rays do not see; `map` is a latitude-longitude picture of radiance, top row at +y, column
    /// φ/2π with φ = atan2(−z, x) + π. Texels are constant patches.
    pub fn new(sky: Rgb, ambient: Rgb, map: Option<Arc<Image<Rgb>>>) -> Self {
        let map = map.and_then(Map::new);
        let fluxes = [
            2.0 * TAU * luminance(sky),
            TAU * luminance(ambient),
            map.as_ref().map_or(0.0, |map| map.flux),
        ];
        Self {
            sky,
            ambient,
            map,
            parts: Distribution1d::new(&fluxes),
            flux: fluxes.iter().filter(|f| f.is_finite() && **f > 0.0).sum(),
        }
    }

    /// The radiance along a ray in the unit `direction` that leaves the scene.
    pub fn radiance(&self, direction: Vec3, is_camera_ray: bool) -> Rgb {
        let ambient = if direction.y > 0.0 && !is_camera_ray {
            self.ambient
        } else {
            Rgb::ZERO
        };
        let map = self
            .map
            .as_ref()
            .map_or(Rgb::ZERO, |map| map.radiance(direction));
        self.sky + ambient + map
    }

    /// Radiance of the whole sphere.
    pub fn sky(&self) -> Rgb {
        self.sky
    }

    /// Radiance of the half above y = 0, which camera rays do not see.
    pub fn ambient(&self) -> Rgb {
        self.ambient
    }

    /// The picture; `None` when there is none or it is black.
    pub fn map(&self) -> Option<&Image<Rgb>> {
        self.map.as_ref().map(|map| map.image.as_ref())
    }

    /// Luminance times solid angle over the whole sphere, all parts together.
    pub fn flux(&self) -> f32 {
        self.flux
    }

    /// The part that `u_choice` in [0, 1) picks in proportion to flux, and where in the picture
    /// `u` in [0, 1)² falls; `None` when all is black.
    pub fn choose(&self, u_choice: f32, u: Vec2) -> Option<EnvironmentPart> {
        let (part, ..) = self.parts.as_ref()?.sample(u_choice);
        match (part, &self.map) {
            (SKY, _) => Some(EnvironmentPart::Sky),
            (AMBIENT, _) => Some(EnvironmentPart::Ambient),
            (_, map) => map
                .as_ref()
                .map(|map| EnvironmentPart::Map(map.distribution.sample_continuous(u).0)),
        }
    }

    pub(super) fn sample(&self, u_choice: f32, u: Vec2) -> Option<LightSample> {
        let wi = match self.choose(u_choice, u)? {
            EnvironmentPart::Sky => uniform_sphere(u),
            EnvironmentPart::Ambient => {
                let up = uniform_hemisphere(u);
                Vec3::new(up.y, up.z, up.x)
            }
            EnvironmentPart::Map(uv) => self.map.as_ref()?.direction(uv),
        };
        Some(LightSample {
            wi,
            distance: f32::INFINITY,
            // By direction, not by texel: rounding may have carried it over an edge, and emission
            // and density must belong to the same texel.
            radiance: self.radiance(wi, false),
            pdf: usable_pdf(self.pdf(wi))?,
            is_delta: false,
            point: Vec3::ZERO,
            normal: Vec3::ZERO,
        })
    }

    /// The density of the mixture of all parts.
    pub(super) fn pdf(&self, wi: Vec3) -> f32 {
        let Some(parts) = &self.parts else {
            return 0.0;
        };
        let above = if wi.y > 0.0 {
            UNIFORM_HEMISPHERE_PDF
        } else {
            0.0
        };
        let map = self.map.as_ref().map_or(0.0, |map| map.pdf(wi));
        parts.pmf(SKY) * UNIFORM_SPHERE_PDF + parts.pmf(AMBIENT) * above + parts.pmf(MAP) * map
    }

    pub(super) fn power(&self, scene_radius: f32) -> f32 {
        PI * scene_radius * scene_radius * self.flux
    }
}

const SKY: usize = 0;
const AMBIENT: usize = 1;
const MAP: usize = 2;

/// A latitude-longitude picture and the density proportional to its luminance.
#[derive(Clone, Debug, PartialEq)]
struct Map {
    image: Arc<Image<Rgb>>,
    /// Over (column, row), proportional to luminance times solid angle of the texels.
    distribution: Distribution2d,
    /// cos θ at the upper edge of each row and at the lower edge of the last.
    edges: Vec<f64>,
    /// ∫ luminance dω.
    flux: f32,
}

impl Map {
    /// `None` when the picture has no bright texel.
    fn new(image: Arc<Image<Rgb>>) -> Option<Self> {
        let (width, height) = (image.width(), image.height());
        if width == 0 || height == 0 {
            return None;
        }
        let edges: Vec<f64> = (0..=height)
            .map(|row| (std::f64::consts::PI * row as f64 / height as f64).cos())
            .collect();
        let weights: Vec<f32> = image
            .pixels()
            .iter()
            .enumerate()
            .map(|(i, &texel)| luminance(texel) * band(&edges, i / width) / width as f32)
            .collect();
        let usable = weights.iter().filter(|w| w.is_finite() && **w > 0.0);
        let flux = usable.map(|&w| f64::from(w)).sum::<f64>() as f32;
        let distribution = Distribution2d::new(width, &weights)?;
        Some(Self {
            image,
            distribution,
            edges,
            flux,
        })
    }

    /// The direction of a place of the picture. Even places become even over the solid angle of a
    /// texel, so that the density is exactly the picture.
    fn direction(&self, uv: Vec2) -> Vec3 {
        let place = f64::from(uv.y) * self.image.height() as f64;
        let row = (place as usize).min(self.image.height() - 1);
        let (top, bottom) = (self.edges[row], self.edges[row + 1]);
        let cos_theta = top + (bottom - top) * (place - row as f64);
        let sin_theta = ((1.0 - cos_theta) * (1.0 + cos_theta)).max(0.0).sqrt() as f32;
        let (sin_phi, cos_phi) = (TAU * uv.x).sin_cos();
        Vec3::new(-sin_theta * cos_phi, cos_theta as f32, sin_theta * sin_phi)
    }

    fn pdf(&self, direction: Vec3) -> f32 {
        let uv = place_of(direction);
        let (_, row) = self.texel(uv);
        // From the unit square to the sphere: every row has the same share of the square.
        self.distribution.pdf(uv) / (band(&self.edges, row) * self.image.height() as f32)
    }

    fn radiance(&self, direction: Vec3) -> Rgb {
        let (column, row) = self.texel(place_of(direction));
        *self.image.get(column, row)
    }

    fn texel(&self, uv: Vec2) -> (usize, usize) {
        let (width, height) = (self.image.width(), self.image.height());
        let column = (uv.x * width as f32) as usize;
        let row = (uv.y * height as f32) as usize;
        (column.min(width - 1), row.min(height - 1))
    }
}

/// The solid angle of row `row`, in steradians.
fn band(edges: &[f64], row: usize) -> f32 {
    (std::f64::consts::TAU * (edges[row] - edges[row + 1])) as f32
}

/// Column and row as shares of the picture, in 0..=1.
fn place_of(direction: Vec3) -> Vec2 {
    let phi = (-direction.z).atan2(direction.x) + PI;
    let theta = direction.x.hypot(direction.z).atan2(direction.y);
    Vec2::new(phi / TAU, theta / PI)
}
