//! The form of the course's program: its letters, its defaults, its lines.

use softbox::color::Rgb;
use softbox::io::camera_file::{CameraFile, write_camera_file};
use softbox::io::picture::{Metadata, read_png, write_exr};

use crate::{folder_with, mean, names, pixels, run};

const SCENES: [&str; 4] = [
    "cornell-spheres",
    "cornell-mirror-glass",
    "cornell-microfacet",
    "open-sky",
];

/// Command lines of the course's instructions and reports, with our scenes and small pictures.
const LINES: [&str; 24] = [
    "-f a.png -r 12 9 cornell-spheres.dae",
    "-t 8 -r 12 9 -f a.png cornell-spheres.dae",
    "-t 8 -s 16 -l 8 -H -f a.png -r 12 9 cornell-spheres.dae",
    "-t 8 -s 64 -l 32 -H -m 6 -f a.png -r 12 9 cornell-spheres.dae",
    "-t 8 -s 64 -l 32 -m 6 -f a.png -r 12 9 cornell-spheres.dae",
    "-t 8 -s 1 -l 1 -m 6 -f a.png -r 12 9 cornell-spheres.dae",
    "-t 8 -s 1 -l 64 -m 6 -f a.png -r 12 9 cornell-spheres.dae",
    "-t 8 -s 1024 -l 16 -m 5 -r 12 9 -f a.png cornell-spheres.dae",
    "-t 8 -s 1024 -l 4 -m 0 -r 12 9 -f a.png cornell-spheres.dae",
    "-t 8 -s 1024 -l 4 -m 100 -r 12 9 -f a.png cornell-spheres.dae",
    "-t 8 -s 64 -l 4 -m 3 -o 0 -r 12 9 -f a.png cornell-spheres.dae",
    "-t 8 -s 64 -l 4 -m 3 -o 1 -r 12 9 -f a.png cornell-spheres.dae",
    "-t 8 -s 2048 -a 64 0.05 -l 1 -m 5 -r 12 9 -f a.png cornell-spheres.dae",
    "-t 2 -s 16 -l 4 -m 5 -r 12 9 -f a.png cornell-spheres.dae",
    "-t 2 -s 4 -p 2 3 4 5 -r 12 9 -f a.png cornell-spheres.dae",
    "-t 2 -s 64 -l 4 -m 5 -r 12 9 -f a.png cornell-mirror-glass.dae",
    "-t 2 -s 128 -l 1 -m 5 -r 12 9 -f a.png cornell-microfacet.dae",
    "-t 2 -s 64 -l 1 -H -r 12 9 -f a.png cornell-microfacet.dae",
    "-t 2 -s 4 -l 64 -e field.exr -r 12 9 -f a.png open-sky.dae",
    "-t 2 -s 4 -l 64 -H -e field.exr -r 12 9 -f a.png open-sky.dae",
    "-t 2 -s 16 -b 0.05 -d 4.7 -r 12 9 -f a.png cornell-microfacet.dae",
    "-t 2 -s 4 -c cam.txt -r 12 9 -f a.png cornell-spheres.dae",
    "-t 2 -s 4 -r 12 9 --course-compatible -f a.png cornell-spheres.dae",
    "cornell-spheres.dae -f a.png -r 12 9 -s 2",
];

/// What the course's program writes for the Cornell box at 480 × 360.
fn camera_file() -> CameraFile {
    CameraFile {
        hfov: 30.7,
        vfov: 23.26,
        aspect: 4.0 / 3.0,
        near: 0.001,
        far: 1000.0,
        position: glam::DVec3::new(0.0, 0.75, 4.8),
        target: glam::DVec3::new(0.0, 0.75, 0.0),
        phi: std::f64::consts::FRAC_PI_2,
        theta: 0.0,
        distance: 4.8,
        min_distance: 0.24,
        max_distance: 48.0,
        world_from_camera: glam::DMat3::IDENTITY,
        width: 480.0,
        height: 360.0,
        screen_distance: 875.0,
        focal_distance: 4.7,
        lens_radius: 0.0,
    }
}

#[test]
fn the_lines_of_the_course_run_unchanged() {
    let folder = folder_with(&SCENES);
    let field = vec![Rgb::ONE; 8];
    write_exr(
        &folder.path().join("field.exr"),
        4,
        2,
        &field,
        &Metadata::default(),
    )
    .unwrap();
    write_camera_file(&folder.path().join("cam.txt"), &camera_file()).unwrap();
    for line in LINES {
        let printed = run(&folder, line);
        assert_eq!(printed, "", "{line}");
        let picture = read_png(&folder.path().join("a.png")).unwrap();
        let size = (picture.image.width(), picture.image.height());
        assert_eq!(size, (12, 9), "{line}");
        // With -m 0 the middle of the picture, where there is no lamp, is black.
        let is_black = line.contains("-m 0 ");
        assert_eq!(mean(picture.image.pixels()) == 0.0, is_black, "{line}");
        std::fs::remove_file(folder.path().join("a.png")).unwrap();
    }
}

#[test]
fn adaptive_sampling_also_writes_the_sampling_rate() {
    let folder = folder_with(&SCENES[..1]);
    let line = "-s 128 -a 16 0.5 -l 1 -m 2 -r 48 36 -f box.png cornell-spheres.dae";
    run(&folder, line);
    assert_eq!(
        names(&folder),
        ["box.png", "box_rate.png", "cornell-spheres.dae"]
    );
    let rate = read_png(&folder.path().join("box_rate.png")).unwrap();
    assert_eq!((rate.image.width(), rate.image.height()), (48, 36));
    // Fewer than all samples somewhere: not the red of the most everywhere.
    let is_red = |p: &Rgb| p.x > 0.9 && p.y < 0.1 && p.z < 0.1;
    assert!(!rate.image.pixels().iter().all(is_red));
    let command = rate.metadata.get(Metadata::COMMAND).unwrap();
    assert!(command.contains("--adaptive 16,0.5"), "{command}");
}

#[test]
fn the_view_is_cut_out_not_scaled() {
    let folder = folder_with(&SCENES[..1]);
    let line = "-s 4 -m 1 cornell-spheres.dae";
    run(
        &folder,
        &format!("{line} -r 40 30 -f small.exr --view normals"),
    );
    run(
        &folder,
        &format!("{line} -r 80 60 -f large.exr --view normals"),
    );
    let (small, large) = (pixels(&folder, "small.exr"), pixels(&folder, "large.exr"));
    // The middle of the larger picture shows what the smaller one shows.
    let mut different = 0;
    for (i, normal) in small.iter().enumerate() {
        let (x, y) = (i % 40 + 20, i / 40 + 15);
        let other = large[80 * y + x];
        different += usize::from((*normal - other).abs().max_element() > 0.1);
    }
    assert!(
        different < small.len() / 50,
        "{different} of {}",
        small.len()
    );
}

#[test]
fn depth_and_single_bounces_follow_the_letters() {
    let folder = folder_with(&SCENES[..1]);
    let light = |name: &str, letters: &str| {
        run(
            &folder,
            &format!("-l 2 {letters} -r 48 36 -f {name}.exr cornell-spheres.dae"),
        );
        mean(&pixels(&folder, &format!("{name}.exr")))
    };
    let (m1, m2) = (light("m1", "-s 32 -m 1"), light("m2", "-s 32 -m 2"));
    let second = light("o2", "-s 32 -m 2 -o 0");
    assert!(m1 > 0.0 && m2 > m1 && second > 0.0);
    assert!(
        (m1 + second - m2).abs() < 1e-3 * m2,
        "{m1} + {second} = {m2}"
    );
    // Both estimators of direct light agree within their noise.
    let hemisphere = light("h1", "-m 1 -H -s 512");
    assert!((hemisphere / m1 - 1.0).abs() < 0.2, "{hemisphere} {m1}");
}
