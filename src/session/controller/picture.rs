use std::time::Instant;

use super::super::adaptive::Schedule;
use super::super::pace::{Progress, eta_seconds, finer_step, next_target, preview_step};
use super::super::preview::Preview;
use super::super::publish::Caption;
use super::super::workers::Workers;
use super::super::{RenderJob, SessionStatus, Snapshot, StopReason};
use crate::camera::RayCamera;
use crate::film::{Film, FilmSummary};
use crate::integrator::{PathCounts, PathSettings, PathTracer};
use crate::scene::PreparedScene;
use crate::session::first_hit_pass::first_hit_pass;
use crate::session::pass::{Stop, clear_pass, render_pass, summary_pass};

/// How far a pass may go beyond the time limit: this share of it, and as many seconds.
const GRACE: f64 = 0.1;

/// One picture in the making: a job, its runtime scene, and the film so far.
#[derive(Debug)]
pub(super) struct Picture {
    pub(super) job: RenderJob,
    pub(super) generation: u64,
    camera: RayCamera,
    film: Film,
    /// False while `film` still holds the samples of the picture before.
    film_is_clear: bool,
    summary: FilmSummary,
    backdrop: Option<Preview>,
    seconds: f64,
    /// Processor time of the workers.
    cpu_seconds: f64,
    counts: PathCounts,
    schedule: Schedule,
    last_pass: Option<(u32, f64)>,
    /// Seconds spent on the pass that is not complete yet.
    pass_seconds: f64,
    /// The view of the first hit that was shown last is still right.
    first_hit_is_done: bool,
}

impl Picture {
    /// A picture without samples. `recycled` is the film of the picture before: new memory for a
    /// large film takes longer than the first look.
    pub(super) fn new(
        job: RenderJob,
        generation: u64,
        scene: &PreparedScene,
        recycled: Option<Film>,
    ) -> Self {
        let settings = &job.settings;
        let (width, height) = (settings.width, settings.height);
        let camera = RayCamera::new(&job.camera, width, height, scene.normalization());
        let region = settings.active_region();
        let replicates = settings.replicates();
        let fits = |film: &Film| film.region() == region && film.replicates() == replicates;
        let recycled = recycled.filter(fits);
        let film_is_clear = recycled.is_none();
        let film = recycled.unwrap_or_else(|| Film::with_replicates(region, replicates));
        Self {
            job,
            generation,
            camera,
            film,
            film_is_clear,
            summary: FilmSummary::default(),
            backdrop: None,
            seconds: 0.0,
            cpu_seconds: 0.0,
            counts: PathCounts::default(),
            schedule: Schedule::default(),
            last_pass: None,
            pass_seconds: 0.0,
            first_hit_is_done: false,
        }
    }

    /// The film, for the next picture.
    pub(super) fn into_film(self) -> Film {
        self.film
    }

    /// Takes another view, stop rule or number of threads; the film stays.
    pub(super) fn go_on_with(&mut self, job: RenderJob) {
        self.first_hit_is_done &= job.settings.view == self.job.settings.view;
        self.job = job;
    }

    /// Work done so far.
    pub(super) fn counts(&self) -> &PathCounts {
        &self.counts
    }

    fn size(&self) -> [u32; 2] {
        [self.job.settings.width, self.job.settings.height]
    }

    fn caption(&self) -> Caption<'_> {
        Caption {
            job: &self.job,
            generation: self.generation,
            seconds: self.seconds,
            cpu_seconds: self.cpu_seconds,
        }
    }

    /// The coarse first look, and the paths per second that it measured. Not cancellable: a first
    /// look that every new camera cancels is never seen.
    pub(super) fn preview(
        &mut self,
        workers: &Workers,
        scene: &PreparedScene,
        rate: f64,
    ) -> (Snapshot, f64) {
        let size = self.size();
        let step = preview_step(f64::from(size[0]) * f64::from(size[1]), rate);
        let started = Instant::now();
        let view = self.job.settings.view;
        let preview = if view.is_first_hit() {
            Preview::render_first_hit(workers, scene, &self.camera, view, (size, step))
        } else {
            self.coarse(workers, scene, step, &|| false)
                .expect("nothing asks it to stop")
        };
        let measured = preview.pixels.len() as f64 / started.elapsed().as_secs_f64().max(1e-6);
        (self.show(preview), measured)
    }

    /// A finer look, where the first full pass takes so long that it is worth it; `None` when it is
    /// not, or when `stop` said so.
    pub(super) fn finer_preview(
        &mut self,
        workers: &Workers,
        scene: &PreparedScene,
        rate: f64,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Option<Snapshot> {
        let size = self.size();
        let shown = self.backdrop.as_ref().filter(|_| !self.has_samples())?.step;
        let step = finer_step(f64::from(size[0]) * f64::from(size[1]), rate, shown)?;
        let preview = self.coarse(workers, scene, step, stop)?;
        Some(self.show(preview))
    }

    fn coarse(
        &self,
        workers: &Workers,
        scene: &PreparedScene,
        step: u32,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Option<Preview> {
        let settings = PathSettings {
            light_samples: 1,
            reuse: 1,
            ..PathSettings::from(&self.job.settings)
        };
        Preview::render(
            workers,
            &PathTracer::new(scene, &self.camera, settings),
            (self.size(), step),
            stop,
        )
    }

    fn show(&mut self, preview: Preview) -> Snapshot {
        let size = (preview.width, preview.height);
        let snapshot = self.caption().plain(size, preview.pixels.clone(), true);
        if !self.job.settings.view.is_first_hit() {
            self.backdrop = Some(preview);
        }
        snapshot
    }

    /// True when this picture differs from one of `job` by its region only, so that what is shown
    /// of it is right outside of the new region.
    pub(super) fn differs_by_region(&self, job: &RenderJob) -> bool {
        let mut whole = job.clone();
        whole.settings.region = self.job.settings.region;
        whole == self.job && *job != self.job && !job.settings.view.is_first_hit()
    }

    /// Shows `snapshot` wherever there is no sample yet.
    pub(super) fn keep(&mut self, snapshot: &Snapshot) {
        self.backdrop = Some(Preview::of_picture(
            snapshot.width,
            snapshot.height,
            snapshot.pixels.clone(),
        ));
    }

    /// Why nothing more is to be done, if so.
    pub(super) fn stop_reason(&self) -> Option<StopReason> {
        let settings = &self.job.settings;
        if settings.view.is_first_hit() {
            return self.first_hit_is_done.then_some(StopReason::FirstHit);
        }
        if self.schedule.all_closed() {
            return Some(StopReason::Converged);
        }
        let stop = &settings.stop;
        if self.schedule.has_all_samples(settings) {
            return Some(StopReason::Samples);
        }
        if stop.seconds.is_some_and(|limit| self.seconds >= limit) {
            return Some(StopReason::Seconds);
        }
        let is_precise = |aim| {
            self.summary
                .relative_error
                .is_some_and(|error| error <= aim)
        };
        // Two samples can agree by chance; the estimate means something from a few more on.
        (self.schedule.done() >= 8 && stop.relative_error.is_some_and(is_precise))
            .then_some(StopReason::Error)
    }

    /// Takes samples until the end of the pass or until `stop`.
    pub(super) fn advance(&mut self, workers: &Workers, scene: &PreparedScene, stop: Stop<'_>) {
        let started = Instant::now();
        self.film_is_clear =
            self.film_is_clear || clear_pass(workers, &mut self.film, stop.at_once);
        if !self.film_is_clear {
            return;
        }
        let settings = &self.job.settings;
        let tracer = PathTracer::new(scene, &self.camera, PathSettings::from(settings));
        let left = settings.stop.seconds.map(|limit| limit - self.seconds);
        let done = self.schedule.done();
        let bound = self.schedule.bound(settings);
        let target = next_target((done, bound), self.last_pass, left);
        // The last pass was made to fit; one that takes much longer than foreseen is cut.
        let limit = left.map(|left| left + GRACE * settings.stop.seconds.unwrap_or(0.0) + GRACE);
        let is_due = || {
            (stop.when_due)() || limit.is_some_and(|limit| started.elapsed().as_secs_f64() >= limit)
        };
        let busy = workers.cpu_seconds();
        let (counts, is_complete) = render_pass(
            workers,
            &tracer,
            settings.integrator,
            &mut self.film,
            target,
            Stop {
                when_due: &is_due,
                ..stop
            },
        );
        self.counts += counts;
        self.cpu_seconds += workers.cpu_seconds() - busy;
        let elapsed = started.elapsed().as_secs_f64();
        self.seconds += elapsed;
        self.pass_seconds += elapsed;
        if is_complete {
            self.summary = summary_pass(workers, &self.film);
            self.last_pass = Some((target - done, std::mem::take(&mut self.pass_seconds)));
            let film = (&mut self.film, tracer.cluster_size());
            self.schedule.arrive(target, film, settings);
        }
    }

    /// The whole view of the first hit, unless `stop` cut it short.
    pub(super) fn first_hit(
        &mut self,
        workers: &Workers,
        scene: &PreparedScene,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Option<Snapshot> {
        let size = self.size();
        let pixels = first_hit_pass(
            workers,
            scene,
            &self.camera,
            (self.job.settings.view, size),
            stop,
        )?;
        self.first_hit_is_done = true;
        Some(
            self.caption()
                .plain((size[0] as usize, size[1] as usize), pixels, false),
        )
    }

    /// True when there is something of this picture to show.
    pub(super) fn has_samples(&self) -> bool {
        self.film_is_clear && self.counts.camera_rays > 0
    }

    /// The picture so far.
    pub(super) fn snapshot(&mut self, workers: &Workers) -> Snapshot {
        self.summary = summary_pass(workers, &self.film);
        self.caption()
            .film(workers, &self.film, &self.summary, self.backdrop.as_ref())
    }

    /// Writes what is known about this picture.
    pub(super) fn describe(&self, status: &mut SessionStatus) {
        status.samples_mean = self.summary.samples as f64 / self.summary.pixels.max(1) as f64;
        status.samples_target = self.job.settings.stop.samples_per_pixel;
        status.seconds = self.seconds;
        status.cpu_seconds = self.cpu_seconds;
        status.relative_error = self.summary.relative_error;
        status.counts = self.counts;
        status.samples_per_second = self.summary.samples as f64 / self.seconds.max(1e-9);
        let progress = Progress {
            seconds: self.seconds,
            samples_mean: status.samples_mean,
            relative_error: self.summary.relative_error,
        };
        status.eta_seconds = eta_seconds(&self.job.settings, &progress);
    }
}
