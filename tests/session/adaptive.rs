//! Who gets the samples of adaptive sampling where pixels share their light.

use softbox::io::builtin_scene;
use softbox::session::Workbench;

use super::*;

#[test]
fn no_path_of_an_adaptive_picture_is_thrown_away() {
    for goal in [AdaptiveGoal::LeastError, AdaptiveGoal::Even] {
        let scene = Arc::new(builtin_scene("cornell-spheres").expect("built in").scene);
        let mut job = RenderJob {
            camera: initial_camera(&scene, CameraRule::Auto, false),
            scene,
            settings: RenderSettings::default(),
        };
        (job.settings.width, job.settings.height) = (64, 48);
        job.settings.adaptive = Some(Adaptive {
            batch: 32,
            tolerance: 0.03,
            goal,
            exposure: 0.0,
        });
        let bench = Workbench::new(&job);
        let mut picture = bench.begin(Mode::Best, 1);
        assert!(bench.advance(&mut picture, 128, &|| false));
        let (samples, budget) = (picture.samples(), 128 * 64 * 48);
        assert_eq!(picture.counts().camera_rays, samples, "{goal:?}");
        assert!(
            (budget / 2..=budget).contains(&samples),
            "{goal:?}: {samples}"
        );
        assert!(
            goal == AdaptiveGoal::LeastError || samples < budget,
            "no pixel has ended"
        );
    }
}
