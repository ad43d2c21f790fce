//! The course's scenes, when they lie beside the repository: the brightness that the course's
//! program gives them (and a corrected one), and that all of them render.

use crate::beside::{load, picture, prepared_as, shared};
use softbox::color::Rgb;
use softbox::film::PixelStats;
use softbox::integrator::PathSettings;
use softbox::scene::{Scene, initial_camera};
use softbox::settings::{CameraRule, MaxDepth, Mode};

const SIZE: (u32, u32) = (480, 360);
/// What the course shows as white, in linear radiance: 1 / √2.
const WHITE: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Means may differ from the noted ones by this share, or by this much in the last noted digit.
const TOLERANCE: (f64, f64) = (0.02, 0.0006);

/// Columns and rows, ends excluded.
type Area = ((usize, usize), (usize, usize));
const WHOLE: Area = ((0, 480), (0, 360));
const BACK_WALL: Area = ((190, 290), (100, 180));
const FRONT_FLOOR: Area = ((190, 290), (335, 348));

fn render(scene: &Scene, depth: u32, course_compatible: bool) -> Vec<PixelStats> {
    let camera = initial_camera(scene, CameraRule::Auto, true);
    let settings = PathSettings {
        mode: Mode::Importance,
        light_samples: 4,
        max_depth: MaxDepth(depth),
        only_last_bounce: false,
        seed: 3,
        replicates: 1,
        reuse: 1,
    };
    let scene = prepared_as(scene, course_compatible);
    picture(&scene, &camera, settings, SIZE, (0, 4)).0
}

/// The mean of what is shown, white at most.
fn mean(pixels: &[PixelStats], (columns, rows): Area) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for y in rows.0..rows.1 {
        for x in columns.0..columns.1 {
            let pixel = pixels[y * SIZE.0 as usize + x].mean();
            (0..3).for_each(|c| sum[c] += pixel[c].min(WHITE));
        }
    }
    let count = (columns.1 - columns.0) * (rows.1 - rows.0);
    sum.map(|s| s / count as f64)
}

fn compare(what: &str, found: f64, noted: f64) -> Option<String> {
    let allowed = (TOLERANCE.0 * noted).max(TOLERANCE.1);
    ((found - noted).abs() > allowed).then(|| format!("{what}: {found}, should be {noted}"))
}

/// Means noted for one depth: the whole picture's red, green and blue, the red of the back wall and
/// of the front floor.
struct Noted {
    depth: u32,
    whole: [f64; 3],
    places: Option<(f64, f64)>,
}

const fn noted(depth: u32, whole: [f64; 3], places: Option<(f64, f64)>) -> Noted {
    Noted {
        depth,
        whole,
        places,
    }
}

/// `scene` lit by the light node's own rectangle, 0.6 wide and 0.8 deep, as the corrected program
/// does it. In the scene as it stands the emissive quad shines, which is 0.8 wide and 0.6 deep and
/// so lights the back wall less.
fn with_the_nodes_rectangle(mut scene: Scene) -> Scene {
    let materials = &scene.materials;
    let is_dark = |material: &usize| materials[*material].emission == Rgb::ZERO;
    let before = scene.instances.len();
    scene.instances.retain(|i| i.materials.iter().all(is_dark));
    assert_eq!(scene.instances.len() + 1, before, "one emissive quad");
    scene
}

fn check(file: &str, course_compatible: bool, notes: &[Noted]) {
    if let Some(scene) = load(file) {
        check_scene(file, &scene, course_compatible, notes);
    }
}

fn check_scene(file: &str, scene: &Scene, course_compatible: bool, notes: &[Noted]) {
    let mut complaints = Vec::new();
    for note in notes {
        let pixels = render(scene, note.depth, course_compatible);
        let name = format!("{file} depth {}", note.depth);
        let whole = mean(&pixels, WHOLE);
        for (c, (found, noted)) in whole.into_iter().zip(note.whole).enumerate() {
            complaints.extend(compare(&format!("{name} channel {c}"), found, noted));
        }
        if let Some((back_wall, front_floor)) = note.places {
            for (place, area, noted) in [
                ("back wall", BACK_WALL, back_wall),
                ("front floor", FRONT_FLOOR, front_floor),
            ] {
                let found = mean(&pixels, area)[0];
                complaints.extend(compare(&format!("{name} {place}"), found, noted));
            }
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

const SPHERES: &str = "scenes/sky/CBspheres_lambertian.dae";
const BUNNY: &str = "scenes/sky/CBbunny.dae";

#[test]
fn spheres_as_in_the_course() {
    check(
        SPHERES,
        true,
        &[
            noted(0, [0.0103; 3], Some((0.0, 0.0))),
            noted(1, [0.159, 0.141, 0.159], Some((0.298, 0.417))),
            noted(2, [0.221, 0.187, 0.220], Some((0.370, 0.444))),
            noted(3, [0.249, 0.206, 0.248], Some((0.412, 0.477))),
            noted(5, [0.269, 0.217, 0.268], Some((0.439, 0.489))),
            noted(100, [0.275, 0.220, 0.275], Some((0.446, 0.492))),
        ],
    );
}

#[test]
fn spheres_with_the_right_light() {
    let Some(scene) = load(SPHERES) else {
        return;
    };
    check_scene(
        SPHERES,
        &with_the_nodes_rectangle(scene),
        false,
        &[
            noted(1, [0.122, 0.109, 0.122], Some((0.283, 0.250))),
            noted(2, [0.165, 0.141, 0.164], Some((0.339, 0.271))),
            noted(3, [0.186, 0.155, 0.185], Some((0.369, 0.293))),
            noted(5, [0.200, 0.162, 0.199], Some((0.388, 0.304))),
            noted(100, [0.204, 0.164, 0.204], Some((0.395, 0.307))),
        ],
    );
}

/// From two bounces on, the quad's other shape hardly changes the whole picture.
#[test]
fn spheres_with_the_quad_itself() {
    check(
        SPHERES,
        false,
        &[
            noted(0, [0.0103; 3], Some((0.0, 0.0))),
            noted(2, [0.165, 0.141, 0.164], None),
            noted(5, [0.200, 0.162, 0.199], None),
        ],
    );
}

#[test]
fn bunny_as_in_the_course() {
    check(
        BUNNY,
        true,
        &[
            noted(1, [0.164, 0.146, 0.164], None),
            noted(5, [0.266, 0.216, 0.268], None),
            noted(100, [0.270, 0.217, 0.272], None),
        ],
    );
}

#[test]
fn bunny_with_the_right_light() {
    check(BUNNY, false, &[noted(5, [0.192, 0.156, 0.193], None)]);
}

/// Every scene file in the folders of scenes.
fn scene_files() -> Vec<String> {
    let Some(root) = shared() else {
        return Vec::new();
    };
    let mut files = Vec::new();
    let mut folders = vec![root.join("scenes")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "dae") {
                let name = path.strip_prefix(&root).expect("below the root");
                files.push(name.to_string_lossy().into_owned());
            }
        }
    }
    files.sort();
    files
}

/// Which renders of a scene are black with good reason.
fn is_known_to_be_black(scene: &Scene, mode: Mode, course_compatible: bool) -> bool {
    let emits = |m: &usize| scene.materials[*m].emission != Rgb::ZERO;
    let has_emitter = scene
        .instances
        .iter()
        .any(|i| i.materials.iter().any(emits));
    // The "unlit" scenes wait for an environment map. The course's uniform directions find emissive
    // surfaces only.
    !scene.has_light() || (course_compatible && mode == Mode::Hemisphere && !has_emitter)
}

#[test]
fn every_scene_renders_in_every_mode() {
    for file in scene_files() {
        let Some(scene) = load(&file) else {
            continue;
        };
        assert_eq!(file.contains("unlit"), !scene.has_light(), "{file}");
        let camera = initial_camera(&scene, CameraRule::Auto, false);
        for course_compatible in [false, true] {
            let prepared = prepared_as(&scene, course_compatible);
            for mode in Mode::ALL {
                let settings = PathSettings {
                    mode,
                    light_samples: 1,
                    max_depth: MaxDepth(5),
                    only_last_bounce: false,
                    seed: 0,
                    replicates: 1,
                    reuse: 1,
                };
                let (pixels, counts) = picture(&prepared, &camera, settings, (64, 48), (0, 1));
                let what = format!("{file} {mode:?}, course-compatible: {course_compatible}");
                assert_eq!(counts.invalid_samples, 0, "{what}");
                let lit = pixels.iter().filter(|p| p.mean()[1] > 0.0).count();
                let is_black = is_known_to_be_black(&scene, mode, course_compatible);
                assert_eq!(lit == 0, is_black, "{what}: {lit} pixels lit");
            }
        }
    }
}
