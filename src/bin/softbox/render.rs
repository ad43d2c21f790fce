//! Rendering without a window.

#[cfg(feature = "viewer")]
use std::fs::File;
use std::io::Write;
#[cfg(feature = "viewer")]
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

#[cfg(feature = "viewer")]
use anyhow::Context;
use anyhow::anyhow;
use softbox::io::picture::{PictureFormat, check_writable, write_linear, write_png};
use softbox::session::{RenderJob, RenderSession, SessionOptions, SessionStatus, Snapshot};
use softbox::settings::{AdaptiveGoal, RenderSettings, StopRule, View};

use crate::args::Reporting;
use crate::command_line::command_line;
use crate::exit::{Failure, Status};
use crate::interrupt;
use crate::job::Job;
use crate::open::open;
use crate::place_camera::place_camera;
use crate::progress::{Progress, Standing};
use crate::provenance::metadata;
use crate::report::{Facts, print_json};
use crate::shown::{shown_bytes, shown_numbers};

/// How often the session is looked at when it says nothing.
const POLL: Duration = Duration::from_millis(100);

/// Renders a job into its files.
pub(crate) fn run(job: &Job, reporting: &Reporting) -> Result<(), Failure> {
    check_outputs(job)?;
    let messages = Messages { reporting };
    if reporting.verbose {
        messages.say(&command_line(job))?;
    }
    let started = Instant::now();
    let loaded = open(job)?;
    let load_seconds = started.elapsed().as_secs_f64();
    for note in loaded
        .report
        .notes
        .iter()
        .filter(|note| note.severity >= softbox::io::Severity::Dropped)
    {
        messages.say(&note.to_string())?;
    }
    if loaded.scene.environment.is_added {
        messages
            .say("The scene has no light: a soft sky was added, which is not part of the scene.")?;
    }
    let scene = Arc::new(loaded.scene);
    let settings = job.settings.clone();
    let camera = place_camera(&job.camera, &scene, [settings.width, settings.height])
        .map_err(Status::Failed.because())?;
    if !camera.is_valid() {
        return Err(Status::Usage.because()(anyhow!(
            "The camera cannot see: eye and target must differ, all numbers be finite, and the angle lie between 0 and 180 degrees."
        )));
    }
    let order = RenderJob {
        scene: Arc::clone(&scene),
        camera,
        settings,
    };
    let outcome = render(order, &mut Progress::on_stderr(reporting))?;
    write_outputs(job, &scene, &outcome.snapshot)?;
    let facts = Facts {
        job,
        scene: &scene,
        load_seconds,
        status: &outcome.status,
        snapshot: &outcome.snapshot,
    };
    if reporting.json {
        print_json(&facts)?;
    } else {
        messages.say(&facts.summary())?;
    }
    if outcome.is_interrupted {
        return Err(Status::Interrupted.because()(anyhow!(
            "Interrupted; what there was is written."
        )));
    }
    Ok(())
}

/// Lines on standard error, unless the run is quiet.
struct Messages<'a> {
    reporting: &'a Reporting,
}

impl Messages<'_> {
    fn say(&self, line: &str) -> Result<(), Failure> {
        if self.reporting.quiet {
            return Ok(());
        }
        writeln!(std::io::stderr().lock(), "{line}").map_err(Status::Failed.because())
    }
}

struct Outcome {
    snapshot: Arc<Snapshot>,
    status: SessionStatus,
    is_interrupted: bool,
}

/// Renders until the stop rule ends it or Ctrl+C is pressed.
fn render(job: RenderJob, progress: &mut Progress<std::io::Stderr>) -> Result<Outcome, Failure> {
    let (wake, woken) = channel();
    let on_interrupt = wake.clone();
    let interrupted = interrupt::on_interrupt(move || {
        // The receiver lives as long as the render.
        let _ = on_interrupt.send(());
    })?;
    let session = RenderSession::new(SessionOptions { interactive: false }, move || {
        let _ = wake.send(());
    });
    let settings = job.settings.clone();
    session.request(job);
    loop {
        match woken.recv_timeout(POLL) {
            Ok(()) | Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(Status::Failed.because()(anyhow!("The render broke off.")));
            }
        }
        let status = session.status();
        let is_interrupted = interrupted.load(Ordering::Relaxed);
        if is_interrupted && !session.is_paused() {
            session.pause();
            continue;
        }
        if let Some(message) = status.message {
            return Err(Status::Failed.because()(anyhow!(message)));
        }
        progress.update(&standing(&status, &settings));
        let has_ended = status.is_finished() || (is_interrupted && status.is_held());
        if let Some(snapshot) = session.snapshot().filter(|_| has_ended) {
            progress.finish();
            return Ok(Outcome {
                snapshot,
                status: session.status(),
                is_interrupted,
            });
        }
        if is_interrupted && status.samples_mean == 0.0 && status.is_held() {
            return Err(Status::Interrupted.because()(anyhow!(
                "Interrupted before there was a picture."
            )));
        }
    }
}

fn standing(status: &SessionStatus, settings: &RenderSettings) -> Standing {
    let stop = &settings.stop;
    let by_samples = stop
        .samples_per_pixel
        .map(|n| status.samples_mean / f64::from(n.max(1)));
    let by_seconds = stop.seconds.map(|limit| status.seconds / limit);
    // The error falls with the root of the number of samples.
    let by_error = stop
        .relative_error
        .zip(status.relative_error)
        .map(|(aim, error)| (aim / error).powi(2));
    let fraction = [by_samples, by_seconds, by_error]
        .into_iter()
        .flatten()
        .reduce(f64::max);
    Standing {
        samples: status.samples_mean,
        target_samples: stop.samples_per_pixel,
        fraction: fraction.map(|f| f.clamp(0.0, 1.0)),
        seconds: status.seconds,
        relative_error: status.relative_error,
        seconds_left: status.eta_seconds,
    }
}

fn write_outputs(
    job: &Job,
    scene: &softbox::scene::Scene,
    snapshot: &Snapshot,
) -> Result<(), Failure> {
    let (width, height) = (snapshot.width, snapshot.height);
    let text = metadata(
        snapshot,
        &job.display,
        (&scene.name, scene.path.as_deref()),
        &command_line(&repeatable(job, snapshot)),
    );
    for output in &job.outputs {
        let written = match PictureFormat::from_path(output) {
            Some(format) if format.is_linear() => {
                write_linear(output, width, height, &snapshot.pixels, &text)
            }
            _ => write_png(
                output,
                width,
                height,
                &shown_bytes(snapshot, &job.display),
                &text,
            ),
        };
        written.map_err(Status::Output.because())?;
    }
    if let Some(output) = &job.rate_picture {
        let Some((values, legend)) = shown_numbers(snapshot, View::Samples) else {
            return Ok(());
        };
        let bytes = softbox::display::false_color(&values, legend.map, legend.range);
        write_png(output, width, height, &bytes, &text).map_err(Status::Output.because())?;
    }
    Ok(())
}

/// The job that ends where this picture ended: after its samples, not after a time that depends on
/// the machine, an estimate or Ctrl+C. Least error has no such number and keeps its rule.
fn repeatable(job: &Job, snapshot: &Snapshot) -> Job {
    let mut job = job.clone();
    let goal = job.settings.adaptive.map(|adaptive| adaptive.goal);
    let is_counted = goal != Some(AdaptiveGoal::LeastError) && !job.settings.view.is_first_hit();
    if is_counted {
        job.settings.stop = StopRule {
            samples_per_pixel: Some(snapshot.samples_max),
            ..StopRule::default()
        };
    }
    job
}

/// Finds outputs that cannot be written before any time is spent on the picture.
fn check_outputs(job: &Job) -> Result<(), Failure> {
    for output in job.outputs.iter().chain(&job.rate_picture) {
        check_writable(output).map_err(Status::Output.because())?;
    }
    Ok(())
}

/// Finds scene files that cannot be opened, before there is a window.
#[cfg(feature = "viewer")]
pub(crate) fn check_readable(scene: &Path) -> Result<(), Failure> {
    let is_folder = scene.is_dir();
    let opened = File::open(scene).map_err(anyhow::Error::from);
    let opened = opened.and_then(|_| match is_folder {
        true => Err(anyhow!("it is a folder")),
        false => Ok(()),
    });
    opened
        .with_context(|| format!("Cannot read the scene '{}'", scene.display()))
        .map_err(Status::Scene.because())
}
