use super::super::{Hit, TraceCounts};
use super::bins::{Bins, CHUNK, WAYS};
use super::packet::{Packet, Sheared};
use super::patch::Patch;
use super::{Sweep, VERTICES};
use crate::math::{LaneKernel, Lanes, ROW, Ray};

/// Traces rays through a small scene. `ANY`: until the first hit.
#[derive(Debug)]
pub(super) struct Trace<'a, F, const ANY: bool> {
    pub(super) sweep: &'a Sweep,
    pub(super) rays: &'a [Ray],
    /// Takes the number of a ray and its hit.
    pub(super) answer: F,
    /// Gets the numbers of the rays that the sweep cannot decide.
    pub(super) rest: &'a mut Vec<u32>,
    pub(super) counts: &'a mut TraceCounts,
}

/// What the packets of a chunk share.
struct Room {
    bins: Bins,
    sheared: Sheared,
    /// Numbers of the patches that an octant can meet.
    candidates: Vec<u32>,
    /// Numbers of their vertices.
    vertices: Vec<u8>,
}

impl<F: FnMut(usize, Hit), const ANY: bool> LaneKernel for Trace<'_, F, ANY> {
    type Answer = ();

    #[inline(always)]
    fn run<V: Lanes>(mut self) {
        let mut room = Room {
            bins: Bins::EMPTY,
            sheared: [[[0.0; ROW]; 2]; VERTICES],
            candidates: Vec::with_capacity(self.sweep.patches.len()),
            vertices: Vec::with_capacity(VERTICES),
        };
        for (number, rays) in self.rays.chunks(CHUNK).enumerate() {
            let first = number * CHUNK;
            room.bins.sort::<V, ANY>(rays);
            for octant in 0..8 {
                self.choose(octant, &mut room);
                for way in (octant..WAYS).step_by(8) {
                    self.sweep_way::<V>(way, (first, rays), &mut room);
                }
            }
            for &i in room.bins.invalid() {
                (self.answer)(first + usize::from(i), Hit::MISS);
            }
            let odd = room.bins.odd().iter();
            self.rest
                .extend(odd.map(|&i| (first + usize::from(i)) as u32));
        }
    }
}

impl<F: FnMut(usize, Hit), const ANY: bool> Trace<'_, F, ANY> {
    /// Chooses the patches that are not behind all rays of an octant, or beyond the ends of all.
    #[inline(always)]
    fn choose(&self, octant: usize, room: &mut Room) {
        let Bins {
            origins, reaches, ..
        } = room.bins;
        let is_out = |patch: &Patch| {
            (0..3).any(|axis| {
                let [low, high] = patch.extent[axis];
                let [start, end] = [origins[axis], reaches[axis]];
                let slack =
                    (start[0].abs().max(start[1].abs()) + end[0].abs().max(end[1].abs())) * 1e-4;
                if octant >> axis & 1 == 0 {
                    high < start[0] || ANY && low > end[1] + slack
                } else {
                    low > start[1] || ANY && high < end[0] - slack
                }
            })
        };
        room.candidates.clear();
        room.vertices.clear();
        let mut is_chosen = [false; VERTICES];
        for (i, patch) in self.sweep.patches.iter().enumerate() {
            if !is_out(patch) {
                room.candidates.push(i as u32);
                for number in patch.corners {
                    if !std::mem::replace(&mut is_chosen[usize::from(number)], true) {
                        room.vertices.push(number);
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn sweep_way<V: Lanes>(&mut self, way: usize, (first, rays): (usize, &[Ray]), room: &mut Room) {
        let Room {
            bins,
            sheared,
            candidates,
            vertices,
        } = room;
        let members = bins.way(way);
        for some in members.chunks(V::N) {
            let last = some.len() - 1;
            let mut chosen = [&rays[usize::from(some[0])]; ROW];
            for (i, ray) in chosen.iter_mut().enumerate().take(V::N).skip(1) {
                *ray = &rays[usize::from(some[i.min(last)])];
            }
            let mut packet = Packet::<V>::new(&chosen, way);
            self.sweep_packet(&mut packet, (sheared, candidates, vertices));
            let odd = V::bits(packet.odd);
            let (t, primitive) = (packet.t.to_array(), packet.primitive.to_array());
            let [b1, b2] = packet.weights();
            let (b1, b2) = (b1.to_array(), b2.to_array());
            for (lane, &i) in some.iter().enumerate() {
                let number = first + usize::from(i);
                let hit = Hit {
                    t: t[lane],
                    // Infinity becomes the largest number, which stands for no primitive.
                    primitive: primitive[lane] as u32,
                    b1: b1[lane],
                    b2: b2[lane],
                };
                (self.answer)(number, hit);
                if odd >> lane & 1 == 1 {
                    self.rest.push(number as u32);
                }
            }
        }
        self.counts.primitive_tests += (members.len() * candidates.len()) as u64;
    }

    #[inline(always)]
    fn sweep_packet<V: Lanes>(
        &self,
        packet: &mut Packet<V>,
        (sheared, candidates, vertices): (&mut Sheared, &[u32], &[u8]),
    ) {
        packet.shear(&self.sweep.vertices, vertices, sheared);
        for &patch in candidates {
            packet.meet::<ANY>(&self.sweep.patches[patch as usize], sheared);
            if ANY && V::bits(packet.has_hit()) == V::ALL {
                return;
            }
        }
        for ball in &self.sweep.spheres {
            packet.meet_sphere(ball);
        }
    }
}
