//! How the picture is computed.

use eframe::egui::{self, DragValue, Slider, Ui};
use softbox::bvh::{BvhKind, BvhQuality, BvhSettings};
use softbox::settings::{
    Adaptive, AdaptiveGoal, IntegratorKind, MaxDepth, Mode, RenderSettings, Reuse,
};

use super::{choice, optional, row, section};
use crate::viewer::document::Resolution;

/// The deepest path that the slider reaches; beyond there is only "no limit".
const DEPTH_SLIDER: u32 = 100;
/// The depth that unticking "no limit" gives.
const DEPTH: u32 = 5;

/// The settings of the estimator.
pub(in crate::viewer) fn show(ui: &mut Ui, settings: &mut RenderSettings) {
    section(ui, "Render", true, |ui| {
        let help = "How direct light is estimated. All three converge to the same picture.";
        choice(
            ui,
            ("Mode", help),
            &mut settings.mode,
            &Mode::ALL,
            Mode::name,
        );
        row(
            ui,
            "Light samples",
            "Samples of each area light at every surface point.",
            Slider::new(&mut settings.light_samples, 1..=256).logarithmic(true),
        );
        depth(ui, &mut settings.max_depth);
        let help = "Pixels that share the indirect light they find, in mode best. Not biased; \
                    the noise of pixels that share is alike.";
        choice(
            ui,
            ("Reuse", help),
            &mut settings.reuse,
            &Reuse::ALL,
            Reuse::name,
        );
        row(
            ui,
            "Only last bounce",
            "Keep only the light that took exactly the largest number of bounces.",
            egui::Checkbox::without_text(&mut settings.only_last_bounce),
        );
        row(
            ui,
            "Course-compatible",
            "Repeat the picture of the course's program on purpose, with its errors.",
            egui::Checkbox::without_text(&mut settings.course_compatible),
        );
        adaptive(ui, &mut settings.adaptive);
        row(
            ui,
            "Seed",
            "The same seed gives the same picture, bit for bit.",
            DragValue::new(&mut settings.seed),
        );
    });
}

fn depth(ui: &mut Ui, depth: &mut MaxDepth) {
    let help = "Largest number of bounces at surfaces: 0 shows the lights alone, 1 direct light.";
    let name = ui.label("Bounces").on_hover_text(help);
    ui.horizontal(|ui| {
        ui.spacing_mut().slider_width = 74.0;
        let mut is_infinite = *depth == MaxDepth::INFINITE;
        if !is_infinite {
            ui.add(Slider::new(&mut depth.0, 0..=DEPTH_SLIDER).logarithmic(true))
                .labelled_by(name.id)
                .on_hover_text(help);
        }
        let help = "Paths end by chance alone.";
        if ui
            .checkbox(&mut is_infinite, "no limit")
            .on_hover_text(help)
            .changed()
        {
            *depth = if is_infinite {
                MaxDepth::INFINITE
            } else {
                MaxDepth(DEPTH)
            };
        }
    });
    ui.end_row();
}

fn adaptive(ui: &mut Ui, adaptive: &mut Option<Adaptive>) {
    let help = "Take more samples where they are needed. The number is the half width of the 95 % \
                confidence interval at which a pixel ends. Slightly biased.";
    let first = Adaptive {
        batch: 32,
        tolerance: 0.05,
        goal: AdaptiveGoal::default(),
        exposure: 0.0,
    };
    optional(ui, ("Adaptive", help), adaptive, first, |ui, adaptive| {
        let has_tolerance = adaptive.goal != AdaptiveGoal::LeastError;
        ui.add_enabled(
            has_tolerance,
            Slider::new(&mut adaptive.tolerance, 0.001..=1.0)
                .logarithmic(true)
                .custom_formatter(|value, _| format!("{:.1} %", value * 100.0))
                .custom_parser(parse_percent),
        )
        .accessible_name("Tolerance")
    });
    if let Some(adaptive) = adaptive {
        adaptive_details(ui, adaptive);
    }
}

fn adaptive_details(ui: &mut Ui, adaptive: &mut Adaptive) {
    let help = "Even quality ends each pixel when it and its neighbours are within the tolerance. \
                Least error spends the samples where they lessen the error of the picture most; \
                their limit is a mean. Course ends each pixel by itself, as the course's program.";
    choice(
        ui,
        ("   goal", help),
        &mut adaptive.goal,
        &AdaptiveGoal::ALL,
        |goal| match goal {
            AdaptiveGoal::Even => "even quality",
            AdaptiveGoal::LeastError => "least error",
            AdaptiveGoal::Course => "course",
        },
    );
    row(
        ui,
        "   batch",
        "Samples between two decisions.",
        DragValue::new(&mut adaptive.batch).range(2..=4096),
    );
    if adaptive.goal == AdaptiveGoal::Even {
        row(
            ui,
            "   dark exposure",
            "The exposure, in stops, at which noise in the dark must not be seen.",
            DragValue::new(&mut adaptive.exposure)
                .range(-20.0..=20.0)
                .speed(0.1),
        );
    }
}

/// A fraction from "5", "5%" or "5 %".
pub(super) fn parse_percent(text: &str) -> Option<f64> {
    let number: f64 = text.trim().trim_end_matches('%').trim().parse().ok()?;
    Some(number / 100.0)
}

/// The settings that change the work but not what is seen.
pub(in crate::viewer) fn machine(ui: &mut Ui, settings: &mut RenderSettings) {
    section(ui, "Machine", false, |ui| {
        let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let most = cores.max(settings.threads);
        row(
            ui,
            "Threads",
            "Worker threads; 0 uses all cores. Never changes the picture.",
            Slider::new(&mut settings.threads, 0..=most),
        );
        let kinds = [IntegratorKind::Wavefront, IntegratorKind::Reference];
        let help = "Wavefront is fast; reference follows one path at a time. Same random numbers.";
        choice(
            ui,
            ("Path tracer", help),
            &mut settings.integrator,
            &kinds,
            |kind| match kind {
                IntegratorKind::Wavefront => "wavefront",
                IntegratorKind::Reference => "reference",
            },
        );
        hierarchy(ui, &mut settings.bvh);
    });
}

fn hierarchy(ui: &mut Ui, bvh: &mut BvhSettings) {
    let kinds = [BvhKind::Sah, BvhKind::Median, BvhKind::None];
    let help = "How the tree of boxes is split; without one, every ray meets every primitive.";
    choice(
        ui,
        ("BVH", help),
        &mut bvh.kind,
        &kinds,
        |kind| match kind {
            BvhKind::None => "none",
            BvhKind::Median => "median",
            BvhKind::Sah => "surface area",
        },
    );
    let qualities = [BvhQuality::High, BvhQuality::Standard, BvhQuality::Fast];
    let help = "Effort for a tree split by surface area. High makes it better while the picture \
                renders. Never changes the picture.";
    choice(
        ui,
        ("BVH quality", help),
        &mut bvh.quality,
        &qualities,
        |quality| match quality {
            BvhQuality::Fast => "fast",
            BvhQuality::Standard => "standard",
            BvhQuality::High => "high",
        },
    );
    row(
        ui,
        "Leaf size",
        "Most primitives in one leaf of the tree. Two triangles that share an edge, a quad, are one.",
        Slider::new(&mut bvh.leaf_size, 1..=64).logarithmic(true),
    );
}

/// The size of the picture.
pub(in crate::viewer) fn size(
    ui: &mut Ui,
    settings: &mut RenderSettings,
    resolution: &mut Resolution,
) {
    section(ui, "Picture size", false, |ui| {
        let both = [Resolution::FollowWindow, Resolution::Fixed];
        choice(
            ui,
            ("Size", "Who chooses the size."),
            resolution,
            &both,
            |who| match who {
                Resolution::FollowWindow => "follows the window",
                Resolution::Fixed => "fixed",
            },
        );
        let is_fixed = *resolution == Resolution::Fixed;
        for (label, value) in [
            ("Width", &mut settings.width),
            ("Height", &mut settings.height),
        ] {
            let name = ui.label(label);
            ui.add_enabled(
                is_fixed,
                DragValue::new(value).range(1..=16_384).suffix(" px"),
            )
            .labelled_by(name.id);
            ui.end_row();
        }
    });
}
