use super::*;

#[test]
fn exposure_brightens_the_image_and_never_touches_the_render() {
    let mut harness = viewer();
    wait_for_picture(&mut harness);
    let job = harness.state().document.render_job();
    let before = harness
        .state()
        .view
        .viewport
        .frame()
        .expect("a picture")
        .clone();
    harness
        .get_by_role_and_label(Role::Slider, "Exposure")
        .set_value_accesskit(2.0);
    wait(&mut harness, "the brighter image", |app| {
        app.view
            .viewport
            .frame()
            .is_some_and(|frame| !Arc::ptr_eq(&frame.image, &before.image))
    });
    let after = harness.state().view.viewport.frame().expect("a picture");
    assert!(Arc::ptr_eq(&before.snapshot, &after.snapshot));
    assert_eq!(harness.state().document.render_job(), job);
    let sum = |frame: &crate::viewer::presenter::Frame| {
        let pixels = frame.image.pixels.iter();
        pixels.map(|c| u64::from(c.r())).sum::<u64>()
    };
    assert!(sum(after) > sum(&before) * 5 / 4);
}

#[test]
fn views_of_numbers_come_with_a_legend() {
    let mut harness = viewer();
    for view in softbox::settings::View::ALL {
        harness.state_mut().document.settings.view = view;
        wait_for_picture(&mut harness);
        let frame = harness.state().view.viewport.frame().expect("a picture");
        let has_legend = matches!(view.name(), "depth" | "cost" | "samples" | "noise");
        assert_eq!(frame.legend.is_some(), has_legend, "{view:?}");
        if let Some(legend) = &frame.legend {
            assert!(legend.range.0 < legend.range.1, "{view:?} {legend:?}");
        }
    }
}
