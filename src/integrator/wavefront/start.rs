use super::paths::{FULL, PathState, Paths};
use super::{PathId, PathTracer};
use crate::color::Rgb;
use crate::math::{LaneKernel, Lanes, ROW, Ray};
use crate::sampling::{PathSampler, PathSamplerLanes, Slot};
use glam::Vec3;

/// The camera rays of a batch, as [`PathTracer::start`] makes them, for cameras without a lens.
pub(super) struct Start<'a, 's> {
    pub(super) tracer: &'a PathTracer<'s>,
    pub(super) ids: &'a [PathId],
    pub(super) samplers: &'a [PathSampler],
    pub(super) paths: &'a mut Paths,
}

impl LaneKernel for Start<'_, '_> {
    type Answer = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let camera = self.tracer.camera;
        let eye = camera.eye();
        let groups = self.ids.chunks(L::N).zip(self.samplers.chunks(L::N));
        for (group, (ids, samplers)) in groups.enumerate() {
            let mut position = [[0.0; ROW]; 2];
            for (lane, id) in ids.iter().enumerate() {
                position[0][lane] = id.pixel[0] as f32;
                position[1][lane] = id.pixel[1] as f32;
            }
            let [x, y] = PathSamplerLanes::<L>::new(samplers.iter().copied(), 0, Slot::Pixel)
                .get_2d(0, Slot::Pixel);
            let position = [L::load_row(&position[0]) + x, L::load_row(&position[1]) + y];
            let directions = camera.directions_lanes(position).store();
            for lane in 0..ids.len() {
                self.paths.rays.push(Ray::new(eye, directions.get(lane)));
                self.paths.states.push(PathState {
                    throughput: Rgb::ONE,
                    id: (group * L::N + lane) as u32,
                    tally: (group * L::N + lane) as u32,
                    from: Vec3::ZERO,
                    normal: Vec3::ZERO,
                    scatter_pdf: FULL,
                });
            }
        }
    }
}
