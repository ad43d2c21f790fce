use std::ops::ControlFlow;
use std::sync::Arc;

use glam::{DMat4, DVec3};
use softbox::color::Rgb;
use softbox::scene::{
    PrepareCache, PrepareCounts, PrepareSettings, PreparedScene, Scene, cornell_box, prepare_with,
};

use crate::scenes::{SETTINGS, ball, place, samples, view};

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

/// Bits of the samples of a small picture.
fn picture(scene: &PreparedScene) -> Vec<[u32; 3]> {
    let camera = view(DVec3::new(0.0, 0.75, 4.8), DVec3::new(0.0, 0.75, 0.0), 31.0);
    let (radiance, _) = samples(scene, SETTINGS, &camera, (40, 30), 4);
    radiance
        .iter()
        .map(|c| c.to_array().map(f32::to_bits))
        .collect()
}

/// `scene` prepared after others, and that it gives the picture of `scene` prepared anew.
fn next_is_like_new(cache: &mut PrepareCache, scene: &Scene) {
    let edited = next(cache, scene);
    let new = next(&mut PrepareCache::default(), scene);
    assert_eq!(edited.normalization(), new.normalization());
    assert!(picture(&edited) == picture(&new), "the same bits");
}

#[test]
fn an_edit_keeps_or_fits_the_tree_and_a_new_mesh_builds_one() {
    let mut cache = PrepareCache::default();
    let own = |own_built, own_reused, own_refitted| PrepareCounts {
        own_built,
        own_reused,
        own_refitted,
        ..PrepareCounts::default()
    };
    let first = two_balls();
    next(&mut cache, &first);
    assert_eq!(cache.counts(), own(1, 0, 0));
    // Another colour.
    let mut painted = first.clone();
    painted.materials[0].name = "painted".to_owned();
    next_is_like_new(&mut cache, &painted);
    assert_eq!(cache.counts(), own(1, 1, 0));
    // Somewhere else, then out of the box, which moves the bounds of the scene.
    next_is_like_new(&mut cache, &moved(&first, 0, DVec3::new(0.3, 0.6, 0.2)));
    assert_eq!(cache.counts(), own(1, 1, 1));
    next_is_like_new(&mut cache, &moved(&first, 0, DVec3::new(1.1, 0.6, 0.2)));
    assert_eq!(cache.counts(), own(1, 1, 2));
    // Another mesh, then another kind of tree.
    let mut builder = cornell_box("another ball");
    let grey = builder.diffuse("grey", Rgb::splat(0.6));
    place(&mut builder, ball(10, false), &[grey], &[at(HERE)]);
    next_is_like_new(&mut cache, &builder.finish());
    assert_eq!(cache.counts(), own(2, 1, 2));
}

#[test]
fn a_tree_that_moves_have_spoilt_is_built_anew() {
    let mut cache = PrepareCache::default();
    let mut builder = cornell_box("many balls");
    let grey = builder.diffuse("grey", Rgb::splat(0.6));
    let place_at = |i: usize| {
        at(DVec3::new(
            (i % 5) as f64 * 0.3 - 0.6,
            (i / 5) as f64 * 0.3,
            0.0,
        ))
    };
    for i in 0..25 {
        place(&mut builder, ball(8, false), &[grey], &[place_at(i)]);
    }
    let first = builder.finish();
    next(&mut cache, &first);
    let mut shuffled = first.clone();
    let balls = shuffled.instances.len() - 25;
    for i in 0..25 {
        shuffled.instances[balls + i].world_from_object = place_at(i * 7 % 25);
    }
    next_is_like_new(&mut cache, &shuffled);
    assert_eq!(
        (cache.counts().own_built, cache.counts().own_refitted),
        (2, 0)
    );
}

#[test]
fn moving_a_copy_builds_nothing() {
    let mut cache = PrepareCache::default();
    let mut builder = cornell_box("copies");
    let grey = builder.diffuse("grey", Rgb::splat(0.6));
    let places: Vec<_> = (0..400)
        .map(|i| {
            at(DVec3::new(
                (i % 20) as f64 * 0.1 - 1.0,
                (i / 20) as f64 * 0.1,
                0.0,
            ))
        })
        .collect();
    place(&mut builder, ball(20, false), &[grey], &places);
    let first = builder.finish();
    let before = next(&mut cache, &first);
    assert_eq!(before.instance_stats().instances, 400);
    let after = next(&mut cache, &moved(&first, 3, DVec3::new(0.0, 0.5, 0.5)));
    let tree = |scene: &PreparedScene| {
        let instances = scene.aggregate().instances().expect("some");
        Arc::clone(instances.list()[0].mesh())
    };
    assert!(Arc::ptr_eq(&tree(&before), &tree(&after)));
    assert!(std::ptr::eq(before.shapes(), after.shapes()));
    let expected = PrepareCounts {
        meshes_built: 1,
        meshes_reused: 1,
        own_built: 1,
        own_reused: 1,
        own_refitted: 0,
    };
    assert_eq!(cache.counts(), expected);
}

#[test]
fn a_stopped_preparation_loses_no_shared_mesh() {
    let mut cache = PrepareCache::default();
    let first = two_balls();
    next(&mut cache, &first);
    let stopped = prepare_with(
        &moved(&first, 0, HERE),
        &PrepareSettings::default(),
        &mut cache,
        &|_, _| ControlFlow::Break(()),
    );
    assert!(stopped.is_none());
    next_is_like_new(&mut cache, &first);
}
