//! What a headless render tells when it is done.

use std::io::Write;

use anyhow::Context;
use serde::Serialize;
use softbox::math::Isa;
use softbox::scene::Scene;
use softbox::session::{SessionStatus, Snapshot, TreeState};

use crate::exit::{Failure, Status};
use crate::job::Job;
use crate::values::name_of;

/// What is known at the end.
pub(crate) struct Facts<'a> {
    pub(crate) job: &'a Job,
    pub(crate) scene: &'a Scene,
    pub(crate) load_seconds: f64,
    pub(crate) status: &'a SessionStatus,
    pub(crate) snapshot: &'a Snapshot,
}

/// The object that `render --json` prints; scripts rely on the names.
#[derive(Serialize)]
struct Report<'a> {
    scene: &'a str,
    width: u32,
    height: u32,
    spp_mean: f64,
    spp_max: u32,
    threads: usize,
    /// The instruction set that was used.
    isa: Isa,
    seed: u64,
    mode: &'a str,
    max_depth: String,
    load_seconds: f64,
    build_seconds: f64,
    bvh_quality: String,
    /// Time that the better tree took beside the render; null when it never came into use.
    refine_seconds: Option<f64>,
    render_seconds: f64,
    cpu_seconds: f64,
    camera_rays: u64,
    closest_rays: u64,
    shadow_rays: u64,
    samples_per_second: f64,
    peak_memory_bytes: Option<u64>,
    invalid_samples: u64,
    estimated_relative_error: Option<f64>,
    skips: Skips,
}

/// Work that was left out because it could not change the picture.
#[derive(Serialize)]
struct Skips {
    shadow_rays_facing_away: u64,
}

impl Facts<'_> {
    /// One line for people.
    pub(crate) fn summary(&self) -> String {
        let counts = &self.status.counts;
        let rays = counts.closest_rays + counts.shadow_rays;
        let seconds = self.status.seconds.max(1e-9);
        let invalid = match counts.invalid_samples {
            0 => String::new(),
            n => format!(", {n} invalid samples dropped"),
        };
        format!(
            "{}: {:.1} samples per pixel in {:.2} s (loaded in {:.2} s, built in {:.2} s), {rays} rays, {:.2} million rays per second{invalid}",
            self.scene.name,
            self.snapshot.samples_mean,
            self.status.seconds,
            self.load_seconds,
            self.status.build_seconds,
            rays as f64 / seconds * 1e-6,
        )
    }
}

/// Prints the facts as one JSON object on standard output.
pub(crate) fn print_json(facts: &Facts<'_>) -> Result<(), Failure> {
    let (settings, counts) = (&facts.job.settings, &facts.status.counts);
    let report = Report {
        scene: &facts.scene.name,
        width: settings.width,
        height: settings.height,
        spp_mean: facts.snapshot.samples_mean,
        spp_max: facts.snapshot.samples_max,
        threads: settings.thread_count(),
        isa: settings.instruction_set(),
        seed: settings.seed,
        mode: settings.mode.name(),
        max_depth: settings.max_depth.to_string(),
        load_seconds: facts.load_seconds,
        build_seconds: facts.status.build_seconds,
        bvh_quality: name_of(settings.bvh.quality),
        refine_seconds: match facts.status.tree {
            TreeState::Refined { seconds } => Some(seconds),
            _ => None,
        },
        render_seconds: facts.status.seconds,
        cpu_seconds: cpu_seconds(),
        camera_rays: counts.camera_rays,
        closest_rays: counts.closest_rays,
        shadow_rays: counts.shadow_rays,
        samples_per_second: facts.status.samples_per_second,
        peak_memory_bytes: peak_memory_bytes(),
        invalid_samples: counts.invalid_samples,
        estimated_relative_error: facts.snapshot.relative_error,
        skips: Skips {
            shadow_rays_facing_away: counts.culled_shadow_rays,
        },
    };
    let print = || -> std::io::Result<()> {
        let mut out = std::io::stdout().lock();
        serde_json::to_writer_pretty(&mut out, &report)?;
        writeln!(out)
    };
    print()
        .context("Cannot write to standard output")
        .map_err(Status::Failed.because())
}

/// Processor time of the whole process so far, user and system.
fn cpu_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// Largest resident memory of the process so far, where the system tells.
fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}
