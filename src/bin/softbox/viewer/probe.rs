//! Measures how fluent the window is, for `--measure-fluency`: frame intervals while rendering
//! without end, time from a new camera to its picture while dragging, and the processor time of a
//! held render.

use std::collections::VecDeque;
use std::io::Write;
use std::time::{Duration, Instant};

use eframe::egui::{Context, ViewportCommand};
use glam::DVec3;
use rustix::time::{ClockId, clock_gettime};
use softbox::camera::Camera;

use super::document::Document;
use super::engine::Engine;

/// Length of one phase.
const PHASE: Duration = Duration::from_secs(5);
/// One step of the drag, as a fraction of the distance to the target.
const STEP: f64 = 0.002;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    WarmUp,
    Still,
    Drag,
    Settle,
    Held,
}

impl Phase {
    fn length(self) -> Duration {
        if self == Self::Settle {
            Duration::from_secs(1)
        } else {
            PHASE
        }
    }
}

/// A run of the phases, one after the other.
#[derive(Debug)]
pub(super) struct Probe {
    phase: Phase,
    since: Instant,
    last_frame: Option<Instant>,
    intervals: Vec<f64>,
    /// Cameras that were asked for and not seen yet, oldest first.
    asked: VecDeque<(Camera, Instant)>,
    latencies: Vec<f64>,
    frames: u32,
    processor_seconds: f64,
}

impl Probe {
    /// A probe that begins with the next frame.
    pub(super) fn new() -> Self {
        Self {
            phase: Phase::WarmUp,
            since: Instant::now(),
            last_frame: None,
            intervals: Vec::new(),
            asked: VecDeque::new(),
            latencies: Vec::new(),
            frames: 0,
            processor_seconds: 0.0,
        }
    }

    /// To be called once a frame, after the newest picture (of the camera `shown`) was taken.
    pub(super) fn frame(
        &mut self,
        ctx: &Context,
        document: &mut Document,
        engine: &Engine,
        shown: Option<Camera>,
    ) {
        let now = Instant::now();
        self.frames += 1;
        if let Some(last) = self.last_frame.replace(now) {
            self.intervals.push((now - last).as_secs_f64() * 1e3);
        }
        self.see(shown, now);
        match self.phase {
            Phase::Drag => {
                let camera = &mut document.camera;
                let arm = camera.eye - camera.target;
                camera.eye += DVec3::Y.cross(arm) * STEP;
                self.asked.push_back((*camera, now));
                ctx.request_repaint();
            }
            Phase::Still => ctx.request_repaint(),
            Phase::WarmUp | Phase::Settle | Phase::Held => {
                ctx.request_repaint_after(self.phase.length().saturating_sub(now - self.since));
            }
        }
        if now - self.since >= self.phase.length() {
            self.end_phase(ctx, engine, now);
        }
    }

    /// Takes note of all cameras up to the one that is shown.
    fn see(&mut self, shown: Option<Camera>, now: Instant) {
        let Some(at) = self
            .asked
            .iter()
            .position(|(camera, _)| Some(*camera) == shown)
        else {
            return;
        };
        let (_, asked) = self.asked[at];
        self.latencies.push((now - asked).as_secs_f64() * 1e3);
        self.asked.drain(..=at);
    }

    fn end_phase(&mut self, ctx: &Context, engine: &Engine, now: Instant) {
        match self.phase {
            Phase::WarmUp => self.phase = Phase::Still,
            Phase::Still => {
                say(&format!(
                    "rendering: frame interval {}",
                    Spread::of(&mut self.intervals)
                ));
                self.phase = Phase::Drag;
            }
            Phase::Drag => {
                say(&format!(
                    "dragging: frame interval {}",
                    Spread::of(&mut self.intervals)
                ));
                say(&format!(
                    "dragging: camera to its picture {}",
                    Spread::of(&mut self.latencies)
                ));
                engine.toggle_pause();
                self.phase = Phase::Settle;
            }
            Phase::Settle => self.phase = Phase::Held,
            Phase::Held => {
                let share = (processor_seconds() - self.processor_seconds)
                    / (now - self.since).as_secs_f64();
                say(&format!(
                    "held: {:.2} % of one processor, {} frames",
                    100.0 * share,
                    self.frames
                ));
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
        }
        self.since = now;
        self.last_frame = None;
        self.frames = 0;
        self.intervals.clear();
        self.processor_seconds = processor_seconds();
    }
}

/// Processor time of the whole process so far.
fn processor_seconds() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

fn say(line: &str) {
    // A closed standard error is no reason to stop.
    let _ = writeln!(std::io::stderr().lock(), "softbox: {line}");
}

/// Median and tail of some milliseconds.
struct Spread {
    count: usize,
    median: f64,
    p95: f64,
    most: f64,
}

impl Spread {
    fn of(values: &mut [f64]) -> Self {
        values.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let last = values.len().saturating_sub(1) as f64;
            values
                .get((last * share).round() as usize)
                .copied()
                .unwrap_or(f64::NAN)
        };
        Self {
            count: values.len(),
            median: at(0.5),
            p95: at(0.95),
            most: at(1.0),
        }
    }
}

impl std::fmt::Display for Spread {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            count,
            median,
            p95,
            most,
        } = self;
        write!(
            f,
            "median {median:.1} ms, p95 {p95:.1} ms, longest {most:.1} ms ({count} of them)"
        )
    }
}
