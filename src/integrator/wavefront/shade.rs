use std::ops::Range;

use super::super::reuse::{Receiver, SharedVertex, Stage};
use super::guided::GuidedLanes;
use super::paths::{PathState, Paths};
use super::queue::DirectQueues;
use super::reuse::Reuse;
use super::surface::{Found, SurfaceArrays, SurfaceLanes};
use super::{Path, PathCounts, PathTracer, Vertex};
use crate::color::Rgb;
use crate::geometry::Hit;
use crate::math::{Frame, FrameLanes, LaneKernel, Lanes, ROW, Vec3Array, Vec3Lanes, set_bits};
use crate::sampling::{PathSampler, PathSamplerLanes, Slot};

/// One bounce of a range of paths: emission is added to their radiance, rays of direct light to the
/// queues, and the paths that go on to `next`.
pub(super) struct Shade<'a, 's> {
    pub(super) tracer: &'a PathTracer<'s>,
    pub(super) paths: &'a Paths,
    pub(super) hits: &'a [Hit],
    pub(super) samplers: &'a [PathSampler],
    pub(super) bounce: u32,
    pub(super) range: Range<usize>,
    pub(super) radiance: &'a mut [Rgb],
    pub(super) reuse: &'a mut Reuse,
    pub(super) next: &'a mut Paths,
    pub(super) direct: &'a mut DirectQueues,
    pub(super) counts: &'a mut PathCounts,
}

/// Eight paths of which some have met plain surfaces.
pub(super) struct Group<'s, L: Lanes> {
    /// Index of the first.
    pub(super) first: usize,
    /// A bit for each path on a plain surface.
    pub(super) lanes: u32,
    /// Those whose geometric normal has taken the place of the shading normal.
    mended: u32,
    /// Where the light of each path is added up.
    pub(super) tallies: [u32; ROW],
    pub(super) surface: SurfaceLanes<L>,
    pub(super) frame: FrameLanes<L>,
    /// Cosine between shading normal and the way that the path came.
    pub(super) wo_z: L,
    pub(super) throughput: Vec3Lanes<L>,
    /// For the direct light, and, but at the first surface, for all else.
    pub(super) sampler: PathSamplerLanes<L>,
    /// Where some of them aim their rays.
    pub(super) guided: Option<GuidedLanes<'s>>,
}

impl<L: Lanes> Group<'_, L> {
    /// As [`Vertex::lit_normal`].
    #[inline(always)]
    pub(super) fn lit_normal(&self) -> Vec3Lanes<L> {
        self.lit_side(self.surface.shading_normal)
    }

    /// As [`Vertex::lit_side`].
    #[inline(always)]
    fn lit_side(&self, normal: Vec3Lanes<L>) -> Vec3Lanes<L> {
        Vec3Lanes::select(self.wo_z.lt(L::splat(0.0)), -normal, normal)
    }

    /// Where directions with the cosines `z` to the shading normals lie strictly on the side from which
    /// the paths came.
    #[inline(always)]
    pub(super) fn is_same_side(&self, z: L) -> L::Mask {
        let zero = L::splat(0.0);
        (self.wo_z.gt(zero) & z.gt(zero)) | (self.wo_z.lt(zero) & z.lt(zero))
    }
}

impl LaneKernel for Shade<'_, '_> {
    type Answer = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        let bounces_on = self.bounce < self.tracer.settings.max_depth.0;
        let plain = self.tracer.scene.plain_surfaces();
        let mut found = Found::NONE;
        for first in self.range.clone().step_by(L::N) {
            let end = (first + L::N).min(self.range.end);
            let (rays, hits) = (&self.paths.rays[first..end], &self.hits[first..end]);
            found.look_up(&plain, rays, hits);
            for index in first..end {
                if found.lanes >> (index - first) & 1 == 0 {
                    self.shade_one(index);
                }
            }
            if found.lanes != 0 && bounces_on {
                let mut group = self.group::<L>(first, &found);
                if self.reuse.is_on() {
                    self.share(&mut group);
                }
                self.direct_light(&group);
                let receivers = if self.reuse.is_on() {
                    self.receive(&group)
                } else {
                    0
                };
                self.scatter(&group, receivers);
            }
        }
    }
}

impl<'s> Shade<'_, 's> {
    #[inline(always)]
    fn group<L: Lanes>(&self, first: usize, found: &Found) -> Group<'s, L> {
        let mut surface = found.surfaces::<L>();
        let (mut directions, mut throughputs) = (Vec3Array::ZERO, Vec3Array::ZERO);
        let mut tallies = [0; ROW];
        let rest = self.paths.rays[first..]
            .iter()
            .zip(&self.paths.states[first..]);
        for (lane, (ray, state)) in rest.enumerate().take(L::N) {
            directions.set(lane, ray.direction);
            throughputs.set(lane, state.throughput);
            tallies[lane] = state.tally;
        }
        let samplers = self.samplers_from(first);
        let wo = -Vec3Lanes::load(&directions);
        let agree = wo.dot(surface.geometric_normal) * wo.dot(surface.shading_normal);
        let mended = agree.le(L::splat(0.0));
        surface.shading_normal =
            Vec3Lanes::select(mended, surface.geometric_normal, surface.shading_normal);
        let mut group = Group {
            first,
            lanes: found.lanes,
            mended: L::bits(mended),
            tallies,
            frame: FrameLanes::from_normal(surface.shading_normal),
            wo_z: surface.shading_normal.dot(wo),
            surface,
            throughput: Vec3Lanes::load(&throughputs),
            sampler: PathSamplerLanes::new(samplers, self.bounce, Slot::LightPoint(0)),
            guided: None,
        };
        if let Some(guide) = self.tracer.guide_after(self.bounce) {
            group.guided = GuidedLanes::look_up(guide, &group);
        }
        group
    }

    /// The samplers of the paths from `first` on.
    #[inline(always)]
    pub(super) fn samplers_from(&self, first: usize) -> impl Iterator<Item = PathSampler> {
        let states = self.paths.states[first..].iter();
        states.map(|state| self.samplers[state.id as usize])
    }

    /// The path `index` by the steps of the reference.
    fn shade_one(&mut self, index: usize) {
        let mut path = self.path(index);
        let PathState { id, mut tally, .. } = self.paths.states[index];
        let hit = &self.hits[index];
        if hit.is_miss() && self.tracer.shares_sky(&path) {
            let sky = SharedVertex::sky(path.ray.direction);
            tally = self.share_one(id, &mut path, &sky);
        }
        let vertex = self.tracer.arrive(&mut path, hit);
        self.radiance[tally as usize] = path.radiance;
        let Some(vertex) = vertex else {
            return;
        };
        if self.tracer.shares(&path, &vertex) {
            tally = self.share_one(id, &mut path, &SharedVertex::surface(&vertex));
        }
        if self.tracer.wants_direct(&path, &vertex) {
            for number in 0..self.tracer.plan.len() as u32 {
                self.direct_ray(tally, &path, &vertex, number);
            }
        }
        if let Some(receiver) = self.tracer.receive(&mut path, &vertex) {
            self.reuse.receive(id, &receiver);
        }
        if self.tracer.scatter(&mut path, &vertex) {
            self.next.push((id, tally), &path);
            if let Stage::Arriving { scale, .. } = path.stage {
                self.reuse.aim(id, scale);
            }
        }
    }

    /// Shares `vertex` of path `id`; returns where its light is added up from now on.
    fn share_one(&mut self, id: u32, path: &mut Path, vertex: &SharedVertex) -> u32 {
        path.share();
        self.reuse.share(id, vertex);
        id + self.samplers.len() as u32
    }

    fn path(&self, index: usize) -> Path {
        let PathState { id, tally, .. } = self.paths.states[index];
        (self.paths).path(
            index,
            (self.bounce, self.stage(id, tally)),
            self.samplers[id as usize],
            self.radiance[tally as usize],
        )
    }

    fn stage(&self, id: u32, tally: u32) -> Stage {
        if !self.reuse.is_on() {
            return Stage::Alone;
        }
        if tally != id {
            return Stage::Shared;
        }
        match self.reuse.receiver_bounce(id) {
            None => Stage::Waiting,
            Some(bounce) => Stage::Arriving {
                bounce: bounce + 1,
                scale: self.reuse.scale(id),
            },
        }
    }

    /// [`Self::share_one`] of those of a group that come straight from their receivers.
    fn share<L: Lanes>(&mut self, group: &mut Group<'_, L>) {
        let mut shared = 0;
        for lane in set_bits(group.lanes & !group.mended) {
            let PathState { id, tally, .. } = self.paths.states[group.first + lane];
            if tally == id && self.reuse.receiver_bounce(id).map(|b| b + 1) == Some(self.bounce) {
                shared |= 1 << lane;
            }
        }
        if shared == 0 {
            return;
        }
        let surface = &group.surface;
        let (point, error) = (surface.point.store(), surface.error.store());
        let geometric = group.lit_side(surface.geometric_normal).store();
        let shading = group.lit_normal().store();
        let mut throughput = group.throughput.store();
        for lane in set_bits(shared) {
            let id = self.paths.states[group.first + lane].id;
            throughput.set(lane, Rgb::splat(self.reuse.scale(id)));
            let vertex = SharedVertex {
                place: point.get(lane),
                error: error.get(lane),
                geometric_normal: geometric.get(lane),
                shading_normal: shading.get(lane),
                is_infinite: false,
            };
            self.reuse.share(id, &vertex);
            group.tallies[lane] = id + self.samplers.len() as u32;
        }
        group.throughput = Vec3Lanes::load(&throughput);
    }

    /// Makes receivers of those of a group that wait for one; returns which.
    fn receive<L: Lanes>(&mut self, group: &Group<'_, L>) -> u32 {
        let mut receivers = 0;
        for lane in set_bits(group.lanes) {
            let PathState { id, tally, .. } = self.paths.states[group.first + lane];
            if self.stage(id, tally) == Stage::Waiting {
                receivers |= 1 << lane;
            }
        }
        if receivers == 0 {
            return 0;
        }
        let surface = &group.surface;
        let (point, error) = (surface.point.store(), surface.error.store());
        let departure = surface.departure.store();
        let geometric = group.lit_side(surface.geometric_normal).store();
        let shading = group.lit_normal().store();
        let factor = (group.throughput * surface.reflectance).store();
        for lane in set_bits(receivers) {
            let receiver = Receiver {
                point: point.get(lane),
                departure: departure.get(lane),
                error: error.get(lane),
                geometric_normal: geometric.get(lane),
                shading_normal: shading.get(lane),
                factor: factor.get(lane),
                bounce: self.bounce,
            };
            let id = self.paths.states[group.first + lane].id;
            self.reuse.receive(id, &receiver);
        }
        receivers
    }

    fn direct_ray(&mut self, tally: u32, path: &Path, vertex: &Vertex<'_>, number: u32) {
        match self.tracer.direct_ray(path, vertex, number) {
            None => self.counts.culled_shadow_rays += 1,
            Some(ray) => self.direct.push(tally, ray),
        }
    }

    /// Direct light of the `lanes` of a group whose lights are not sampled in lanes.
    pub(super) fn direct_light_one_by_one<L: Lanes>(
        &mut self,
        group: &Group<'_, L>,
        surfaces: &SurfaceArrays,
    ) {
        for lane in set_bits(group.lanes) {
            let index = group.first + lane;
            let path = self.path(index);
            let primitive = self.hits[index].primitive;
            let surface = surfaces.get(lane, primitive);
            let frame = Frame::from_normal(surface.shading_normal);
            let vertex = Vertex {
                surface,
                frame,
                wo: frame.to_local(-path.ray.direction),
                bsdf: self.tracer.scene.bsdf(primitive),
                is_mended: group.mended >> lane & 1 == 1,
            };
            for number in 0..self.tracer.plan.len() as u32 {
                self.direct_ray(group.tallies[lane], &path, &vertex, number);
            }
        }
    }
}
