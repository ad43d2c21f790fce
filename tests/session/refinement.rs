//! The hierarchy gets better while the picture renders, and the picture does not change.

use softbox::bvh::{BvhKind, BvhQuality};
use softbox::session::{TreeState, Workbench};

use super::*;

/// Enough for a render never to end by itself in a test.
const ENDLESS: u32 = 10_000_000;

/// A bumpy floor of 2 · 95² triangles in a box, enough to be worth refining.
fn bumpy_scene() -> Arc<Scene> {
    const N: u32 = 95;
    let mut builder = cornell_box("bumpy box");
    let grey = builder.diffuse("grey", softbox::color::Rgb::splat(0.7));
    let positions = (0..=N)
        .flat_map(|z| (0..=N).map(move |x| (x, z)))
        .map(|(x, z)| {
            let height = 0.1 + 0.03 * f64::from(x * z % 7);
            let across = |i: u32| 1.8 * f64::from(i) / f64::from(N) - 0.9;
            glam::DVec3::new(across(x), height, across(z))
        })
        .collect();
    let triangles: Vec<[u32; 3]> = (0..N)
        .flat_map(|z| (0..N).map(move |x| z * (N + 1) + x))
        .flat_map(|a| [[a, a + N + 1, a + 1], [a + 1, a + N + 1, a + N + 2]])
        .collect();
    builder.mesh("floor of bumps", positions, &triangles, grey);
    Arc::new(builder.finish())
}

fn small_job(scene: &Arc<Scene>, samples: u32, quality: BvhQuality) -> RenderJob {
    let mut job = job(scene, samples);
    (job.settings.width, job.settings.height) = (32, 24);
    job.settings.bvh.quality = quality;
    job
}

fn wait_for_refinement(session: &RenderSession) {
    wait_until("the better tree", || is_refined(session));
}

fn is_refined(session: &RenderSession) -> bool {
    matches!(session.status().tree, TreeState::Refined { .. })
}

/// Ends an endless render at a whole number of samples; gives its picture and that number.
fn end(session: &RenderSession, endless: &RenderJob) -> (Arc<Snapshot>, u32) {
    session.pause();
    wait_until("a pause", || session.status().state == SessionState::Paused);
    let shown = session.snapshot().expect("a picture");
    let samples = shown.samples_max + 8;
    let mut ending = endless.clone();
    ending.settings.stop.samples_per_pixel = Some(samples);
    session.request(ending);
    session.resume();
    let picture = finish(session);
    assert_eq!(picture.generation, shown.generation, "the film goes on");
    (picture, samples)
}

#[test]
fn quality_changes_no_bit() {
    let scene = bumpy_scene();
    let picture = |quality, interactive| {
        let job = small_job(&scene, 9, quality);
        bits(&render(job, interactive))
    };
    let standard = picture(BvhQuality::Standard, false);
    for quality in [BvhQuality::Fast, BvhQuality::High] {
        for interactive in [false, true] {
            assert!(
                picture(quality, interactive) == standard,
                "{quality:?}, interactive: {interactive}"
            );
        }
    }
}

#[test]
fn a_tree_that_is_swapped_in_the_middle_changes_no_bit() {
    let scene = bumpy_scene();
    for interactive in [true, false] {
        let session = RenderSession::new(SessionOptions { interactive }, || ());
        session.request(small_job(&scene, ENDLESS, BvhQuality::Standard));
        wait_until("samples", || session.status().samples_mean >= 1.0);
        assert_eq!(session.status().tree, TreeState::AsBuilt);
        let first = session.prepared().expect("it renders");
        let high = small_job(&scene, ENDLESS, BvhQuality::High);
        session.request(high.clone());
        wait_for_refinement(&session);
        let (picture, samples) = end(&session, &high);
        let refined = session.prepared().expect("it rendered");
        assert!(!Arc::ptr_eq(&first, &refined));
        assert!(std::ptr::eq(first.shapes(), refined.shapes()), "shared");
        let standard = render(small_job(&scene, samples, BvhQuality::Standard), false);
        assert!(
            bits(&picture) == bits(&standard),
            "interactive: {interactive}"
        );
    }
}

#[test]
fn without_a_window_only_what_pays_is_refined() {
    let tree_of = |scene: &Arc<Scene>, samples| {
        let session = RenderSession::new(SessionOptions::default(), || ());
        session.request(small_job(scene, samples, BvhQuality::High));
        finish(&session);
        session.status().tree
    };
    assert_eq!(tree_of(&bumpy_scene(), 4), TreeState::AsBuilt);
    assert_eq!(tree_of(&scene(), 400), TreeState::AsBuilt);
    let session = RenderSession::new(SessionOptions::default(), || ());
    session.request(small_job(&bumpy_scene(), ENDLESS, BvhQuality::High));
    wait_for_refinement(&session);
}

#[test]
fn only_pictures_of_many_rays_through_good_trees_are_refined() {
    let scene = bumpy_scene();
    let edits: [fn(&mut RenderSettings); 3] = [
        |settings| settings.view = View::Cost,
        |settings| settings.bvh.kind = BvhKind::Median,
        |settings| settings.bvh.quality = BvhQuality::Fast,
    ];
    for (number, edit) in edits.into_iter().enumerate() {
        let mut job = small_job(&scene, 32, BvhQuality::High);
        edit(&mut job.settings);
        let session = RenderSession::new(SessionOptions { interactive: true }, || ());
        session.request(job);
        finish(&session);
        assert_eq!(session.status().tree, TreeState::AsBuilt, "edit {number}");
    }
}

#[test]
fn pauses_moves_and_ends_do_not_lose_a_refinement() {
    let scene = Arc::new(softbox::scene::procedural("knot-70k").expect("built in"));
    let session = RenderSession::new(SessionOptions { interactive: true }, || ());
    let mut moving = small_job(&scene, ENDLESS, BvhQuality::High);
    session.request(moving.clone());
    wait_until("the work on the tree", || {
        session.status().tree != TreeState::AsBuilt
    });
    session.pause();
    wait_until("a pause", || session.status().state == SessionState::Paused);
    assert_ne!(session.status().tree, TreeState::AsBuilt);
    session.resume();
    moving.camera.eye.x += 0.01;
    moving.settings.stop.samples_per_pixel = Some(1);
    session.request(moving.clone());
    wait_until("the end", || {
        let is_new = |s: Arc<Snapshot>| s.camera == moving.camera && !s.is_preview;
        session.status().is_finished() && session.snapshot().is_some_and(is_new)
    });
    assert_ne!(session.status().tree, TreeState::AsBuilt);
    moving.settings.stop.samples_per_pixel = Some(ENDLESS);
    session.request(moving);
    wait_for_refinement(&session);
    // It is not refined again.
    session.restart();
    wait_until("samples", || session.status().samples_mean >= 1.0);
    assert!(is_refined(&session));
}

#[test]
fn another_scene_ends_a_refinement() {
    let large = Arc::new(softbox::scene::procedural("knot-70k").expect("built in"));
    let session = RenderSession::new(SessionOptions { interactive: true }, || ());
    session.request(small_job(&large, ENDLESS, BvhQuality::High));
    wait_until("the work on the tree", || {
        session.status().tree != TreeState::AsBuilt
    });
    let small = scene();
    let last = small_job(&small, 40, BvhQuality::Standard);
    session.request(last.clone());
    wait_until("the end", || session.status().is_finished());
    assert_eq!(session.status().tree, TreeState::AsBuilt);
    let primitives = session.prepared().expect("it rendered").shapes().len();
    assert!(primitives < 100, "the small scene stays: {primitives}");
    assert!(bits(&finish(&session)) == bits(&render(last, false)));
}

#[test]
fn a_workbench_refines_once_and_changes_no_bit() {
    let scene = bumpy_scene();
    for (quality, refines) in [(BvhQuality::Standard, false), (BvhQuality::High, true)] {
        let mut bench = Workbench::new(&small_job(&scene, 2, quality));
        let picture = |bench: &Workbench| {
            let mut exposure = bench.begin(Mode::Best, 3);
            assert!(bench.advance(&mut exposure, 2, &|| false));
            let counts = exposure.counts();
            (exposure.image(), counts.trace.box_tests)
        };
        let (first, boxes) = picture(&bench);
        assert_eq!(bench.refine() > 0.0, refines);
        assert_eq!(bench.refine(), 0.0);
        let (second, others) = picture(&bench);
        assert_eq!(first.pixels(), second.pixels());
        assert_eq!(others != boxes, refines);
    }
}
