//! Test F8: the film does not depend on threads, pauses or passes; jobs replace each other cleanly.

#[path = "session/adaptive.rs"]
mod adaptive;
#[path = "session/noise.rs"]
mod noise;
#[path = "session/refinement.rs"]
mod refinement;

use std::sync::Arc;
use std::time::{Duration, Instant};

use softbox::camera::Camera;
use softbox::scene::{Scene, cornell_box, initial_camera};
use softbox::session::{
    RenderJob, RenderSession, SampleCounts, SessionOptions, SessionState, Snapshot, StopReason,
};
use softbox::settings::{
    Adaptive, AdaptiveGoal, CameraRule, IntegratorKind, Mode, RenderSettings, StopRule, View,
};

const PATIENCE: Duration = Duration::from_secs(60);

fn scene() -> Arc<Scene> {
    let mut builder = cornell_box("box");
    let grey = builder.diffuse("grey", softbox::color::Rgb::splat(0.8));
    builder.sphere("ball", glam::DVec3::new(0.3, 0.4, 0.2), 0.4, grey);
    Arc::new(builder.finish())
}

fn job(scene: &Arc<Scene>, samples: u32) -> RenderJob {
    RenderJob {
        scene: Arc::clone(scene),
        camera: initial_camera(scene, CameraRule::File, false),
        settings: RenderSettings {
            width: 70,
            height: 50,
            stop: StopRule {
                samples_per_pixel: Some(samples),
                ..StopRule::default()
            },
            ..RenderSettings::default()
        },
    }
}

fn wait_until(what: &str, done: impl Fn() -> bool) {
    let started = Instant::now();
    while !done() {
        assert!(started.elapsed() < PATIENCE, "{what} did not happen");
        std::thread::sleep(Duration::from_millis(1));
    }
}

fn finish(session: &RenderSession) -> Arc<Snapshot> {
    wait_until("the end of the render", || session.status().is_finished());
    session.snapshot().expect("a finished render has a picture")
}

fn render(job: RenderJob, interactive: bool) -> Arc<Snapshot> {
    let session = RenderSession::new(SessionOptions { interactive }, || ());
    session.request(job);
    finish(&session)
}

fn bits(snapshot: &Snapshot) -> Vec<[u32; 3]> {
    snapshot
        .pixels
        .iter()
        .map(|p| p.to_array().map(f32::to_bits))
        .collect()
}

#[test]
fn thread_count_changes_no_bit() {
    let scene = scene();
    let reference = render(job(&scene, 12), false);
    assert!(reference.pixels.iter().any(|p| p.max_element() > 0.0));
    for threads in [1, 2, 3, 8] {
        let mut job = job(&scene, 12);
        job.settings.threads = threads;
        assert_eq!(
            bits(&render(job, false)),
            bits(&reference),
            "{threads} threads"
        );
    }
}

#[test]
fn window_and_headless_agree() {
    let scene = scene();
    assert_eq!(
        bits(&render(job(&scene, 9), true)),
        bits(&render(job(&scene, 9), false))
    );
}

#[test]
fn reference_and_wavefront_agree_in_every_mode() {
    let scene = scene();
    for mode in Mode::ALL {
        let mut job = job(&scene, 3);
        job.settings.mode = mode;
        job.settings.light_samples = 2;
        let wavefront = render(job.clone(), false);
        job.settings.integrator = IntegratorKind::Reference;
        assert_eq!(bits(&render(job, false)), bits(&wavefront), "{mode:?}");
    }
}

#[test]
fn pauses_and_split_passes_change_no_bit() {
    let scene = scene();
    let whole = render(job(&scene, 64), true);
    let session = RenderSession::new(SessionOptions { interactive: true }, || ());
    for target in [1, 3, 20, 64] {
        session.request(job(&scene, target));
        session.pause();
        wait_until("a pause", || {
            matches!(
                session.status().state,
                SessionState::Paused | SessionState::Finished(_)
            )
        });
        session.resume();
        let reached = |s: Arc<Snapshot>| !s.is_preview && s.samples_mean >= f64::from(target);
        wait_until("the next samples", || {
            session.snapshot().is_some_and(reached)
        });
    }
    assert_eq!(bits(&finish(&session)), bits(&whole));
}

#[test]
fn the_latest_job_wins_and_no_stale_picture_follows() {
    let scene = scene();
    let session = RenderSession::new(SessionOptions { interactive: true }, || ());
    let mut last = job(&scene, 4);
    for i in 0..200 {
        last.camera = Camera {
            eye: last.camera.eye + glam::DVec3::X * 0.001,
            ..last.camera
        };
        session.request(last.clone());
        if i % 10 == 0 {
            std::thread::sleep(Duration::from_millis(1));
        }
    }
    wait_until("the last picture", || {
        session.status().is_finished()
            && session
                .snapshot()
                .is_some_and(|s| s.camera == last.camera && !s.is_preview)
    });
    let shown = session.snapshot().expect("a picture");
    assert_eq!(bits(&shown), bits(&render(last.clone(), false)));
    let generation = shown.generation;
    session.request(last);
    std::thread::sleep(Duration::from_millis(30));
    assert_eq!(
        session.snapshot().map(|s| s.generation),
        Some(generation),
        "an equal job does nothing"
    );
}

#[test]
fn a_change_of_view_keeps_the_film() {
    let scene = scene();
    let session = RenderSession::new(SessionOptions { interactive: true }, || ());
    let render_job = job(&scene, 16);
    session.request(render_job.clone());
    let first = finish(&session);
    let mut normals = render_job.clone();
    normals.settings.view = View::Normals;
    session.request(normals);
    wait_until("the normals", || {
        session.status().state == SessionState::Finished(StopReason::FirstHit)
            && session
                .snapshot()
                .is_some_and(|s| s.view == View::Normals && !s.is_preview)
    });
    let rays = session.status().counts.camera_rays;
    session.request(render_job);
    wait_until("the render again", || {
        session
            .snapshot()
            .is_some_and(|s| s.view == View::Render && !s.is_preview)
    });
    let again = finish(&session);
    assert_eq!(bits(&again), bits(&first));
    assert_eq!(
        session.status().counts.camera_rays,
        rays,
        "no sample was taken twice"
    );
}

#[test]
fn a_region_renders_the_same_pixels_and_nothing_else() {
    let scene = scene();
    let whole = render(job(&scene, 5), false);
    let mut part = job(&scene, 5);
    let region = softbox::image::Region {
        x: 11,
        y: 7,
        width: 40,
        height: 35,
    };
    part.settings.region = Some(region);
    let part = render(part, false);
    for y in 0..50 {
        for x in 0..70 {
            let i = (y * 70 + x) as usize;
            let expected = if region.contains(x, y) {
                whole.pixels[i]
            } else {
                glam::Vec3::ZERO
            };
            assert_eq!(part.pixels[i], expected);
        }
    }
    let SampleCounts::PerPixel(counts) = &part.samples else {
        panic!("counts differ by pixel")
    };
    assert_eq!(counts.iter().filter(|&&n| n == 5).count(), 40 * 35);
}

fn adaptive_job(scene: &Arc<Scene>, goal: AdaptiveGoal, threads: usize) -> RenderJob {
    let mut job = job(scene, 512);
    job.settings.adaptive = Some(Adaptive {
        batch: 32,
        tolerance: 0.1,
        goal,
        exposure: 0.0,
    });
    job.settings.threads = threads;
    job
}

#[test]
fn adaptive_sampling_does_not_depend_on_threads_passes_and_pauses() {
    let scene = scene();
    let small = |goal, threads| {
        let mut job = adaptive_job(&scene, goal, threads);
        (job.settings.width, job.settings.height) = (37, 29);
        job
    };
    for goal in AdaptiveGoal::ALL {
        let one = render(small(goal, 1), false);
        let three = render(small(goal, 3), true);
        assert_eq!(bits(&one), bits(&three), "{goal:?}");
        assert_eq!(one.samples, three.samples, "{goal:?}");
        let session = RenderSession::new(SessionOptions { interactive: true }, || ());
        session.request(small(goal, 2));
        for _ in 0..20 {
            session.pause();
            wait_until("a pause", || session.status().is_held());
            session.resume();
            std::thread::sleep(Duration::from_millis(5));
        }
        let paused = finish(&session);
        assert_eq!(bits(&one), bits(&paused), "{goal:?}");
    }
}

#[test]
fn even_quality_ends_early_where_it_can_and_least_error_spends_its_budget() {
    let scene = scene();
    let even = render(adaptive_job(&scene, AdaptiveGoal::Even, 2), false);
    assert!(
        even.samples_mean < 500.0 && even.samples_mean >= 64.0,
        "{}",
        even.samples_mean
    );
    let least = render(adaptive_job(&scene, AdaptiveGoal::LeastError, 2), false);
    assert!(
        (500.0..=512.0).contains(&least.samples_mean) && least.samples_max > 600,
        "{} {}",
        least.samples_mean,
        least.samples_max
    );
}

#[test]
fn stop_by_error_and_by_time() {
    let scene = scene();
    let mut by_error = job(&scene, 100_000);
    by_error.settings.stop = StopRule {
        relative_error: Some(0.2),
        ..StopRule::default()
    };
    let session = RenderSession::new(SessionOptions::default(), || ());
    session.request(by_error);
    let picture = finish(&session);
    assert_eq!(
        session.status().state,
        SessionState::Finished(StopReason::Error)
    );
    assert!(picture.relative_error.is_some_and(|e| e <= 0.2));
    let mut by_time = job(&scene, 1);
    by_time.settings.stop = StopRule {
        seconds: Some(0.05),
        ..StopRule::default()
    };
    session.request(by_time);
    wait_until("the time limit", || {
        session.status().state == SessionState::Finished(StopReason::Seconds)
    });
}

#[test]
fn a_fault_in_one_picture_is_told_and_the_next_one_renders() {
    let mut broken = (*scene()).clone();
    broken.instances[0].geometry = 1_000_000;
    let broken = Arc::new(broken);
    let session = RenderSession::new(SessionOptions { interactive: true }, || ());
    let mut bad_job = job(&scene(), 2);
    bad_job.scene = broken;
    session.request(bad_job.clone());
    wait_until("a message", || session.status().message.is_some());
    session.request(bad_job);
    assert_eq!(session.status().state, SessionState::Idle);
    session.request(job(&scene(), 2));
    let picture = finish(&session);
    assert!(picture.pixels.iter().any(|p| p.max_element() > 0.0));
    assert_eq!(session.status().message, None);
}

#[test]
fn a_new_region_keeps_the_picture_around_it() {
    let scene = scene();
    let session = RenderSession::new(SessionOptions { interactive: true }, || ());
    session.request(job(&scene, 12));
    let whole = finish(&session);
    let mut part = job(&scene, 12);
    let region = softbox::image::Region {
        x: 20,
        y: 10,
        width: 16,
        height: 16,
    };
    part.settings.region = Some(region);
    session.request(part.clone());
    wait_until("the region", || {
        session.status().is_finished()
            && session
                .snapshot()
                .is_some_and(|s| s.settings == part.settings)
    });
    // Outside the old picture stays; inside the same samples are taken again.
    assert_eq!(bits(&finish(&session)), bits(&whole));
}

#[test]
fn another_camera_does_not_make_a_build_begin_again() {
    let scene = Arc::new(softbox::scene::procedural("knot-70k").expect("built in"));
    let session = RenderSession::new(SessionOptions { interactive: true }, || ());
    let mut moving = job(&scene, 1);
    let mut moves = 0;
    let started = Instant::now();
    while session.prepared().is_none() {
        assert!(started.elapsed() < PATIENCE, "the build never ends");
        moving.camera.eye.x += 0.001;
        session.request(moving.clone());
        moves += 1;
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(moves > 1, "there was time to move");
}
