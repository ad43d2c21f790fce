//! What the sum of shared light is known to be: a control variate for scenes under an even sky.
//!
//! The weights with which a receiver takes in light have the mean 1, all directions together: those to
//! what is shared ([`super::reuse`]), and 1 for the path's own ray where it met something that is not.
//! If everything shone like the sky, as in a white furnace, the receiver would take in the sky times
//! the sum of weights, and that sum is all that would be noisy. So
//!
//! βⱼ · openness · sky · (1 − sum of weights)
//!
//! is added, whose mean is 0 (βⱼ as there). `openness` says how much of the furnace there is: the part
//! of a few rays that find the sky, drawn apart from all else, or the means would not part. Where it is
//! 1 no noise of the weights is left; a closed room, where the weights vary by more than the light, is
//! spared.
//!
//! A path by itself has such a sum too, and it is always 1: that is why paths alone have no noise where
//! the sky is free, and what sharing would lose.
//!
//! Owen, Zhou 2000, "Safe and Effective Importance Sampling" (mixture densities as control
//! variates).

use super::PathTracer;
use super::reuse::{Receiver, shares_sky};
use crate::color::{Rgb, is_valid_radiance};
use crate::math::{Frame, Ray, offset_origin};
use crate::sampling::{PathSampler, Slot, cosine_hemisphere};

/// One path of so many in a cluster looks whether the sky is free.
pub(super) const PATHS_PER_PROBE: usize = 2;

impl PathTracer<'_> {
    /// What [`Self::furnace`] has to be.
    pub(super) fn find_furnace(&self) -> Option<Rgb> {
        let is_on = self.cluster_size > 1
            && shares_sky(self.scene)
            && self.guide.is_none()
            && !self.settings.only_last_bounce;
        is_on.then(|| (self.scene).environment_radiance(glam::Vec3::Z, false))
    }

    /// True if `radiance` may be that of a sample: corrected ones may be negative.
    pub(super) fn is_valid(&self, radiance: Rgb) -> bool {
        is_valid_radiance(radiance) || self.furnace.is_some() && radiance.is_finite()
    }
}

impl Receiver {
    /// A ray in a direction in which this receiver may scatter one; `None` where that is below the true
    /// surface. It is occluded as often as rays from here do not reach the sky.
    pub(super) fn probe(&self, sampler: &PathSampler) -> Option<Ray> {
        let local = cosine_hemisphere(sampler.get_2d(self.bounce, Slot::Openness));
        let direction = Frame::from_normal(self.shading_normal).to_world(local);
        let normal = self.geometric_normal;
        let origin = offset_origin(self.departure, self.error, normal, direction);
        (direction.dot(normal) > 0.0).then(|| Ray::new(origin, direction))
    }
}
