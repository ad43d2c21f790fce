use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use super::picture::Picture;
use super::refiner::Refiner;
use super::{Shared, lock};
use crate::scene::{PrepareCache, PrepareSettings, PreparedScene, prepare_with};
use crate::session::change::Change;
use crate::session::pass::Stop;
use crate::session::workers::{Workers, lower_priority};
use crate::session::{RenderJob, SessionState};

/// Shortest time between two snapshots of a picture being refined, in a window and headless.
const PUBLISH_EVERY: [Duration; 2] = [Duration::from_millis(1000), Duration::from_millis(33)];
/// Snapshots may cost one part in this many of the time.
const PUBLISH_SHARE: u32 = 12;
/// What the user is told after a panic.
const FAULT: &str = "A fault inside softbox ended this picture; please report it with the scene. Change a setting or open another scene to go on.";
/// Paths per second assumed before anything was measured.
const FIRST_RATE: f64 = 200_000.0;

/// What the session's thread remembers from one turn of its loop to the next.
pub(super) struct Turn<'a> {
    shared: &'a Shared,
    workers: Workers,
    scene: Option<Arc<PreparedScene>>,
    /// What the next scene may take over from this one.
    cache: PrepareCache,
    refiner: Refiner,
    picture: Option<Picture>,
    generation: u64,
    /// Paths per second, measured.
    rate: f64,
    published: Instant,
    publish_cost: Duration,
    /// The picture has samples that no snapshot shows.
    has_news: bool,
    /// The job that ended in a panic; it is not tried again.
    failed: Option<RenderJob>,
}

impl<'a> Turn<'a> {
    pub(super) fn new(shared: &'a Shared) -> Self {
        if shared.options.interactive {
            lower_priority();
        }
        Self {
            shared,
            workers: Workers::new(1, shared.options.interactive),
            scene: None,
            cache: PrepareCache::default(),
            refiner: Refiner::default(),
            picture: None,
            generation: 0,
            rate: FIRST_RATE,
            published: Instant::now(),
            publish_cost: Duration::ZERO,
            has_news: false,
            failed: None,
        }
    }

    /// One look at the wishes and one step of work; false when the session ends.
    pub(super) fn take(&mut self) -> bool {
        let seen = self.shared.interrupts.load(Ordering::Relaxed);
        let (job, restart) = {
            let mut wish = lock(&self.shared.wish);
            if wish.quit {
                return false;
            }
            (wish.job.clone(), std::mem::take(&mut wish.restart))
        };
        let job = job.filter(|job| restart || self.failed.as_ref() != Some(job));
        let Some(job) = job else {
            return self.wait(seen);
        };
        self.failed = None;
        if self.accept(job, restart, seen).is_break() {
            return true;
        }
        self.take_better_tree();
        let stop_reason = self.picture.as_ref().and_then(Picture::stop_reason);
        if let Some(reason) = stop_reason {
            self.refiner.hold();
            self.publish_news();
            self.shared.set_state(SessionState::Finished(reason));
            return self.wait(seen);
        }
        if self.shared.is_paused() {
            self.refiner.hold();
            self.publish_news();
            self.shared.set_state(SessionState::Paused);
            return self.wait(seen);
        }
        self.work(seen);
        true
    }

    /// After a panic: forgets everything about the picture and waits for another job.
    pub(super) fn recover(&mut self) {
        self.picture = None;
        self.scene = None;
        self.cache = PrepareCache::default();
        self.refiner.reset(self.shared);
        self.has_news = false;
        self.workers = self.workers.resized(self.workers.threads());
        self.shared.update_status(|status| {
            status.state = SessionState::Idle;
            status.message = Some(FAULT.to_owned());
        });
        // The same job would fail again.
        let mut wish = lock(&self.shared.wish);
        self.failed = wish.job.clone();
        wish.restart = false;
    }

    /// Sleeps until somebody wants something; true.
    fn wait(&self, seen: u64) -> bool {
        let mut wish = lock(&self.shared.wish);
        while self.shared.interrupts.load(Ordering::Relaxed) == seen {
            wish = self
                .shared
                .changed
                .wait(wish)
                .unwrap_or_else(std::sync::PoisonError::into_inner);
        }
        true
    }

    /// Makes `job` the current picture, keeping what can be kept; breaks when interrupted.
    fn accept(&mut self, job: RenderJob, restart: bool, seen: u64) -> ControlFlow<()> {
        let change = match &self.picture {
            None => Change::Scene,
            Some(picture) => match Change::between(&picture.job, &job) {
                Change::None | Change::Continue if restart => Change::Film,
                change => change,
            },
        };
        if change == Change::None {
            return ControlFlow::Continue(());
        }
        let threads = job.settings.thread_count();
        if self.workers.threads() != threads {
            self.workers = self.workers.resized(threads);
        }
        if change == Change::Scene {
            self.prepare(&job, seen)?;
        }
        match &mut self.picture {
            Some(picture) if change == Change::Continue => {
                picture.go_on_with(job);
                self.has_news = picture.has_samples();
                self.published -= PUBLISH_EVERY[0];
                if picture.job.settings.view.is_first_hit() && picture.stop_reason().is_none() {
                    self.show_preview();
                }
            }
            _ => self.start(job),
        }
        ControlFlow::Continue(())
    }

    /// A new film, and its coarse first look.
    fn start(&mut self, job: RenderJob) {
        let Some(scene) = &self.scene else { return };
        self.generation += 1;
        let kept = self
            .picture
            .as_ref()
            .filter(|picture| picture.differs_by_region(&job));
        let kept = kept
            .and_then(|_| self.shared.snapshot())
            .filter(|snapshot| !snapshot.is_preview);
        let recycled = self.picture.take().map(Picture::into_film);
        let mut picture = Picture::new(job, self.generation, scene, recycled);
        if let Some(snapshot) = &kept {
            picture.keep(snapshot);
        }
        self.picture = Some(picture);
        self.has_news = false;
        self.shared.update_status(|status| {
            status.eta_seconds = None;
            status.relative_error = None;
        });
        if self.shared.options.interactive && kept.is_none() {
            self.show_preview();
        }
    }

    fn show_preview(&mut self) {
        let (Some(scene), Some(picture)) = (&self.scene, &mut self.picture) else {
            return;
        };
        let (snapshot, measured) = picture.preview(&self.workers, scene, self.rate);
        // Previews differ in what they see; half of the old figure stays.
        self.rate = 0.5 * (self.rate + measured);
        self.shared.publish(snapshot);
        self.published = Instant::now();
    }

    fn prepare(&mut self, job: &RenderJob, seen: u64) -> ControlFlow<()> {
        let shared = self.shared;
        self.refiner.cancel(shared);
        // Another camera or size meanwhile does not make the work useless.
        let is_wanted = || {
            let wish = lock(&shared.wish);
            let wanted = wish.job.as_ref();
            !wish.quit && wanted.is_some_and(|wanted| Change::between(job, wanted) < Change::Scene)
        };
        let progress = |stage, fraction| {
            shared.set_state(SessionState::Preparing { stage, fraction });
            if shared.interrupts.load(Ordering::Relaxed) == seen || is_wanted() {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        };
        let settings = PrepareSettings {
            bvh: job.settings.bvh,
            course_compatible: job.settings.course_compatible,
            isa: job.settings.isa,
            ..PrepareSettings::default()
        };
        let started = Instant::now();
        let cache = &mut self.cache;
        let prepared = self
            .workers
            .install(|| prepare_with(&job.scene, &settings, cache, &progress));
        let Some(prepared) = prepared else {
            return ControlFlow::Break(());
        };
        let prepared = Arc::new(prepared);
        *lock(&shared.prepared) = Some(Arc::clone(&prepared));
        self.scene = Some(prepared);
        self.refiner.reset(shared);
        self.rate = FIRST_RATE;
        shared.update_status(|status| {
            status.build_seconds = started.elapsed().as_secs_f64();
            status.message = None;
        });
        ControlFlow::Continue(())
    }

    /// Swaps in the refined hierarchy when it is ready; the film goes on, for every ray has the
    /// same hits.
    fn take_better_tree(&mut self) {
        if let Some(scene) = self.refiner.take(self.shared) {
            self.cache.adopt(&scene);
            let scene = Arc::new(scene);
            *lock(&self.shared.prepared) = Some(Arc::clone(&scene));
            self.scene = Some(scene);
        }
    }

    /// Some milliseconds to a fraction of a second of rendering.
    fn work(&mut self, seen: u64) {
        let (Some(scene), Some(picture)) = (&self.scene, &mut self.picture) else {
            return;
        };
        let shared = self.shared;
        shared.set_state(SessionState::Rendering);
        let is_interrupted = || shared.interrupts.load(Ordering::Relaxed) != seen;
        if picture.job.settings.view.is_first_hit() {
            if let Some(snapshot) = picture.first_hit(&self.workers, scene, &is_interrupted) {
                shared.publish(snapshot);
                self.has_news = false;
            }
            return;
        }
        if shared.options.interactive {
            let finer = picture.finer_preview(&self.workers, scene, self.rate, &is_interrupted);
            if let Some(snapshot) = finer {
                shared.publish(snapshot);
                self.published = Instant::now();
                return;
            }
            if is_interrupted() {
                return;
            }
        }
        self.refiner.tend(shared, scene, picture);
        let every = PUBLISH_EVERY[usize::from(shared.options.interactive)]
            .max(self.publish_cost * PUBLISH_SHARE);
        let due = self.published + every;
        // Long passes are cut where the next snapshot is due; the film stays whole.
        let stop = Stop {
            at_once: &is_interrupted,
            when_due: &|| self.refiner.has_news() || Instant::now() >= due,
        };
        picture.advance(&self.workers, scene, stop);
        shared.update_status(|status| picture.describe(status));
        self.has_news = picture.has_samples();
        if Instant::now() >= due && !is_interrupted() {
            self.publish_news();
        }
    }

    fn publish_news(&mut self) {
        let Some(picture) = self.picture.as_mut().filter(|_| self.has_news) else {
            return;
        };
        if picture.job.settings.view.is_first_hit() {
            return;
        }
        let started = Instant::now();
        let snapshot = picture.snapshot(&self.workers);
        self.shared.update_status(|status| picture.describe(status));
        self.shared.publish(snapshot);
        self.published = Instant::now();
        self.publish_cost = self.published - started;
        self.has_news = false;
    }
}
