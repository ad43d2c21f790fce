//! From a job back to the command line that renders its picture again.

use std::path::Path;

use glam::DVec3;
use softbox::display::{DisplaySettings, ToneCurve};
use softbox::settings::{AdaptiveGoal, CameraRule, RenderSettings};

use crate::job::{CameraChoice, FieldOfView, Job};
use crate::values::name_of;

/// The command line of a job, quoted for a POSIX shell: `softbox render …` when it has outputs, the
/// viewer's form otherwise.
///
/// What decides the look of every picture is always named, the rest where it differs from the
/// defaults, so that the line stays right when a default changes and short enough to read.
pub(crate) fn command_line(job: &Job) -> String {
    let words: Vec<String> = words(job).iter().map(|word| quoted(word)).collect();
    words.join(" ")
}

/// The words of [`command_line`], not quoted.
pub(crate) fn words(job: &Job) -> Vec<String> {
    let mut line = Line(vec!["softbox".to_owned()]);
    if !job.outputs.is_empty() {
        line.word("render");
    }
    if let Some(scene) = &job.scene {
        line.0.push(operand(scene));
    }
    for output in &job.outputs {
        line.option("-o", operand(output));
    }
    line.maybe("--rate-picture", job.rate_picture.as_deref().map(operand));
    add_settings(&mut line, &job.settings);
    add_adaptive(&mut line, &job.settings, job.display.exposure);
    add_camera(&mut line, &job.camera, job.settings.course_compatible);
    add_display(&mut line, &job.display, job.settings.course_compatible);
    line.maybe("--environment", job.environment.as_deref().map(operand));
    line.0
}

struct Line(Vec<String>);

impl Line {
    fn word(&mut self, word: &str) {
        self.0.push(word.to_owned());
    }

    fn flag(&mut self, name: &str, is_on: bool) {
        if is_on {
            self.word(name);
        }
    }

    fn option(&mut self, name: &str, value: impl ToString) {
        self.word(name);
        self.0.push(value.to_string());
    }

    fn maybe(&mut self, name: &str, value: Option<impl ToString>) {
        if let Some(value) = value {
            self.option(name, value);
        }
    }

    fn unless_default<T: PartialEq>(&mut self, name: &str, value: T, default: T, text: String) {
        if value != default {
            self.option(name, text);
        }
    }
}

fn add_settings(line: &mut Line, settings: &RenderSettings) {
    let s = settings;
    let d = RenderSettings::default();
    line.option("--size", format!("{}x{}", s.width, s.height));
    let region = s.region;
    line.maybe(
        "--region",
        region.map(|r| format!("{},{},{},{}", r.x, r.y, r.width, r.height)),
    );
    line.maybe("--spp", s.stop.samples_per_pixel);
    line.maybe("--time-limit", s.stop.seconds);
    line.maybe("--target-error", s.stop.relative_error);
    line.option("--mode", name_of(s.mode));
    line.unless_default("--reuse", s.reuse, d.reuse, s.reuse.to_string());
    line.option("--light-samples", s.light_samples);
    line.option("--max-depth", s.max_depth);
    line.option("--seed", s.seed);
    line.flag("--only-last-bounce", s.only_last_bounce);
    line.flag("--course-compatible", s.course_compatible);
    line.unless_default("--view", s.view, d.view, name_of(s.view));
    line.unless_default(
        "--integrator",
        s.integrator,
        d.integrator,
        name_of(s.integrator),
    );
    line.unless_default("--bvh", s.bvh.kind, d.bvh.kind, name_of(s.bvh.kind));
    let leaf_size = s.bvh.leaf_size;
    line.unless_default(
        "--leaf-size",
        leaf_size,
        d.bvh.leaf_size,
        leaf_size.to_string(),
    );
    let quality = s.bvh.quality;
    line.unless_default("--bvh-quality", quality, d.bvh.quality, name_of(quality));
    line.maybe("--isa", s.isa);
    line.unless_default("--threads", s.threads, d.threads, s.threads.to_string());
}

fn add_adaptive(line: &mut Line, settings: &RenderSettings, exposure: f32) {
    let Some(adaptive) = settings.adaptive else {
        return;
    };
    let numbers = format!("{},{}", adaptive.batch, adaptive.tolerance);
    line.option("--adaptive", numbers);
    let own = if settings.course_compatible {
        AdaptiveGoal::Course
    } else {
        AdaptiveGoal::default()
    };
    let goal = adaptive.goal;
    line.unless_default("--adaptive-goal", goal, own, name_of(goal));
    let (dark, text) = (adaptive.exposure, adaptive.exposure.to_string());
    line.unless_default("--adaptive-exposure", dark, exposure, text);
}

fn add_camera(line: &mut Line, camera: &CameraChoice, course_compatible: bool) {
    let point = |p: DVec3| format!("{},{},{}", p.x, p.y, p.z);
    line.maybe("--camera", camera.file.as_deref().map(operand));
    let own = if course_compatible {
        CameraRule::Course
    } else {
        CameraRule::Auto
    };
    line.unless_default("--camera-rule", camera.rule, own, name_of(camera.rule));
    line.maybe("--eye", camera.eye.map(point));
    line.maybe("--target", camera.target.map(point));
    line.maybe("--up", camera.up.map(point));
    match camera.fov {
        Some(FieldOfView::X(degrees)) => line.option("--xfov", degrees),
        Some(FieldOfView::Y(degrees)) => line.option("--yfov", degrees),
        None => {}
    }
    line.flag("--crop-view", camera.crops && !course_compatible);
    line.maybe("--lens-radius", camera.lens_radius);
    line.maybe("--focal-distance", camera.focal_distance);
}

fn add_display(line: &mut Line, display: &DisplaySettings, course_compatible: bool) {
    let exposure = display.exposure;
    line.unless_default("--exposure", exposure, 0.0, exposure.to_string());
    let own = if course_compatible {
        ToneCurve::Course
    } else {
        ToneCurve::default()
    };
    line.unless_default(
        "--tone-curve",
        display.tone_curve,
        own,
        name_of(display.tone_curve),
    );
}

/// A path as a word that is taken for neither an option nor a subcommand.
fn operand(path: &Path) -> String {
    let text = path.to_string_lossy();
    let is_subcommand = matches!(&*text, "render" | "info" | "compare" | "bench" | "help");
    if text.starts_with('-') || is_subcommand {
        format!("./{text}")
    } else {
        text.into_owned()
    }
}

/// A path as one word for a POSIX shell, taken for neither an option nor a subcommand.
pub(crate) fn word(path: &Path) -> String {
    quoted(&operand(path))
}

/// One word for a POSIX shell.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "_-./,:=+@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests;
