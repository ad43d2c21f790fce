use std::ops::ControlFlow;
use std::time::Instant;

use super::RenderJob;
use super::adaptive::Schedule;
use super::pass::{Stop, render_pass};
use super::refinement::is_asked_for;
use super::workers::Workers;
use crate::camera::RayCamera;
use crate::color::Rgb;
use crate::film::Film;
use crate::image::Image;
use crate::integrator::{PathCounts, PathSettings, PathTracer};
use crate::scene::{PrepareSettings, PreparedScene, prepare};
use crate::settings::{Adaptive, Mode, RenderSettings};

/// A scene ready to be rendered over and over by the thread that asks: for measuring, not for
/// windows. The pictures are those of a [`super::RenderSession`], bit for bit.
#[derive(Debug)]
pub struct Workbench {
    workers: Workers,
    scene: PreparedScene,
    camera: RayCamera,
    settings: RenderSettings,
    build_seconds: f64,
}

/// A picture on a [`Workbench`], and what it has cost so far.
#[derive(Debug)]
pub struct Exposure {
    settings: RenderSettings,
    film: Film,
    schedule: Schedule,
    counts: PathCounts,
    cpu_seconds: f64,
    wall_seconds: f64,
}

impl Workbench {
    /// Prepares the scene of `job`, with its first hierarchy ([`Self::refine`]).
    pub fn new(job: &RenderJob) -> Self {
        let settings = job.settings.clone();
        let workers = Workers::new(settings.thread_count(), false);
        let prepare_settings = PrepareSettings {
            bvh: settings.bvh,
            course_compatible: settings.course_compatible,
            isa: settings.isa,
            ..PrepareSettings::default()
        };
        let started = Instant::now();
        let scene = workers
            .install(|| {
                prepare(&job.scene, &prepare_settings, &|_, _| {
                    ControlFlow::Continue(())
                })
            })
            .expect("nothing asks it to stop");
        let build_seconds = started.elapsed().as_secs_f64();
        let (width, height) = (settings.width, settings.height);
        let camera = RayCamera::new(&job.camera, width, height, scene.normalization());
        Self {
            workers,
            scene,
            camera,
            settings,
            build_seconds,
        }
    }

    /// Seconds that the preparation took.
    pub fn build_seconds(&self) -> f64 {
        self.build_seconds
    }

    /// Puts the refined hierarchy in the place of the first, if the settings ask for one that a session
    /// would come to. Returns the seconds that this took.
    pub fn refine(&mut self) -> f64 {
        if !is_asked_for(&self.settings) || self.scene.aggregate().is_refined() {
            return 0.0;
        }
        let started = Instant::now();
        let go_on = |_| ControlFlow::Continue(());
        let refined = self.workers.install(|| self.scene.refined(&go_on));
        self.scene = refined.expect("nothing asks it to stop");
        started.elapsed().as_secs_f64()
    }

    /// An empty picture of the job's settings, but for `mode` and `seed`.
    pub fn begin(&self, mode: Mode, seed: u64) -> Exposure {
        self.begin_as(mode, self.settings.adaptive, seed)
    }

    /// The same with another kind of adaptive sampling, or none.
    pub fn begin_as(&self, mode: Mode, adaptive: Option<Adaptive>, seed: u64) -> Exposure {
        let settings = RenderSettings {
            mode,
            adaptive,
            seed,
            ..self.settings.clone()
        };
        Exposure {
            film: Film::with_replicates(settings.active_region(), settings.replicates()),
            settings,
            schedule: Schedule::default(),
            counts: PathCounts::default(),
            cpu_seconds: 0.0,
            wall_seconds: 0.0,
        }
    }

    /// Takes samples until each pixel of `exposure` has `samples` of them (adaptive sampling may close
    /// some before, or make that the mean; then `samples` are multiples of its batch) or until `stop`,
    /// which is asked before each batch of paths. False when stopped; some pixels may then have more
    /// samples than others.
    pub fn advance(
        &self,
        exposure: &mut Exposure,
        samples: u32,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> bool {
        let tracer = PathTracer::new(
            &self.scene,
            &self.camera,
            PathSettings::from(&exposure.settings),
        );
        let settings = &mut exposure.settings;
        settings.stop.samples_per_pixel = Some(samples);
        let schedule = &mut exposure.schedule;
        while !schedule.all_closed() && !schedule.has_all_samples(settings) {
            let target = schedule.bound(settings);
            let (started, busy) = (Instant::now(), self.workers.cpu_seconds());
            let (counts, is_whole) = render_pass(
                &self.workers,
                &tracer,
                settings.integrator,
                &mut exposure.film,
                target,
                Stop {
                    at_once: stop,
                    when_due: &|| false,
                },
            );
            exposure.cpu_seconds += self.workers.cpu_seconds() - busy;
            exposure.wall_seconds += started.elapsed().as_secs_f64();
            exposure.counts += counts;
            if !is_whole {
                return false;
            }
            let film = (&mut exposure.film, tracer.cluster_size());
            schedule.arrive(target, film, settings);
        }
        true
    }
}

impl Exposure {
    /// Mean radiance of the pixels of the rendered region; black where there is no sample.
    pub fn image(&self) -> Image<Rgb> {
        let region = self.film.region();
        let (width, height) = (region.width as usize, region.height as usize);
        let mut pixels = vec![Rgb::ZERO; width * height];
        for tile in self.film.tiles() {
            for (index, pixel) in tile.pixels().iter().enumerate() {
                let (x, y) = tile.position(index);
                pixels[(y - region.y) as usize * width + (x - region.x) as usize] =
                    pixel.radiance();
            }
        }
        Image::from_pixels(width, height, pixels)
    }

    /// Samples that every pixel has that adaptive sampling does not hold back.
    pub fn samples_per_pixel(&self) -> u32 {
        self.schedule.done()
    }

    /// Root of the relative squared error that the samples themselves tell.
    pub fn relative_error(&self) -> Option<f64> {
        self.film.summary().relative_error
    }

    /// Samples of all pixels together.
    pub fn samples(&self) -> u64 {
        let pixels = self.film.tiles().iter().flat_map(|tile| tile.pixels());
        pixels.map(|pixel| u64::from(pixel.count())).sum()
    }

    /// Work done so far.
    pub fn counts(&self) -> &PathCounts {
        &self.counts
    }

    /// Processor time of the workers so far.
    pub fn cpu_seconds(&self) -> f64 {
        self.cpu_seconds
    }

    /// Time on the wall so far.
    pub fn wall_seconds(&self) -> f64 {
        self.wall_seconds
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU32, Ordering};

    use super::*;
    use crate::camera::Camera;
    use crate::geometry::TraceCounts;
    use crate::scene::{cornell_box, initial_camera};
    use crate::settings::{AdaptiveGoal, CameraRule};

    fn job(settings: RenderSettings) -> RenderJob {
        let scene = cornell_box("box").finish();
        let camera: Camera = initial_camera(&scene, CameraRule::Auto, false);
        RenderJob {
            scene: Arc::new(scene),
            camera,
            settings,
        }
    }

    fn small() -> RenderSettings {
        RenderSettings {
            width: 40,
            height: 36,
            threads: 2,
            ..RenderSettings::default()
        }
    }

    #[test]
    fn steps_make_no_difference_and_costs_add_up() {
        let bench = Workbench::new(&job(small()));
        let mut at_once = bench.begin(Mode::Best, 3);
        assert!(bench.advance(&mut at_once, 8, &|| false));
        let mut in_steps = bench.begin(Mode::Best, 3);
        let mut before = 0.0;
        for samples in [1, 2, 8] {
            assert!(bench.advance(&mut in_steps, samples, &|| false));
            assert!(in_steps.cpu_seconds() > before);
            before = in_steps.cpu_seconds();
            assert_eq!(in_steps.samples_per_pixel(), samples);
        }
        assert_eq!(at_once.image(), in_steps.image());
        assert_eq!(in_steps.counts().camera_rays, 40 * 36 * 8);
        // Which rays are tested together, and so how many boxes are, depends on the steps.
        let without_tests = |counts: &PathCounts| {
            let (box_tests, primitive_tests) = (0, 0);
            let trace = TraceCounts {
                box_tests,
                primitive_tests,
                ..counts.trace
            };
            PathCounts { trace, ..*counts }
        };
        assert_eq!(
            without_tests(at_once.counts()),
            without_tests(in_steps.counts())
        );
        let other = bench.begin(Mode::Best, 4);
        assert_eq!(other.image(), Image::filled(40, 36, Rgb::ZERO));
    }

    #[test]
    fn a_stopped_picture_can_go_on() {
        let bench = Workbench::new(&job(small()));
        let mut whole = bench.begin(Mode::Importance, 1);
        assert!(bench.advance(&mut whole, 4, &|| false));
        let mut cut = bench.begin(Mode::Importance, 1);
        let asked = AtomicU32::new(0);
        let soon = || asked.fetch_add(1, Ordering::Relaxed) > 0;
        assert!(!bench.advance(&mut cut, 4, &soon));
        assert!(cut.samples_per_pixel() < 4);
        assert!(bench.advance(&mut cut, 4, &|| false));
        assert_eq!(cut.image(), whole.image());
    }

    #[test]
    fn adaptive_sampling_decides_after_each_batch() {
        let adaptive = Adaptive {
            batch: 8,
            tolerance: 10.0,
            goal: AdaptiveGoal::Course,
            exposure: 0.0,
        };
        let bench = Workbench::new(&job(RenderSettings {
            adaptive: Some(adaptive),
            ..small()
        }));
        let mut exposure = bench.begin(Mode::Best, 0);
        assert!(bench.advance(&mut exposure, 64, &|| false));
        // Any pixel is within ten times its mean.
        assert_eq!(exposure.counts().camera_rays, 40 * 36 * 8);
    }
}
