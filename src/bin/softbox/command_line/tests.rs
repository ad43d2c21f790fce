use std::path::PathBuf;

use super::*;
use crate::args::{Request, parse};
use softbox::bvh::{BvhKind, BvhQuality, BvhSettings};
use softbox::image::Region;
use softbox::math::Isa;
use softbox::settings::{
    Adaptive, CameraRule, IntegratorKind, MaxDepth, Mode, Reuse, StopRule, View,
};

fn job_of(words: &[String]) -> Job {
    match parse(words, None).unwrap() {
        Request::Render(job, _) | Request::View(job, _) => job,
        other => panic!("{other:?}"),
    }
}

/// No field as it is by default.
fn unusual() -> Job {
    Job {
        scene: Some(PathBuf::from("it's a 'scene' $HOME.dae")),
        outputs: vec![PathBuf::from("a b.png"), PathBuf::from("ä.exr")],
        rate_picture: Some(PathBuf::from("r.png")),
        settings: RenderSettings {
            width: 480,
            height: 361,
            region: Some(Region {
                x: 1,
                y: 2,
                width: 30,
                height: 40,
            }),
            light_samples: 7,
            max_depth: MaxDepth::INFINITE,
            only_last_bounce: true,
            mode: Mode::Hemisphere,
            reuse: Reuse::ALL[4],
            integrator: IntegratorKind::Reference,
            adaptive: Some(Adaptive {
                batch: 64,
                tolerance: 0.1 + 0.2,
                goal: AdaptiveGoal::Course,
                exposure: 1.5,
            }),
            seed: u64::MAX,
            course_compatible: false,
            bvh: BvhSettings {
                kind: BvhKind::Median,
                leaf_size: 9,
                quality: BvhQuality::Fast,
            },
            threads: 3,
            isa: Some(Isa::Portable),
            stop: StopRule {
                samples_per_pixel: Some(1000),
                seconds: Some(0.1 + 0.2),
                relative_error: Some(1e-9),
            },
            view: View::GeometricNormals,
        },
        camera: CameraChoice {
            rule: CameraRule::Fit,
            file: Some(PathBuf::from("cam settings.txt")),
            eye: Some(DVec3::new(-1.0, 1e-7, 1.0 / 3.0)),
            target: Some(DVec3::new(-0.0, 2e20, -3.5)),
            up: Some(DVec3::Z),
            fov: Some(FieldOfView::Y(31.000000000000004)),
            crops: true,
            lens_radius: Some(0.05),
            focal_distance: Some(4.7),
        },
        display: DisplaySettings {
            exposure: -1.3,
            tone_curve: ToneCurve::Filmic,
        },
        environment: Some(PathBuf::from("sky.exr")),
    }
}

#[test]
fn every_setting_survives_the_round_trip() {
    let job = unusual();
    assert_eq!(job_of(&words(&job)), job);
    let mut compatible = unusual();
    compatible.settings.course_compatible = true;
    compatible.display.tone_curve = ToneCurve::Srgb;
    if let Some(adaptive) = &mut compatible.settings.adaptive {
        adaptive.goal = AdaptiveGoal::Even;
    }
    assert_eq!(job_of(&words(&compatible)), compatible);
    let viewer = Job::default();
    assert_eq!(job_of(&words(&viewer)), viewer);
}

#[test]
fn course_lines_become_lines_of_ours_for_the_same_picture() {
    let line = "softbox -t 8 -s 2048 -a 64 0.05 -l 1 -m 5 -o 0 -H -b 0.1 -d 3 -p 1 2 30 40 \
                -r 480 360 -c cam.txt -f out/CB.png CBbunny.dae";
    for extra in ["", " --course-compatible"] {
        let line = format!("{line}{extra}");
        let course: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
        let job = job_of(&course);
        assert_eq!(job_of(&words(&job)), job);
    }
}

#[test]
fn a_shell_reads_the_same_words_back() {
    let job = unusual();
    let script = format!(
        "for w in {}; do printf '%s\\n' \"$w\"; done",
        command_line(&job)
    );
    let Ok(output) = std::process::Command::new("sh")
        .arg("-c")
        .arg(script)
        .output()
    else {
        return;
    };
    let printed = String::from_utf8(output.stdout).unwrap();
    assert_eq!(printed.lines().collect::<Vec<_>>(), words(&job));
}

#[test]
fn the_line_reads_as_a_person_would_write_it() {
    let line = "softbox render CBbunny.dae -o a.png --size 480x360 --spp 16 --mode importance \
                --light-samples 8 --max-depth 3 --seed 0";
    let given: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
    let spaced = line.split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(command_line(&job_of(&given)), spaced);
}

#[test]
fn odd_paths_stay_paths() {
    let job = Job {
        scene: Some(PathBuf::from("render")),
        outputs: vec![PathBuf::from("-o.png")],
        ..Job::default()
    };
    let read = job_of(&words(&job));
    assert_eq!(read.scene, Some(PathBuf::from("./render")));
    assert_eq!(read.outputs, [PathBuf::from("./-o.png")]);
}
