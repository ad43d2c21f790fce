use softbox::math::Isa;
use softbox::settings::Mode;
use softbox::study::{LevelFigures, PowerLaw};

use super::plot;
use super::reference::ReferenceFacts;
use super::report::{Method, SceneReport};
use super::table;

fn level(samples_per_pixel: u32, rel_mse: f64) -> LevelFigures {
    let cpu_seconds = 0.1 * f64::from(samples_per_pixel);
    LevelFigures {
        samples_per_pixel,
        seeds: 5,
        cpu_seconds,
        wall_seconds: cpu_seconds,
        rays: 3e6,
        samples: 1e6,
        rel_mse,
        rel_mse_trimmed: rel_mse,
        mse: rel_mse,
        mean_ratio: 1.0,
        mean_ratio_interval: Some([0.99, 1.01]),
        efficiency: (rel_mse > 0.0).then(|| 1.0 / (rel_mse * cpu_seconds)),
        efficiency_interval: None,
    }
}

fn report(levels: Vec<LevelFigures>) -> SceneReport {
    SceneReport {
        scene: "box".to_owned(),
        width: 4,
        height: 3,
        max_depth: "5".to_owned(),
        threads: 1,
        isa: Isa::Portable,
        load_seconds: 0.0,
        build_seconds: 0.0,
        first_pass_seconds: 0.0,
        refine_seconds: 0.0,
        reference: ReferenceFacts {
            file: None,
            mode: Some(Mode::Importance.name()),
            samples_per_pixel: Some(64),
            rel_mse: 1e-4,
            agreement: Some(0.5),
            cpu_seconds: 1.0,
        },
        methods: vec![Method {
            mode: Mode::Best.name().to_owned(),
            levels,
            power_law: Some(PowerLaw {
                slope: -1.0,
                slope_error: Some(0.01),
                intercept: -3.0,
            }),
            seconds_to: Vec::new(),
        }],
        comparisons: Vec::new(),
        is_complete: true,
        command: "softbox bench box".to_owned(),
    }
}

/// Pixels of the first curve's colour within the columns of `part` of the width.
fn coloured(pixels: &[[u8; 3]], part: std::ops::Range<f64>) -> Vec<usize> {
    let (width, _) = plot::SIZE;
    let columns = (part.start * width as f64) as usize..(part.end * width as f64) as usize;
    let curve = |i: &usize| pixels[*i] == [0, 114, 178] && columns.contains(&(i % width));
    (0..pixels.len()).filter(curve).map(|i| i / width).collect()
}

#[test]
fn a_falling_curve_is_drawn_falling_between_its_axes() {
    let levels = vec![
        level(1, 0.1),
        level(4, 0.025),
        level(16, 0.0),
        level(64, 0.0015),
    ];
    let pixels = plot::draw(&[report(levels)]).unwrap();
    assert_eq!(pixels.len(), plot::SIZE.0 * plot::SIZE.1);
    let mean = |rows: Vec<usize>| rows.iter().sum::<usize>() / rows.len().max(1);
    let (left, right) = (coloured(&pixels, 0.1..0.3), coloured(&pixels, 0.75..0.97));
    assert!(left.len() > 100 && right.len() > 100);
    assert!(mean(left) + 200 < mean(right));
    // Letters and numbers beside the vertical axis and below the other one.
    let (width, height) = plot::SIZE;
    let dark = |i: &usize| pixels[*i].iter().all(|&c| c < 100);
    let at_left = (0..pixels.len()).filter(|i| i % width < 120).filter(dark);
    assert!(at_left.count() > 500);
    let below = (0..pixels.len())
        .filter(|i| i / width > height - 80)
        .filter(dark);
    assert!(below.count() > 500);
}

#[test]
fn nothing_to_draw_is_told() {
    let error = plot::draw(&[report(vec![level(1, -1.0)])]).unwrap_err();
    assert!(error.to_string().contains("no point"), "{error}");
}

#[test]
fn the_table_marks_what_cannot_be_believed() {
    let mut doubtful = report(vec![level(1, 0.1), level(4, -1e-6)]);
    let text = |report: &SceneReport| {
        let mut out = Vec::new();
        table::write(&mut out, report).unwrap();
        String::from_utf8(out).unwrap()
    };
    let told = text(&doubtful);
    assert!(told.contains("its halves agree (p = 0.50)"), "{told}");
    assert!(told.contains("below the reference's noise"), "{told}");
    assert!(told.contains("slope -1.000 ± 0.010"), "{told}");
    assert_eq!(doubtful.warning(), None);
    doubtful.reference.agreement = Some(1e-5);
    doubtful.is_complete = false;
    let told = text(&doubtful);
    assert!(
        told.contains("DO NOT AGREE") && told.contains("interrupted"),
        "{told}"
    );
    assert!(doubtful.warning().unwrap().contains("p = 1.0e-5"));
}
