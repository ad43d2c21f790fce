use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::{DMat4, DVec3};
use softbox::bvh::BvhSettings;
use softbox::color::Rgb;
use softbox::scene::{
    Instancing, PrepareCache, PrepareCounts, PrepareSettings, PreparedScene, Scene, cornell_box,
    prepare_with,
};
use softbox::session::{RenderJob, RenderSession, SessionOptions};
use softbox::settings::{RenderSettings, StopRule};

use crate::scenes::{ball, place, prepared, samples, view};

const HERE: DVec3 = DVec3::new(0.2, 0.5, 0.1);

/// The Cornell box with two different balls.
fn two_balls() -> Scene {
    let mut builder = cornell_box("two balls");
    let grey = builder.diffuse("grey", Rgb::splat(0.6));
    place(&mut builder, ball(12, false), &[grey], &[at(HERE)]);
    place(
        &mut builder,
        ball(14, false),
        &[grey],
        &[at(-HERE + DVec3::Y)],
    );
    builder.finish()
}

fn at(center: DVec3) -> DMat4 {
    DMat4::from_scale_rotation_translation(
        DVec3::splat(0.2),
        glam::DQuat::from_rotation_x(center.x),
        center,
    )
}

/// `scene` with its last object but `back` somewhere else.
fn moved(scene: &Scene, back: usize, center: DVec3) -> Scene {
    let mut scene = scene.clone();
    let index = scene.instances.len() - 1 - back;
    scene.instances[index].world_from_object = at(center);
    scene
}

fn next(cache: &mut PrepareCache, scene: &Scene) -> PreparedScene {
    let settings = PrepareSettings::default();
    prepare_with(scene, &settings, cache, &|_, _| ControlFlow::Continue(()))
        .expect("nothing asks it to stop")
}

#[test]
fn moving_an_object_again_builds_nothing() {
    let mut cache = PrepareCache::default();
    let first = two_balls();
    assert_eq!(next(&mut cache, &first).instance_stats().instances, 0);
    let built = |meshes_built, own_built, meshes_reused, own_reused| PrepareCounts {
        meshes_built,
        meshes_reused,
        own_built,
        own_reused,
    };
    assert_eq!(cache.counts(), built(0, 1, 0, 0));
    // The first move makes the object an instance.
    let second = moved(&first, 0, DVec3::new(0.3, 0.6, 0.2));
    let before = next(&mut cache, &second);
    assert_eq!(before.instance_stats().instances, 1);
    assert_eq!(cache.counts(), built(1, 2, 0, 0));
    // From then on nothing is built.
    let third = moved(&second, 0, DVec3::new(-0.3, 0.9, 0.2));
    let after = next(&mut cache, &third);
    assert_eq!(cache.counts(), built(1, 2, 1, 1));
    let tree = |scene: &PreparedScene| {
        let instances = scene.aggregate().instances().expect("one");
        Arc::clone(instances.list()[0].mesh())
    };
    assert!(Arc::ptr_eq(&tree(&before), &tree(&after)));
    assert!(std::ptr::eq(before.shapes(), after.shapes()));
    // The same picture as from scratch.
    let camera = view(DVec3::new(0.0, 0.75, 4.8), DVec3::new(0.0, 0.75, 0.0), 31.0);
    let mean = |scene: &PreparedScene| {
        let (radiance, _) = samples(scene, &camera, (40, 30), 16);
        radiance.iter().sum::<Rgb>() / radiance.len() as f32
    };
    let (edited, fresh) = (mean(&after), mean(&prepared(&third, Instancing::Never)));
    let difference = (edited - fresh).abs().max_element() / fresh.max_element();
    assert!(difference < 1e-4, "{difference:e}");
    // Out of the box, which moves the bounds of the scene.
    let fourth = moved(&third, 0, DVec3::new(1.4, 0.6, 0.2));
    assert_ne!(fourth.bounds(), third.bounds());
    next(&mut cache, &fourth);
    assert_eq!(cache.counts(), built(1, 2, 2, 2));
    // So far out that another tracing space is needed.
    next(&mut cache, &moved(&third, 0, DVec3::X * 30.0));
    assert_eq!(cache.counts(), built(1, 3, 3, 2));
    next(&mut cache, &third);
    assert_eq!(cache.counts(), built(1, 4, 4, 2));
    // Another object, then another kind of tree.
    next(&mut cache, &moved(&third, 1, HERE + DVec3::X * 0.1));
    assert_eq!(cache.counts(), built(2, 5, 5, 2));
    let other = PrepareSettings {
        bvh: BvhSettings {
            leaf_size: 2,
            ..BvhSettings::default()
        },
        ..PrepareSettings::default()
    };
    prepare_with(
        &third,
        &other,
        &mut cache,
        &|_, _| ControlFlow::Continue(()),
    );
    assert_eq!(cache.counts(), built(4, 6, 5, 2));
}

#[test]
fn moving_something_small_leaves_the_rest_as_it_is() {
    let mut cache = PrepareCache::default();
    let mut builder = cornell_box("a die and a ball");
    let grey = builder.diffuse("grey", Rgb::splat(0.6));
    place(&mut builder, ball(40, false), &[grey], &[at(HERE)]);
    place(
        &mut builder,
        ball(2, false),
        &[grey],
        &[at(-HERE + DVec3::Y)],
    );
    let first = builder.finish();
    next(&mut cache, &first);
    next(&mut cache, &moved(&first, 0, DVec3::new(0.3, 0.6, 0.2)));
    let before = cache.counts();
    next(&mut cache, &moved(&first, 0, DVec3::new(0.2, 0.6, 0.2)));
    let after = cache.counts();
    let built = |counts: PrepareCounts| (counts.meshes_built, counts.own_built);
    assert_eq!(built(after), built(before));
    assert_eq!(after.own_reused, before.own_reused + 1);
}

#[test]
fn another_scene_takes_nothing_over_and_a_stopped_one_loses_nothing() {
    let mut cache = PrepareCache::default();
    let first = two_balls();
    next(&mut cache, &first);
    let second = moved(&first, 0, HERE);
    next(&mut cache, &second);
    let stopped = prepare_with(
        &second,
        &PrepareSettings::default(),
        &mut cache,
        &|stage, _| match stage {
            "placing geometry" => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        },
    );
    assert!(stopped.is_none());
    let before = cache.counts();
    next(&mut cache, &second);
    assert_eq!(cache.counts().meshes_built, before.meshes_built);
    // Somewhat larger, so that the tracing space could be kept.
    let mut other = two_balls();
    other.instances.last_mut().expect("some").world_from_object = at(DVec3::X * 1.2);
    let opened = next(&mut cache, &other);
    assert_eq!(opened.instance_stats().instances, 0);
    let anew = next(&mut PrepareCache::default(), &other);
    assert_eq!(opened.normalization(), anew.normalization());
    let before = cache.counts();
    next(&mut cache, &second);
    assert_eq!(
        cache.counts().meshes_built,
        before.meshes_built,
        "its moves are forgotten"
    );
}

#[test]
fn a_session_keeps_the_trees_of_what_moves() {
    let session = RenderSession::new(SessionOptions { interactive: false }, || ());
    let render = |scene: &Scene| {
        session.request(RenderJob {
            scene: Arc::new(scene.clone()),
            camera: view(DVec3::new(0.0, 0.75, 4.8), DVec3::new(0.0, 0.75, 0.0), 31.0),
            settings: RenderSettings {
                width: 8,
                height: 6,
                stop: StopRule {
                    samples_per_pixel: Some(1),
                    ..StopRule::default()
                },
                ..RenderSettings::default()
            },
        });
        let started = Instant::now();
        loop {
            let ended = session.status().is_finished();
            if let Some(prepared) = session.prepared().filter(|_| ended) {
                let last = scene.instances.last().expect("some").world_from_object;
                let center = last.transform_point3(DVec3::ZERO);
                if is_shown(&prepared, center) {
                    return prepared;
                }
            }
            assert!(started.elapsed() < Duration::from_secs(60), "it ends");
            std::thread::sleep(Duration::from_millis(1));
        }
    };
    let first = two_balls();
    render(&first);
    let second = moved(&first, 0, DVec3::new(0.3, 0.6, 0.2));
    let before = render(&second);
    let after = render(&moved(&second, 0, DVec3::new(-0.3, 0.7, 0.2)));
    let tree = |scene: &PreparedScene| {
        let instances = scene.aggregate().instances().expect("one");
        Arc::clone(instances.list()[0].mesh())
    };
    assert!(!Arc::ptr_eq(&before, &after));
    assert!(Arc::ptr_eq(&tree(&before), &tree(&after)));
    assert!(std::ptr::eq(before.shapes(), after.shapes()));
}

/// True when the last object of `scene` is the one around `center`.
fn is_shown(scene: &PreparedScene, center: DVec3) -> bool {
    let last = scene.aggregate().primitive_count() - 1;
    let vertex = scene.aggregate().vertices(last as u32)[0];
    let there = vertex / scene.normalization().scale + scene.normalization().center;
    there.distance(center) < 0.25
}
