//! What the paths of a batch lend to and take from each other ([`super::super::reuse`]), in lanes:
//! lanes run over clusters, rows of them over the members of clusters.

mod connect;
mod rows;

use super::super::furnace::PATHS_PER_PROBE;
use super::super::reuse::{Receiver, SharedVertex};
use super::super::{PathCounts, PathTracer};
use crate::color::Rgb;
use crate::math::{LaneKernel, Lanes, ROW, Ray, run_lanes};
use crate::sampling::PathSampler;
use connect::{Reach, TakeIn};
use rows::{ReceiverRow, SharedRow};

/// Connecting rays that are traced together, about.
const MOST_CONNECTING: usize = 4096;

/// No receiver, as a number of bounces.
const NONE: u32 = u32::MAX;

/// Receivers and shared vertices of all paths of a batch, and the rays between them.
#[derive(Debug, Default)]
pub(super) struct Reuse {
    /// Paths in a cluster.
    members: usize,
    /// Clusters in a row: the lanes of the instruction set.
    width: usize,
    /// Rows of clusters.
    rows: usize,
    /// By number of the path: bounces before its receiver, or [`NONE`].
    bounces: Vec<u32>,
    /// By number of the path: as of [`super::super::reuse::Stage::Arriving`].
    scales: Vec<f32>,
    /// Of member m in row r at m · rows + r.
    receivers: Vec<ReceiverRow>,
    shared: Vec<SharedRow>,
    /// π times densities, of a row of clusters: of receiver j for the shared vertex of member k, at
    /// (row · members + k) · members + j.
    reach: Vec<[f32; ROW]>,
    rays: Vec<Ray>,
    /// The sky that corrects what receivers take in ([`super::super::furnace`]).
    furnace: Option<Rgb>,
    /// By row, a lane for each cluster: the part of its probes that find the sky. Empty without furnace.
    openness: Vec<[f32; ROW]>,
    /// Which number of `reach`, or of `openness`, each ray is for: row, lane.
    asked: Vec<(u32, u32)>,
    occluded: Vec<bool>,
}

/// The lanes of an instruction set.
struct Width;

impl LaneKernel for Width {
    type Answer = usize;

    #[inline(always)]
    fn run<L: Lanes>(self) -> usize {
        L::N
    }
}

impl Reuse {
    /// Forgets everything; `paths` are in clusters as `tracer` says, one after the other.
    ///
    /// # Panics
    /// When a cluster lacks paths.
    pub(super) fn begin(&mut self, tracer: &PathTracer<'_>, paths: usize) {
        self.members = tracer.cluster_size();
        if self.members == 1 {
            return;
        }
        assert!(
            paths.is_multiple_of(self.members),
            "a cluster of {} has {} paths too many",
            self.members,
            paths % self.members
        );
        self.furnace = tracer.furnace;
        self.width = run_lanes(tracer.scene.aggregate().isa(), Width);
        self.rows = (paths / self.members).div_ceil(self.width);
        self.bounces.clear();
        self.bounces.resize(paths, NONE);
        self.scales.clear();
        self.scales.resize(paths, 1.0);
        let rows = self.members * self.rows;
        self.receivers.resize(rows, ReceiverRow::NONE);
        self.shared.resize(rows, SharedRow::NONE);
        for (receivers, shared) in self.receivers.iter_mut().zip(&mut self.shared) {
            receivers.clear();
            shared.clear();
        }
    }

    /// True when paths share their light.
    pub(super) fn is_on(&self) -> bool {
        self.members > 1
    }

    /// Bounces before the receiver of path `id`; `None` without one.
    pub(super) fn receiver_bounce(&self, id: u32) -> Option<u32> {
        let bounce = self.bounces[id as usize];
        (bounce != NONE).then_some(bounce)
    }

    /// Scale of what path `id` will share.
    pub(super) fn scale(&self, id: u32) -> f32 {
        self.scales[id as usize]
    }

    /// Takes note of the scale of a path that has left its receiver.
    pub(super) fn aim(&mut self, id: u32, scale: f32) {
        self.scales[id as usize] = scale;
    }

    pub(super) fn receive(&mut self, id: u32, receiver: &Receiver) {
        self.bounces[id as usize] = receiver.bounce;
        let (row, lane) = self.place(id);
        self.receivers[row].set(lane, receiver);
    }

    pub(super) fn share(&mut self, id: u32, vertex: &SharedVertex) {
        let bounce = self.bounces[id as usize];
        let (row, lane) = self.place(id);
        self.shared[row].set(lane, vertex, bounce);
    }

    /// Row and lane of path `id`.
    #[inline(always)]
    fn place(&self, id: u32) -> (usize, usize) {
        let (members, width) = (self.members, self.width);
        let (cluster, member) = (
            id as usize >> members.trailing_zeros(),
            id as usize & (members - 1),
        );
        let row = member * self.rows + (cluster >> width.trailing_zeros());
        (row, cluster & (width - 1))
    }

    /// Adds what each path takes in to its radiance. The first half of `radiance` belongs to the
    /// paths; the second is what leaves their shared vertices.
    pub(super) fn exchange(
        &mut self,
        tracer: &PathTracer<'_>,
        samplers: &[PathSampler],
        radiance: &mut [Rgb],
        counts: &mut PathCounts,
    ) {
        if !self.is_on() {
            return;
        }
        let isa = tracer.scene.aggregate().isa();
        if self.furnace.is_some() {
            self.probe(tracer, samplers, counts);
        }
        let (own, lent) = radiance.split_at_mut(radiance.len() / 2);
        let rays = self.width * self.members * (self.members - 1);
        let part = (MOST_CONNECTING / rays).max(1);
        for first in (0..self.rows).step_by(part) {
            let rows = first..(first + part).min(self.rows);
            self.rays.clear();
            self.asked.clear();
            self.reach
                .resize(rows.len() * self.members * self.members, [0.0; ROW]);
            let reach = Reach {
                reuse: self,
                lent,
                rows: rows.clone(),
            };
            run_lanes(isa, reach);
            self.trace(tracer, counts);
            self.block();
            let take_in = TakeIn {
                reuse: self,
                lent,
                own,
                rows,
            };
            run_lanes(isa, take_in);
        }
    }

    /// Finds out how open each cluster is. `samplers` are those of all paths.
    fn probe(
        &mut self,
        tracer: &PathTracer<'_>,
        samplers: &[PathSampler],
        counts: &mut PathCounts,
    ) {
        let mut probes = vec![[0.0_f32; ROW]; self.rows];
        self.rays.clear();
        self.asked.clear();
        for (id, sampler) in (0..)
            .zip(samplers)
            .step_by(PATHS_PER_PROBE.min(self.members))
        {
            if self.bounces[id as usize] == NONE {
                continue;
            }
            let (of_member, lane) = self.place(id);
            let row = of_member % self.rows;
            probes[row][lane] += 1.0;
            if let Some(ray) = self.receivers[of_member].get(lane).probe(sampler) {
                self.rays.push(ray);
                self.asked.push((row as u32, lane as u32));
            }
        }
        self.trace(tracer, counts);
        self.openness.clear();
        self.openness.resize(self.rows, [0.0; ROW]);
        for (&(row, lane), &occluded) in self.asked.iter().zip(&self.occluded) {
            if !occluded {
                let (row, lane) = (row as usize, lane as usize);
                self.openness[row][lane] += 1.0;
            }
        }
        let all = probes.as_flattened().iter();
        for (openness, &probes) in self.openness.as_flattened_mut().iter_mut().zip(all) {
            if probes > 0.0 {
                *openness /= probes;
            }
        }
    }

    /// Takes the reach of receivers that do not see the shared vertex.
    fn block(&mut self) {
        for (&(row, lane), &occluded) in self.asked.iter().zip(&self.occluded) {
            if occluded {
                self.reach[row as usize][lane as usize] = 0.0;
            }
        }
    }

    /// Finds out which of the rays are occluded.
    fn trace(&mut self, tracer: &PathTracer<'_>, counts: &mut PathCounts) {
        self.occluded.clear();
        self.occluded.resize(self.rays.len(), false);
        let aggregate = tracer.scene.aggregate();
        aggregate.any_hit(&self.rays, &mut self.occluded, &mut counts.trace);
        counts.shadow_rays += self.rays.len() as u64;
    }
}
