use super::{PathSampler, Points, Slot, dimension};
use crate::math::{IntLanes, Lanes, ROW};
use crate::sampling::digital_net::{LOW, PASCAL, PLACES, index_in_pair};
use crate::sampling::scramble::{LAINE_KARRAS, MIX_32};
use crate::sampling::warp::LATTICE_CELL;

/// The random numbers of eight paths, the same bits as of each [`PathSampler`].
#[derive(Clone, Copy, Debug)]
pub struct PathSamplerLanes<L: Lanes> {
    key: [L::Ints; 2],
    index: [u32; ROW],
}

impl<L: Lanes> PathSamplerLanes<L> {
    /// Those of up to eight paths, for `slot` at `bounce` and all slots that take part in sharing as it
    /// does; of what is missing anything.
    #[inline(always)]
    pub fn new(samplers: impl Iterator<Item = PathSampler>, bounce: u32, slot: Slot) -> Self {
        let (mut x, mut y, mut index) = ([0; ROW], [0; ROW], [0; ROW]);
        for (lane, sampler) in samplers.enumerate().take(L::N) {
            let sequence = sampler.sequence(bounce, slot);
            x[lane] = sequence.key[0];
            y[lane] = sequence.key[1];
            index[lane] = sequence.index;
        }
        Self {
            key: [L::Ints::load(&x), L::Ints::load(&y)],
            index,
        }
    }

    /// As [`PathSampler::get_2d`].
    #[inline(always)]
    pub fn get_2d(&self, bounce: u32, slot: Slot) -> [L; 2] {
        let dimension = L::Ints::splat(dimension(bounce, slot));
        let seed_x = mix_32::<L>(self.key[0] ^ dimension);
        let seed_y = mix_32::<L>(self.key[1] ^ seed_x);
        let index = match slot.points(bounce) {
            Points::Pair(pair) => self.index_in_pair(pair),
            Points::Shuffled => {
                let index = L::Ints::load(&self.index).reverse_bits();
                scramble::<L>(index, mix_32::<L>(seed_x ^ seed_y)).reverse_bits()
            }
            Points::Independent => {
                let index = L::Ints::load(&self.index) * L::Ints::splat(super::INDEPENDENT);
                let x = mix_32::<L>(seed_x ^ index);
                return [unit::<L>(x), unit::<L>(mix_32::<L>(seed_y ^ x))];
            }
        };
        let y = pascal::<L>(index);
        [
            unit::<L>(scramble::<L>(index, seed_x)),
            unit::<L>(scramble::<L>(y, seed_y)),
        ]
    }

    /// Neighbours usually have the same number but for the place in a cluster, so that one look is
    /// enough.
    #[inline(always)]
    fn index_in_pair(&self, pair: usize) -> L::Ints {
        let first = self.index[0] & !PLACES;
        let mut last = (first, index_in_pair(pair, first));
        let mut indices = [0; ROW];
        for (to, &index) in indices.iter_mut().zip(&self.index).take(L::N) {
            let rest = index & !PLACES;
            if rest != last.0 {
                last = (rest, index_in_pair(pair, rest));
            }
            *to = last.1 ^ LOW[pair][(index & PLACES) as usize];
        }
        L::Ints::load(&indices)
    }
}

#[inline(always)]
fn mix_32<L: Lanes>(x: L::Ints) -> L::Ints {
    let x = (x ^ x.shr::<16>()) * L::Ints::splat(MIX_32[0]);
    let x = (x ^ x.shr::<15>()) * L::Ints::splat(MIX_32[1]);
    x ^ x.shr::<16>()
}

#[inline(always)]
fn scramble<L: Lanes>(x: L::Ints, seed: L::Ints) -> L::Ints {
    let x = x ^ (x * L::Ints::splat(LAINE_KARRAS[0]));
    let x = (x + seed) * (seed.shr::<16>() | L::Ints::splat(1));
    let x = x ^ (x * L::Ints::splat(LAINE_KARRAS[1]));
    x ^ (x * L::Ints::splat(LAINE_KARRAS[2]))
}

/// The second coordinate of [`crate::sampling::digital_net::point`].
#[inline(always)]
fn pascal<L: Lanes>(y: L::Ints) -> L::Ints {
    let y = y ^ (y.shr::<16>() & L::Ints::splat(PASCAL[0]));
    let y = y ^ (y.shr::<8>() & L::Ints::splat(PASCAL[1]));
    let y = y ^ (y.shr::<4>() & L::Ints::splat(PASCAL[2]));
    let y = y ^ (y.shr::<2>() & L::Ints::splat(PASCAL[3]));
    y ^ (y.shr::<1>() & L::Ints::splat(PASCAL[4]))
}

#[inline(always)]
fn unit<L: Lanes>(digits: L::Ints) -> L {
    L::of_ints(digits.reverse_bits().shr::<8>()) * L::splat(LATTICE_CELL)
}

#[cfg(test)]
mod tests {
    use super::super::Member;
    use super::*;
    use crate::math::{Isa, LaneKernel, run_lanes};

    struct Draw<'a>(&'a [PathSampler], u32, Slot);

    impl LaneKernel for Draw<'_> {
        type Answer = [[f32; ROW]; 2];

        fn run<L: Lanes>(self) -> Self::Answer {
            let lanes = PathSamplerLanes::<L>::new(self.0.iter().copied(), self.1, self.2);
            lanes.get_2d(self.1, self.2).map(L::to_array)
        }
    }

    #[test]
    fn lanes_draw_what_single_paths_draw() {
        let samplers: Vec<PathSampler> = (0..800_u32)
            .map(|i| {
                let size = 1 << (i / 200);
                let member = Member {
                    first: [i / size, 0],
                    number: i % size,
                    size,
                };
                PathSampler::in_cluster(9, ([i, i / 7], i * i / 3), 1 + i % 3, member)
            })
            .collect();
        let slots = [
            Slot::Pixel,
            Slot::Scatter,
            Slot::Roulette,
            Slot::Lobe,
            Slot::LightChoice(0),
            Slot::LightPoint(0),
            Slot::LightPoint(3),
        ];
        for eight in samplers.chunks(8) {
            for (bounce, slot) in (0..5).flat_map(|bounce| slots.map(|slot| (bounce, slot))) {
                for isa in Isa::available() {
                    let [x, y] = run_lanes(isa, Draw(eight, bounce, slot));
                    for (lane, sampler) in eight.iter().enumerate() {
                        let expected = sampler.get_2d(bounce, slot);
                        assert_eq!([x[lane], y[lane]], expected.to_array());
                    }
                }
            }
        }
    }
}
