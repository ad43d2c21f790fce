//! Pictures against those of an independent renderer, when they lie beside the repository.
//!
//! The slow tier: `cargo test --test references -- --ignored --nocapture --test-threads 1`.

mod beside;

use beside::{load, picture, prepared_as, shared};
use glam::DVec3;
use softbox::camera::{Camera, Framing};
use softbox::color::Rgb;
use softbox::film::PixelStats;
use softbox::image::{Image, compare};
use softbox::integrator::PathSettings;
use softbox::io::picture::read_exr;
use softbox::scene::PreparedScene;
use softbox::settings::{MaxDepth, Mode};

const SCENES: [&str; 6] = [
    "cb_empty",
    "cb_spheres",
    "glass_mirror",
    "open_sky",
    "cb_mesh70k",
    "many_lights",
];
const SIZE: (u32, u32) = (480, 360);
const BLOCK: usize = 8;
const COLUMNS: usize = SIZE.0 as usize / BLOCK;
const ROWS: usize = SIZE.1 as usize / BLOCK;
/// What two correct renderers may differ by, beyond noise.
const TOLERANCE: f64 = 0.005;
/// Score that one of 2700 blocks × 3 channels exceeds by chance once in a hundred pictures.
const BLOCK_SCORE: f64 = 4.9;

struct Reference {
    name: &'static str,
    scene: PreparedScene,
    camera: Camera,
    picture: Image<Rgb>,
    /// relMSE of the reference's own noise.
    noise: f64,
}

/// The reference `name`; `None`, with a message, when it is not there.
fn reference(name: &'static str) -> Option<Reference> {
    let scene = load(&format!("references/{name}/scene.dae"))?;
    let folder = shared()?.join("references").join(name);
    let json = |file: &str| -> serde_json::Value {
        let text = std::fs::read_to_string(folder.join(file)).expect("a readable file");
        serde_json::from_str(&text).expect("valid JSON")
    };
    let camera = &json("scene.json")["camera"];
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    let vector = |key: &str| DVec3::from_array([0, 1, 2].map(|i| number(&camera[key][i])));
    let camera = Camera {
        eye: vector("pos"),
        target: vector("target"),
        up: vector("up"),
        framing: Framing::Horizontal(number(&camera["hfov_deg"]).to_radians()),
        ..Camera::default()
    };
    Some(Reference {
        name,
        scene: prepared_as(&scene, false),
        camera,
        picture: read_exr(&folder.join("d5.exr"))
            .expect("a readable picture")
            .image,
        noise: number(&json("d5.json")["relmse_of_reference"]),
    })
}

impl Reference {
    fn render(&self, mode: Mode, samples: (u32, u32), replicates: u32) -> Vec<PixelStats> {
        let settings = PathSettings {
            mode,
            light_samples: 1,
            max_depth: MaxDepth(5),
            only_last_bounce: false,
            seed: 7,
            replicates,
            reuse: 1,
        };
        let (pixels, counts) = picture(&self.scene, &self.camera, settings, SIZE, samples);
        assert_eq!(counts.invalid_samples, 0, "{}", self.name);
        pixels
    }

    /// The reference's squared error over ours: both path trace, so their errors lie in the same
    /// places.
    fn noise_ratio(&self, pixels: &[PixelStats]) -> f64 {
        let relative = |pixel: &PixelStats| {
            let (mean, n) = (pixel.mean(), f64::from(pixel.count()));
            let variance = pixel.variance()?;
            let of_channel = |c: usize| variance[c] / n / (mean[c] * mean[c] + 0.01);
            Some((0..3).map(of_channel).sum::<f64>() / 3.0)
        };
        let own = pixels.iter().filter_map(relative).sum::<f64>();
        self.noise / (own / pixels.len() as f64)
    }

    /// The means over `places` of ours and of the reference, and the squared standard error of
    /// their difference.
    fn means(&self, pixels: &[PixelStats], places: &[usize], c: usize) -> (f64, f64, f64) {
        let n = places.len() as f64;
        let ours = places.iter().map(|&i| pixels[i].mean()[c]).sum::<f64>() / n;
        let theirs = self.picture.pixels();
        let theirs = places.iter().map(|&i| f64::from(theirs[i][c])).sum::<f64>() / n;
        let squared_error = |i: &usize| {
            let pixel = &pixels[*i];
            pixel.variance().map_or(0.0, |v| v[c]) / f64::from(pixel.count())
        };
        let own_error = places.iter().map(squared_error).sum::<f64>() / (n * n);
        (ours, theirs, own_error * (1.0 + self.noise_ratio(pixels)))
    }

    /// Complaints about the whole picture and its blocks.
    fn differences(&self, what: &str, pixels: &[PixelStats]) -> Vec<String> {
        let mut complaints = Vec::new();
        let mut check = |place: String, (ours, theirs, squared_error): (f64, f64, f64), score| {
            let error = squared_error.sqrt();
            if (ours - theirs).abs() > TOLERANCE * theirs + score * error + 1e-6 {
                let name = self.name;
                complaints.push(format!(
                    "{name} {what} {place}: {ours} ± {error}, should be {theirs}"
                ));
            }
        };
        let everywhere: Vec<usize> = (0..pixels.len()).collect();
        for c in 0..3 {
            let whole = self.means(pixels, &everywhere, c);
            check(format!("whole channel {c}"), whole, 3.0);
            let blocks: Vec<_> = (0..ROWS * COLUMNS)
                .map(|block| self.means(pixels, &pixels_of(block), c))
                .collect();
            for (number, &(ours, theirs, error)) in blocks.iter().enumerate() {
                // A block that by chance never saw its rare bright paths learns from those around.
                let around = neighbours(number);
                let usual = around.iter().map(|&i| blocks[i].2).sum::<f64>() / around.len() as f64;
                let (x, y) = (number % COLUMNS * BLOCK, number / COLUMNS * BLOCK);
                let place = format!("block at {x} {y} channel {c}");
                check(place, (ours, theirs, error.max(usual)), BLOCK_SCORE);
            }
        }
        complaints
    }

    /// relMSE without the reference's part of it.
    fn error(&self, pixels: &[Rgb]) -> f64 {
        let image = Image::from_pixels(SIZE.0 as usize, SIZE.1 as usize, pixels.to_vec());
        compare(&image, &self.picture).expect("equal sizes").rel_mse - self.noise
    }
}

/// The pixels of block number `block`.
fn pixels_of(block: usize) -> Vec<usize> {
    let (x, y) = (block % COLUMNS * BLOCK, block / COLUMNS * BLOCK);
    let row = |y: usize| (y * SIZE.0 as usize + x)..(y * SIZE.0 as usize + x + BLOCK);
    (y..y + BLOCK).flat_map(row).collect()
}

/// The blocks at most four rows and columns away.
fn neighbours(block: usize) -> Vec<usize> {
    let (column, row) = (block % COLUMNS, block / COLUMNS);
    let near = |at: usize, end: usize| at.saturating_sub(4)..(at + 5).min(end);
    near(row, ROWS)
        .flat_map(|y| near(column, COLUMNS).map(move |x| y * COLUMNS + x))
        .collect()
}

#[expect(
    clippy::print_stdout,
    reason = "the means are worth reading in the slow tier"
)]
fn check(name: &'static str, mode: Mode, samples: u32) -> Vec<String> {
    let Some(reference) = reference(name) else {
        return Vec::new();
    };
    // Each sample a replicate: independent, as the standard errors take them to be.
    let pixels = reference.render(mode, (0, samples), samples);
    let everywhere: Vec<usize> = (0..pixels.len()).collect();
    let (ours, theirs, squared_error) = reference.means(&pixels, &everywhere, 1);
    let error = squared_error.sqrt();
    println!("{name} {mode:?}: green {ours:.6} ± {error:.6}, reference {theirs:.6}");
    reference.differences(mode.name(), &pixels)
}

fn assert_none(complaints: &[String]) {
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn empty_box() {
    assert_none(&check("cb_empty", Mode::Best, 8));
}

#[test]
fn spheres() {
    assert_none(&check("cb_spheres", Mode::Best, 8));
}

#[test]
fn glass_and_mirror() {
    assert_none(&check("glass_mirror", Mode::Best, 8));
}

#[test]
fn open_sky() {
    assert_none(&check("open_sky", Mode::Best, 8));
}

#[test]
#[ignore = "minutes"]
fn all_scenes_in_every_mode() {
    let mut complaints = Vec::new();
    for name in SCENES {
        for mode in Mode::ALL {
            let samples = match (name, mode) {
                // Hundreds of directions or lights at every vertex.
                ("many_lights", Mode::Hemisphere | Mode::Importance) => 2,
                (_, Mode::Hemisphere) => 64,
                _ => 48,
            };
            complaints.extend(check(name, mode, samples));
        }
    }
    assert_none(&complaints);
}

/// An error that falls more slowly than 1 / samples is a bias.
#[test]
#[ignore = "minutes"]
fn error_falls_as_one_over_samples() {
    let mut complaints = Vec::new();
    for name in SCENES {
        let Some(reference) = reference(name) else {
            continue;
        };
        let few = reference.render(Mode::Best, (0, 16), 1);
        let more = reference.render(Mode::Best, (16, 240), 1);
        let few: Vec<Rgb> = few.iter().map(PixelStats::radiance).collect();
        let all: Vec<Rgb> = few
            .iter()
            .zip(&more)
            .map(|(&few, more)| (few + 15.0 * more.radiance()) / 16.0)
            .collect();
        let (before, after) = (reference.error(&few), reference.error(&all));
        let slope = (after / before).ln() / 16_f64.ln();
        println!("{name}: relMSE {before:.3e} at 16, {after:.3e} at 256, slope {slope:.3}");
        if slope > -0.92 {
            complaints.push(format!("{name}: slope {slope}"));
        }
    }
    assert_none(&complaints);
}
