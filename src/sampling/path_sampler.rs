mod lanes;

use glam::Vec2;

use super::digital_net::{index_in_pair, point};
use super::scramble::{mix_32, mix_64, scramble, shuffle};
use super::turns::turn;
use super::warp::LATTICE_CELL;

pub use lanes::PathSamplerLanes;

/// What a random number is used for at one bounce; together with the bounce it is the dimension.
///
/// Numbers are addressed, never drawn in sequence, so that leaving one out changes no other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    /// Position inside the pixel (2-D).
    Pixel,
    /// Position on the lens (2-D).
    Lens,
    /// Direction of the scattered ray (2-D).
    Scatter,
    /// Choice of lobe: x.
    Lobe,
    /// Russian roulette: x.
    Roulette,
    /// Direction in which a path looks whether the sky is free (2-D).
    Openness,
    /// Choice of a light for direct light sample `.0`: x picks the light, y a part of it.
    LightChoice(u32),
    /// Point on the light for direct light sample `.0` (2-D).
    LightPoint(u32),
    /// Uniform hemisphere direction number `.0` (2-D).
    Hemisphere(u32),
}

impl Slot {
    fn index(self) -> u32 {
        match self {
            Self::Pixel => 0,
            Self::Lens => 1,
            Self::Scatter => 2,
            Self::Lobe => 3,
            Self::Roulette => 4,
            Self::Openness => 5,
            Self::LightChoice(n) => 8 + 3 * n,
            Self::LightPoint(n) => 9 + 3 * n,
            Self::Hemisphere(n) => 10 + 3 * n,
        }
    }

    /// True for what decides about the light that leaves the shared vertex of a path, or where that is.
    fn is_shared(self, bounce: u32) -> bool {
        let is_direct = matches!(
            self,
            Self::LightChoice(_) | Self::LightPoint(_) | Self::Hemisphere(_)
        );
        !matches!(self, Self::Pixel | Self::Lens) && (bounce > 0 || !is_direct)
    }

    fn points(self, bounce: u32) -> Points {
        match (self, bounce) {
            (Self::Pixel, 0) => Points::Pair(0),
            (Self::Scatter, 0..=2) => Points::Pair(1 + 2 * bounce as usize),
            (Self::LightPoint(0), 0..=2) => Points::Pair(2 + 2 * bounce as usize),
            (Self::Roulette, _) => Points::Independent,
            _ => Points::Shuffled,
        }
    }
}

/// The points of a slot over the samples of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Points {
    /// A pair of dimensions of the net: where most of a path's variance hangs.
    Pair(usize),
    /// Low-discrepancy points in an order of their own.
    Shuffled,
    /// Independent points: where an even spread gains nothing.
    Independent,
}

/// The random numbers of sample `sample` of pixel `pixel`: a pure function of
/// (seed, pixel, sample, bounce, slot).
///
/// Over the samples of one pixel they are low-discrepancy points, scrambled at random: in each slot
/// the first 2ᵏ samples have one point in each elementary interval of area 2⁻ᵏ (and so have the
/// next 2ᵏ). The pixel's own, and the scatter and (first) light slots of the first three bounces
/// are pairs of one net, so that they are spread well together; every other slot has the points in
/// an order of its own, but for roulette, whose numbers are independent. Different pixels, seeds and
/// replicates are independent; but what the paths of a cluster draw for the light that they share
/// ([`Self::in_cluster`]) are points of one sequence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathSampler {
    /// Of the pixel.
    own: Sequence,
    /// Of the cluster.
    shared: Sequence,
}

/// A point of a randomized net.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Sequence {
    /// Of seed, pixel and replicate.
    key: [u32; 2],
    /// Number of the point in its replicate.
    index: u32,
}

/// The place of a path in its cluster.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Member {
    /// The first pixel of the cluster.
    pub first: [u32; 2],
    /// Number of the path in the cluster.
    pub number: u32,
    /// Paths in the cluster, a power of two.
    pub size: u32,
}

/// Sets the keys of clusters apart from those of pixels.
const OF_CLUSTERS: u64 = 0xA076_1D64_78BD_642F;

impl Sequence {
    fn new(seed: u64, pixel: [u32; 2], sample: u32, replicates: u32) -> Self {
        let pixel = u64::from(pixel[0]) | (u64::from(pixel[1]) << 32);
        let key = mix_64(mix_64(seed ^ 0x9E37_79B9_7F4A_7C15).wrapping_add(pixel));
        let replicate = u64::from(sample % replicates);
        let key = mix_64(key ^ replicate.wrapping_mul(0xD1B5_4A32_D192_ED03));
        Self {
            key: [key as u32, (key >> 32) as u32],
            index: sample / replicates,
        }
    }
}

impl PathSampler {
    /// The numbers of one path, of a pixel of the whole image, so that regions and tiles see the
    /// same numbers.
    pub fn new(seed: u64, pixel: [u32; 2], sample: u32) -> Self {
        Self::replicated(seed, pixel, sample, 1)
    }

    /// The same with the samples of a pixel dealt out to `replicates` (at least 1) sequences that
    /// are independent of each other: sample i is number i / `replicates` of replicate
    /// i mod `replicates`. The spread of the means of the replicates is an honest measure of the
    /// error, while the spread of low-discrepancy samples is too large (Owen 1997, "Monte Carlo
    /// Variance of Scrambled Net Quadrature").
    pub fn replicated(seed: u64, pixel: [u32; 2], sample: u32, replicates: u32) -> Self {
        let own = Sequence::new(seed, pixel, sample, replicates);
        Self { own, shared: own }
    }

    /// The same for a path that shares its light with the others of a cluster: from its scattering at
    /// the first surface on, sample i of all paths of a cluster takes the next `member.size` points of
    /// one sequence. Which path takes which changes from sample to sample, so that the points of
    /// each are even too.
    pub fn in_cluster(
        seed: u64,
        (pixel, sample): ([u32; 2], u32),
        replicates: u32,
        member: Member,
    ) -> Self {
        let own = Sequence::new(seed, pixel, sample, replicates);
        let Member {
            first,
            number,
            size,
        } = member;
        if size == 1 {
            return Self { own, shared: own };
        }
        let of_cluster = Sequence::new(seed ^ OF_CLUSTERS, first, sample, replicates);
        let turn = turn(size, of_cluster.index);
        let shared = Sequence {
            index: of_cluster.index.wrapping_mul(size) | (number ^ turn),
            ..of_cluster
        };
        Self { own, shared }
    }

    /// The sequence of a slot.
    #[inline(always)]
    fn sequence(&self, bounce: u32, slot: Slot) -> &Sequence {
        if slot.is_shared(bounce) {
            &self.shared
        } else {
            &self.own
        }
    }

    /// Two numbers in [0, 1), on the lattice of multiples of 2⁻²⁴ (never 1).
    pub fn get_2d(&self, bounce: u32, slot: Slot) -> Vec2 {
        let Sequence { key, index } = *self.sequence(bounce, slot);
        let seed_x = mix_32(key[0] ^ dimension(bounce, slot));
        let seed_y = mix_32(key[1] ^ seed_x);
        let index = match slot.points(bounce) {
            Points::Pair(pair) => index_in_pair(pair, index),
            Points::Shuffled => shuffle(index, mix_32(seed_x ^ seed_y)),
            Points::Independent => {
                let x = mix_32(seed_x ^ index.wrapping_mul(INDEPENDENT));
                return Vec2::new(unit(x), unit(mix_32(seed_y ^ x)));
            }
        };
        let [x, y] = point(index);
        Vec2::new(unit(scramble(x, seed_x)), unit(scramble(y, seed_y)))
    }

    /// One number in [0, 1).
    pub fn get_1d(&self, bounce: u32, slot: Slot) -> f32 {
        self.get_2d(bounce, slot).x
    }
}

/// What multiplies the number of the sample where points are independent.
const INDEPENDENT: u32 = 0x85EB_CA77;

/// A number for each slot of each bounce: 2²⁰ slots for each of 4096 bounces; no path is longer.
fn dimension(bounce: u32, slot: Slot) -> u32 {
    (bounce.rotate_left(20) ^ slot.index()).wrapping_mul(0x9E37_79B1)
}

/// The first 24 binary digits, of which the first is the lowest bit.
fn unit(digits: u32) -> f32 {
    (digits.reverse_bits() >> 8) as f32 * LATTICE_CELL
}

#[cfg(test)]
mod tests;
