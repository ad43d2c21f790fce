use std::f64::consts::{PI, TAU};

use glam::{DVec2, Vec3};
use softbox::math::Frame;

/// Keeps horizons and planes of symmetry off the edges of the cells.
const TURN: f64 = 0.012_3;

/// A map of all directions onto the unit square that spreads out the surroundings of an axis.
///
/// x is the angle about the axis; y is a logarithm of sin²(γ/2), γ being the angle to the axis.
#[derive(Clone, Copy)]
pub(crate) struct Directions {
    frame: Frame,
    stretch: f64,
}

impl Directions {
    /// Half the square is for directions up to about `radius` radians from `axis`; above 2.8 the map
    /// keeps areas.
    pub(crate) fn around(axis: Vec3, radius: f64) -> Self {
        let half = (0.5 * radius).sin().powi(2);
        Self {
            frame: Frame::from_normal(axis.normalize()),
            stretch: if radius < 2.8 {
                (-2.0 * half.ln()).max(0.01)
            } else {
                0.01
            },
        }
    }

    /// The place of the unit vector `direction`.
    pub(crate) fn place(&self, direction: Vec3) -> DVec2 {
        let local = self.frame.to_local(direction).as_dvec3();
        let across2 = local.x * local.x + local.y * local.y;
        let half_sin2 = if local.z > 0.0 {
            across2 / (2.0 * (1.0 + local.z))
        } else {
            0.5 * (1.0 - local.z)
        };
        let turn = (local.y.atan2(local.x) / TAU + 1.0 + TURN).fract();
        let y = (half_sin2.clamp(0.0, 1.0) * self.stretch.exp_m1()).ln_1p() / self.stretch;
        DVec2::new(turn, y)
    }

    /// The density per area of the square that belongs to a density per steradian.
    pub(crate) fn density(&self, place: DVec2, pdf: impl Fn(Vec3) -> f64) -> f64 {
        let half_sin2 = (place.y * self.stretch).exp_m1() / self.stretch.exp_m1();
        let (cos, sin) = (
            1.0 - 2.0 * half_sin2,
            2.0 * (half_sin2 * (1.0 - half_sin2)).sqrt(),
        );
        let phi = TAU * (place.x - TURN);
        let local = glam::DVec3::new(sin * phi.cos(), sin * phi.sin(), cos);
        let direction = self.frame.to_world(local.as_vec3()).normalize();
        let rate = self.stretch * (place.y * self.stretch).exp() / self.stretch.exp_m1();
        4.0 * PI * rate * pdf(direction)
    }
}
