use std::ops::Range;

use super::paths::Paths;
use super::queue::DirectQueues;
use super::surface::{Found, SurfaceArrays, SurfaceLanes};
use super::{Path, PathCounts, PathTracer, Vertex};
use crate::color::Rgb;
use crate::geometry::Hit;
use crate::math::{Frame, FrameLanes, LaneKernel, Lanes, Vec3Array, Vec3Lanes, set_bits};
use crate::sampling::{PathSampler, PathSamplerLanes};

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
    pub(super) next: &'a mut Paths,
    pub(super) direct: &'a mut DirectQueues,
    pub(super) counts: &'a mut PathCounts,
}

/// Eight paths of which some have met plain surfaces.
pub(super) struct Group<L: Lanes> {
    /// Index of the first.
    pub(super) first: usize,
    /// A bit for each path on a plain surface.
    pub(super) lanes: u32,
    pub(super) surface: SurfaceLanes<L>,
    pub(super) frame: FrameLanes<L>,
    /// Cosine between shading normal and the way that the path came.
    pub(super) wo_z: L,
    pub(super) throughput: Vec3Lanes<L>,
    pub(super) sampler: PathSamplerLanes<L>,
}

impl<L: Lanes> Group<L> {
    /// As [`Vertex::lit_normal`].
    #[inline(always)]
    pub(super) fn lit_normal(&self) -> Vec3Lanes<L> {
        let normal = self.surface.shading_normal;
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
                let group = self.group::<L>(first, &found);
                self.direct_light(&group);
                self.scatter(&group);
            }
        }
    }
}

impl<'s> Shade<'_, 's> {
    #[inline(always)]
    fn group<L: Lanes>(&self, first: usize, found: &Found) -> Group<L> {
        let mut surface = found.surfaces::<L>();
        let (mut directions, mut throughputs) = (Vec3Array::ZERO, Vec3Array::ZERO);
        let rest = self.paths.rays[first..]
            .iter()
            .zip(&self.paths.states[first..]);
        for (lane, (ray, state)) in rest.enumerate().take(L::N) {
            directions.set(lane, ray.direction);
            throughputs.set(lane, state.throughput);
        }
        let states = self.paths.states[first..].iter();
        let samplers = states.map(|state| self.samplers[state.id as usize]);
        let wo = -Vec3Lanes::load(&directions);
        let agree = wo.dot(surface.geometric_normal) * wo.dot(surface.shading_normal);
        surface.shading_normal = Vec3Lanes::select(
            agree.le(L::splat(0.0)),
            surface.geometric_normal,
            surface.shading_normal,
        );
        Group {
            first,
            lanes: found.lanes,
            frame: FrameLanes::from_normal(surface.shading_normal),
            wo_z: surface.shading_normal.dot(wo),
            surface,
            throughput: Vec3Lanes::load(&throughputs),
            sampler: PathSamplerLanes::new(samplers),
        }
    }

    /// The path `index` by the steps of the reference.
    fn shade_one(&mut self, index: usize) {
        let mut path = self.path(index);
        let id = self.paths.states[index].id;
        let vertex = self.tracer.arrive(&mut path, &self.hits[index]);
        self.radiance[id as usize] = path.radiance;
        let Some(vertex) = vertex else {
            return;
        };
        if self.tracer.wants_direct(&path, &vertex) {
            for number in 0..self.tracer.plan.len() as u32 {
                self.direct_ray(id, &path, &vertex, number);
            }
        }
        if self.tracer.scatter(&mut path, &vertex) {
            self.next.push(id, &path);
        }
    }

    fn path(&self, index: usize) -> Path {
        let id = self.paths.states[index].id as usize;
        (self.paths).path(index, self.bounce, self.samplers[id], self.radiance[id])
    }

    fn direct_ray(&mut self, id: u32, path: &Path, vertex: &Vertex<'_>, number: u32) {
        match self.tracer.direct_ray(path, vertex, number) {
            None => self.counts.culled_shadow_rays += 1,
            Some(ray) => self.direct.push(id, ray),
        }
    }

    /// Direct light of the `lanes` of a group whose lights are not sampled in lanes.
    pub(super) fn direct_light_one_by_one(
        &mut self,
        first: usize,
        lanes: u32,
        surfaces: &SurfaceArrays,
    ) {
        for lane in set_bits(lanes) {
            let index = first + lane;
            let path = self.path(index);
            let primitive = self.hits[index].primitive;
            let surface = surfaces.get(lane, primitive);
            let frame = Frame::from_normal(surface.shading_normal);
            let vertex = Vertex {
                surface,
                frame,
                wo: frame.to_local(-path.ray.direction),
                bsdf: self.tracer.scene.bsdf(primitive),
            };
            let id = self.paths.states[index].id;
            for number in 0..self.tracer.plan.len() as u32 {
                self.direct_ray(id, &path, &vertex, number);
            }
        }
    }
}
