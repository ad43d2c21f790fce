use std::path::Path;

use super::*;
use glam::DVec3;
use softbox::bvh::{BvhKind, BvhQuality};
use softbox::display::ToneCurve;
use softbox::image::Region;
use softbox::math::Isa;
use softbox::settings::{AdaptiveGoal, CameraRule, IntegratorKind, MaxDepth, Mode, View};

use crate::bench_args::BenchArgs;
use crate::job::FieldOfView;

fn request(line: &str) -> Request {
    parse(line.split_whitespace(), None).unwrap_or_else(|error| panic!("{line}: {error}"))
}

fn headless(line: &str) -> Job {
    match request(line) {
        Request::Render(job, _) => job,
        other => panic!("{line}: {other:?}"),
    }
}

fn wrong(line: &str) -> String {
    let error = parse(line.split_whitespace(), None).unwrap_err();
    assert_eq!(error.exit_code(), 2, "{line}");
    error.to_string()
}

#[test]
fn the_definition_is_consistent() {
    Cli::command().debug_assert();
}

#[test]
fn the_courses_own_line_works_unchanged() {
    let job = headless("softbox -t 8 -s 16 -l 8 -H -f CBbunny_H_16_8.png -r 480 360 CBbunny.dae");
    assert_eq!(job.scene.as_deref(), Some(Path::new("CBbunny.dae")));
    assert_eq!(job.outputs, [Path::new("CBbunny_H_16_8.png")]);
    let s = &job.settings;
    assert_eq!(
        (s.threads, s.light_samples, s.mode),
        (8, 8, Mode::Hemisphere)
    );
    assert_eq!(s.stop.samples_per_pixel, Some(16));
    assert_eq!((s.width, s.height, s.max_depth), (480, 360, MaxDepth(1)));
    assert_eq!((s.adaptive, job.rate_picture), (None, None));
    assert!(job.camera.crops && !s.course_compatible);
}

#[test]
fn the_courses_defaults_hold_in_its_form_only() {
    let job = headless("softbox -f a.png x.dae");
    let s = &job.settings;
    assert_eq!(
        (s.threads, s.light_samples, s.max_depth),
        (1, 1, MaxDepth(1))
    );
    assert_eq!((s.width, s.height, s.mode), (800, 600, Mode::Importance));
    assert_eq!(
        (s.stop.samples_per_pixel, s.adaptive, s.region),
        (Some(1), None, None)
    );
    assert!(!s.only_last_bounce);

    let Request::View(job, _) = request("softbox -l 4 -r 640 480 x.dae") else {
        panic!("without -f the window opens");
    };
    let s = &job.settings;
    assert_eq!(
        (s.threads, s.light_samples, s.max_depth),
        (0, 4, MaxDepth(5))
    );
    assert_eq!(
        (s.width, s.mode, s.stop.samples_per_pixel),
        (640, Mode::Best, None)
    );
    assert!(!job.camera.crops);
    assert!(matches!(request("softbox"), Request::View(job, _) if job == Job::default()));
}

#[test]
fn every_letter_of_the_course_is_understood() {
    let job = headless(
        "softbox -t 8 -s 2048 -a 64 0.05 -l 1 -m 5 -o 0 -e field.exr -b 0.05 -d 4.7 \
         -c cam.txt -p 10 20 30 40 -r 480 360 -f out/CBbunny.png CBbunny.dae",
    );
    let s = &job.settings;
    let adaptive = s.adaptive.unwrap();
    assert_eq!((adaptive.batch, adaptive.tolerance), (64, 0.05));
    assert_eq!(adaptive.goal, AdaptiveGoal::Even);
    assert_eq!(
        job.rate_picture.as_deref(),
        Some(Path::new("out/CBbunny_rate.png"))
    );
    assert!(s.only_last_bounce);
    assert_eq!(s.max_depth, MaxDepth(5));
    let region = |y| Region {
        x: 10,
        y,
        width: 30,
        height: 40,
    };
    assert_eq!(s.region, Some(region(20)));
    assert_eq!(job.environment.as_deref(), Some(Path::new("field.exr")));
    assert_eq!(job.camera.file.as_deref(), Some(Path::new("cam.txt")));
    assert_eq!(
        (job.camera.lens_radius, job.camera.focal_distance),
        (Some(0.05), Some(4.7))
    );

    let job =
        headless("softbox -o 1 -m 100 -p 10 20 30 40 --course-compatible -a 32 0.1 -f a.png x");
    assert!(!job.settings.only_last_bounce);
    assert_eq!(job.settings.region, Some(region(600 - 20 - 40)));
    assert_eq!(job.settings.adaptive.unwrap().goal, AdaptiveGoal::Course);
    assert_eq!(job.display.tone_curve, ToneCurve::Course);
}

#[test]
fn the_lines_of_the_courses_report_are_understood() {
    for line in [
        "-f CBempty.png -r 480 360 CBempty.dae",
        "-t 8 -r 800 600 -f cow.png cow.dae",
        "-t 8 -s 64 -l 32 -H -m 6 -f CBbunny_H_64_32.png -r 480 360 CBbunny.dae",
        "-s 1 -l 64 -m 1 -f CBspheres.png -r 480 360 CBspheres_lambertian.dae",
        "-s 1024 -m 0 -f m0.png CBbunny.dae",
        "-s 1024 -m 100 -l 4 -f m100.png CBbunny.dae",
        "-s 2048 -a 64 0.05 -l 1 -m 5 -f adaptive.png CBbunny.dae",
        "-s 4 -l 64 -e grace.exr -f env.png bunny_unlit.dae",
        "-t 2 -s 16 -l 4 -m 5 -r 480 360 -f d.png dragon.dae",
    ] {
        let job = headless(&format!("softbox {line}"));
        assert_eq!(job.outputs.len(), 1, "{line}");
    }
}

#[test]
fn render_takes_every_long_option() {
    let job = headless(
        "softbox render x.dae -o a.png -o b.exr --size 640x480 --region 1,2,3,4 --spp 9 \
         --light-samples 2 --max-depth inf --only-last-bounce --mode importance \
         --integrator reference --adaptive 8,0.5 --adaptive-rule course --seed 42 \
         --time-limit 1.5 --target-error 0.01 --view normals --threads 3 --isa portable --bvh median \
         --leaf-size 8 --bvh-quality fast --exposure -2.5 --tone-curve reinhard --camera-rule fit \
         --eye -1,2,3 --target 0,-1,0 --up 0,0,1 --xfov 31 --lens-radius 0.1 \
         --focal-distance 2 --environment sky.hdr",
    );
    let s = &job.settings;
    assert_eq!(job.outputs, [Path::new("a.png"), Path::new("b.exr")]);
    assert_eq!((s.width, s.height, s.seed, s.threads), (640, 480, 42, 3));
    assert_eq!(
        (s.max_depth, s.mode),
        (MaxDepth::INFINITE, Mode::Importance)
    );
    assert_eq!(
        (s.integrator, s.view),
        (IntegratorKind::Reference, View::Normals)
    );
    assert_eq!((s.bvh.kind, s.bvh.leaf_size), (BvhKind::Median, 8));
    assert_eq!(s.bvh.quality, BvhQuality::Fast);
    assert_eq!(s.isa, Some(Isa::Portable));
    assert_eq!(
        (s.stop.samples_per_pixel, s.stop.seconds),
        (Some(9), Some(1.5))
    );
    assert_eq!(s.stop.relative_error, Some(0.01));
    assert_eq!(s.adaptive.unwrap().goal, AdaptiveGoal::Course);
    assert_eq!(
        (job.display.exposure, job.display.tone_curve),
        (-2.5, ToneCurve::Reinhard)
    );
    let camera = &job.camera;
    assert_eq!(camera.rule, CameraRule::Fit);
    assert_eq!(camera.eye, Some(DVec3::new(-1.0, 2.0, 3.0)));
    assert_eq!(camera.target, Some(DVec3::NEG_Y));
    assert_eq!(
        (camera.up, camera.fov),
        (Some(DVec3::Z), Some(FieldOfView::X(31.0)))
    );
    assert!(!camera.crops);
}

#[test]
fn render_always_ends() {
    let stop = |options: &str| {
        headless(&format!("softbox render x -o a.png {options}"))
            .settings
            .stop
    };
    assert_eq!(stop("").samples_per_pixel, Some(64));
    assert_eq!(stop("--time-limit 5").samples_per_pixel, None);
    assert_eq!(
        stop("--target-error 0.1 --spp 3").samples_per_pixel,
        Some(3)
    );
    let course = headless("softbox -f a.png --time-limit 5 x.dae")
        .settings
        .stop;
    assert_eq!(
        (course.samples_per_pixel, course.seconds),
        (None, Some(5.0))
    );
}

#[test]
fn wrong_usage_is_refused_with_a_reason() {
    assert!(wrong("softbox -f a.png").contains("SCENE"));
    assert!(wrong("softbox render x.dae").contains("--output"));
    assert!(wrong("softbox render -o a.png").contains("SCENE"));
    assert!(wrong("softbox render x -o a.png --mode worst").contains("hemisphere"));
    assert!(wrong("softbox render x -o a.png --bvh-quality best").contains("standard"));
    assert!(wrong("softbox render x -o a.png --size 0x4").contains("0x4"));
    assert!(wrong("softbox render x -o a.png --spp 0").contains("spp"));
    assert!(wrong("softbox render x -o a.png --size 8x8 --region 8,0,4,4").contains("outside"));
    assert!(wrong("softbox render x -o a.png --xfov 30 --yfov 30").contains("--yfov"));
    assert!(wrong("softbox -f a.png -r 480 x.dae").contains("-r"));
    assert!(wrong("softbox -f a.png -H --mode best x.dae").contains("-H"));
    assert!(wrong("softbox -f a.png -a 0 0.05 x.dae").contains("samples"));
    assert!(wrong("softbox -f a.png -p 0 0 0 5 x.dae").contains("region"));
    assert!(wrong("softbox -f a.png -o 2 x.dae").contains("-o"));
    assert!(wrong("softbox compare a.exr").contains("REFERENCE"));
    assert!(wrong("softbox --renderer metal").contains("wgpu"));
}

#[test]
fn a_bench_says_what_it_measures() {
    let Request::BenchRays(bench) = request("softbox bench --rays --kinds shadow1 city a.dae")
    else {
        panic!("no bench");
    };
    assert_eq!(bench.scenes, ["city", "a.dae"]);
    assert_eq!(bench.protocol.threads, [1, 2]);
    assert_eq!(bench.protocol.size, (512, 384));
    assert_eq!(bench.protocol.kinds, [crate::ray_bench::Kind::Shadow1]);
    wrong("softbox bench --rays --threads 0");
    wrong("softbox bench --rays --size 512");
    wrong("softbox bench --rays --kinds bounce3");
}

#[test]
fn a_bench_of_error_takes_the_settings_of_a_render() {
    let bench = |line: &str| match request(line) {
        Request::Bench(bench) => bench,
        other => panic!("{line}: {other:?}"),
    };
    let names = |args: &BenchArgs| -> Vec<String> {
        args.contenders().iter().map(ToString::to_string).collect()
    };
    let plain = bench("softbox bench");
    let settings = plain.render_settings();
    assert_eq!((settings.width, settings.height), (480, 360));
    assert_eq!(
        (plain.seeds, plain.spp.to_string().as_str()),
        (5, "1,2,4,8,16,32,64")
    );
    assert_eq!(names(&plain), ["best"]);
    assert_eq!(plain.chosen_reference_mode(), Mode::Importance);
    assert_eq!(plain.chosen_reference_spp(), 1024);

    let line =
        "softbox bench a.dae --compare importance,best+even -m 2 --size 32x24 --seed 9 -t 1 -s 2,8";
    let chosen = bench(line);
    let settings = chosen.render_settings();
    assert_eq!((settings.max_depth, settings.seed), (MaxDepth(2), 9));
    assert_eq!((settings.threads, settings.width), (1, 32));
    assert_eq!(names(&chosen), ["importance", "best+even"]);
    let other = bench("softbox bench --mode importance");
    assert_eq!(other.chosen_reference_mode(), Mode::Best);

    for (line, reason) in [
        ("softbox bench --compare best,best", "twice"),
        ("softbox bench --compare best+even,best+odd", "odd"),
        (
            "softbox bench --mode best --compare best,hemisphere",
            "--mode",
        ),
        ("softbox bench --spp 0", "1..64"),
        ("softbox bench --seeds 0", "seeds"),
        ("softbox bench a b --reference r.exr", "one scene"),
        ("softbox bench a --reference-noise 1e-5", "--reference"),
        (
            "softbox bench a --reference r.exr --reference-spp 64",
            "--reference",
        ),
        ("softbox bench a --view depth", "--view"),
        ("softbox bench a --region 900,0,5,5", "region"),
        ("softbox bench a --target-error 0.1", "--target-error"),
    ] {
        assert!(wrong(line).contains(reason), "{line}: {}", wrong(line));
    }
}
