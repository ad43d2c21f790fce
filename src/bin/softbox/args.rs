use std::ffi::{OsStr, OsString};
use std::path::PathBuf;

use clap::error::ErrorKind;
use clap::{Args, CommandFactory, Parser, Subcommand};
use softbox::settings::RenderSettings;

use crate::bench_args::{self, BenchArgs};
use crate::course_args::CourseArgs;
use crate::isa;
use crate::job::Job;
use crate::ray_bench::Protocol;
use crate::settings_args::{SettingsArgs, StopArgs};

/// Samples of `render` when no rule to stop is given.
const DEFAULT_SPP: u32 = 64;

/// The name of `bench --rays` inside the parser.
const RAYS: &str = "bench-rays";

const EXAMPLES: &str = "\
Examples:
  softbox scene.dae                                     look at a scene
  softbox render scene.dae -o a.png -o a.exr --spp 256  write two files
  softbox render scene.dae -o a.png --time-limit 60     render for a minute
  softbox -t 8 -s 64 -l 32 -m 6 -f a.png -r 480 360 scene.dae
                                                        a command line of the course
  softbox compare a.exr reference.exr --json            how far apart two pictures are
  softbox bench cornell-spheres --compare best,hemisphere
                                                        error against time, two estimators

Exit status: 0 done, 1 failed, 2 wrong usage, 3 scene not readable, 4 output not writable,
5 mismatch, 130 interrupted after writing what there is.";

/// What the command line asks for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Request {
    /// Open the window.
    View(Job, WindowArgs),
    /// Render into files.
    Render(Job, Reporting),
    /// Tell what a scene holds.
    Info(InfoArgs),
    /// Compare two pictures.
    Compare(CompareArgs),
    /// Measure error against time.
    Bench(Box<BenchArgs>),
    /// Measure the tracer.
    BenchRays(RaysArgs),
}

/// A path tracer for the CPU: in a window, or headless.
#[derive(Parser, Debug)]
#[command(name = "softbox", version, after_help = EXAMPLES, args_conflicts_with_subcommands = true)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    plain: PlainArgs,
}

#[derive(Subcommand, Debug)]
enum Command {
    /// Render a scene into files, without a window
    Render(Box<RenderArgs>),
    /// Tell what a scene file holds
    Info(InfoArgs),
    /// Compare a picture with a reference, on linear data
    Compare(CompareArgs),
    /// Measure error against time, or with --rays how fast rays are traced
    ///
    /// Each mode renders each scene with several seeds, all taking turns; at every number of samples
    /// the picture so far is scored against a reference. Errors are relMSE, the mean of
    /// (x - r)^2 / (r^2 + 0.01), without clamping; efficiency is 1 / (relMSE x processor seconds).
    #[command(mut_arg("size", |size| size.help(bench_args::SIZE_HELP)))]
    Bench(Box<BenchArgs>),
    /// Measure how fast scenes are built and rays are traced
    #[command(name = RAYS, hide = true, bin_name = "softbox bench --rays")]
    BenchRays(RaysArgs),
}

/// Without a subcommand: the window, or with -f the course's form.
#[derive(Args, Debug)]
struct PlainArgs {
    /// The scene to look at; without one, the built-in scene
    scene: Option<PathBuf>,
    #[command(flatten)]
    course: CourseArgs,
    #[command(flatten)]
    settings: SettingsArgs,
    #[command(flatten)]
    stop: StopArgs,
    #[command(flatten)]
    reporting: Reporting,
    #[command(flatten)]
    window: WindowArgs,
}

#[derive(Args, Debug)]
struct RenderArgs {
    /// The scene to render
    scene: PathBuf,
    /// File to write: .png, .exr, .hdr or .pfm; may be repeated. An existing file is replaced
    /// only as a whole, at the end
    #[arg(short = 'o', long, value_name = "OUT", required = true)]
    output: Vec<PathBuf>,
    /// Also write the picture of the sampling rate
    #[arg(long, value_name = "OUT")]
    rate_picture: Option<PathBuf>,
    #[command(flatten)]
    settings: SettingsArgs,
    #[command(flatten)]
    stop: StopArgs,
    #[command(flatten)]
    reporting: Reporting,
}

/// Options of the window itself.
#[derive(Args, Clone, Debug, Default, PartialEq)]
pub(crate) struct WindowArgs {
    /// Graphics interface of the window: glow or wgpu; the other one if it fails
    #[arg(long, value_name = "NAME", value_parser = ["glow", "wgpu"])]
    pub(crate) renderer: Option<String>,
    /// Meaning of the Space key: standard pauses, cs184 resets the camera as in the course
    #[arg(long, value_name = "PRESET", value_parser = ["standard", "cs184"])]
    pub(crate) keys: Option<String>,
    /// Close the window after this time
    #[arg(long, value_name = "SECONDS")]
    pub(crate) exit_after: Option<f64>,
    /// Write a line of state to standard error whenever something changes in the window
    #[arg(long)]
    pub(crate) log_events: bool,
    /// Measure for 20 seconds how fluent the window is, print the figures and close it
    #[arg(long)]
    pub(crate) measure_fluency: bool,
}

/// How a headless run speaks. Results go to standard output, all else to standard error.
#[derive(Args, Clone, Debug, Default, PartialEq)]
pub(crate) struct Reporting {
    /// Print one JSON object on standard output
    #[arg(long)]
    pub(crate) json: bool,
    /// Show no progress and no messages, only errors
    #[arg(short = 'q', long)]
    pub(crate) quiet: bool,
    /// Show no progress
    #[arg(long)]
    pub(crate) no_progress: bool,
    /// Say more; progress as lines when standard error is no terminal
    #[arg(short = 'v', long, conflicts_with = "quiet")]
    pub(crate) verbose: bool,
}

/// `softbox info`.
#[derive(Args, Clone, Debug, PartialEq)]
pub(crate) struct InfoArgs {
    /// The scene
    pub(crate) scene: PathBuf,
    /// Print one JSON object on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

/// `softbox compare`.
#[derive(Args, Clone, Debug, PartialEq)]
pub(crate) struct CompareArgs {
    /// The picture: .exr, .hdr or .pfm
    pub(crate) image: PathBuf,
    /// What it should look like
    pub(crate) reference: PathBuf,
    /// Print one JSON object on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

/// `softbox bench --rays`.
#[derive(Args, Clone, Debug, PartialEq)]
pub(crate) struct RaysArgs {
    /// Measure build time and rays per second
    #[arg(long, required = true)]
    rays: bool,
    /// Generated scenes (box36, ico10k, knot70k, dragon100k, slivers, city, ico1m, stadium, knot5m)
    /// or scene files; without any, all the generated ones
    #[arg(value_name = "SCENE")]
    pub(crate) scenes: Vec<String>,
    #[command(flatten)]
    pub(crate) protocol: Protocol,
    /// Print one JSON array on standard output, an object for each scene
    #[arg(long)]
    pub(crate) json: bool,
}

/// Reads a command line, its first word being the program's name; `isa` is the value of
/// [`isa::VARIABLE`].
///
/// # Errors
/// For wrong usage, and to show help or version; `exit` of the error does the right thing.
pub(crate) fn parse(
    words: impl IntoIterator<Item = impl Into<OsString> + Clone>,
    isa: Option<&OsStr>,
) -> Result<Request, clap::Error> {
    let cli = Cli::try_parse_from(with_rays(words.into_iter().map(Into::into).collect()))?;
    let request = match cli.command {
        Some(Command::Render(args)) => render_request(*args),
        Some(Command::Info(args)) => Ok(Request::Info(args)),
        Some(Command::Compare(args)) => Ok(Request::Compare(args)),
        Some(Command::Bench(args)) => args.checked().map(Request::Bench),
        Some(Command::BenchRays(args)) => Ok(Request::BenchRays(args)),
        None => plain_request(cli.plain),
    };
    request
        .and_then(|request| request.with_variable(isa))
        .map_err(|message| Cli::command().error(ErrorKind::ValueValidation, message))
}

/// `bench --rays` is a command of its own, with other options than `bench`.
fn with_rays(mut words: Vec<OsString>) -> Vec<OsString> {
    let is_bench = words.get(1).is_some_and(|word| word == "bench");
    if is_bench && words.iter().any(|word| word == "--rays") {
        words[1] = RAYS.into();
    }
    words
}

impl Request {
    /// With the instruction set that `variable` forces, unless an option does.
    fn with_variable(mut self, variable: Option<&OsStr>) -> Result<Self, String> {
        let isa = match &mut self {
            Self::View(job, _) | Self::Render(job, _) => &mut job.settings.isa,
            Self::Bench(args) => &mut args.settings.isa,
            Self::BenchRays(args) => &mut args.protocol.isa,
            Self::Info(_) | Self::Compare(_) => return Ok(self),
        };
        *isa = isa::forced(*isa, variable)?;
        Ok(self)
    }
}

fn plain_request(args: PlainArgs) -> Result<Request, String> {
    let job = args.course.job(args.scene, &args.settings, &args.stop)?;
    check_region(&job.settings)?;
    if args.course.is_headless() {
        Ok(Request::Render(job, args.reporting))
    } else {
        Ok(Request::View(job, args.window))
    }
}

fn render_request(args: RenderArgs) -> Result<Request, String> {
    let mut settings = args.settings.apply(RenderSettings::default());
    settings.stop = args.stop.apply(settings.stop);
    let stop = &mut settings.stop;
    if stop.seconds.is_none() && stop.relative_error.is_none() {
        stop.samples_per_pixel = stop.samples_per_pixel.or(Some(DEFAULT_SPP));
    }
    check_region(&settings)?;
    let job = Job {
        scene: Some(args.scene),
        outputs: args.output,
        rate_picture: args.rate_picture,
        settings,
        camera: args.settings.camera(false),
        display: args.settings.display(),
        environment: args.settings.environment,
    };
    Ok(Request::Render(job, args.reporting))
}

pub(crate) fn check_region(settings: &RenderSettings) -> Result<(), String> {
    let (width, height) = (settings.width, settings.height);
    match settings.region {
        Some(region) if region.clipped(width, height).is_none() => Err(format!(
            "the region lies outside of the picture of {width}x{height} pixels"
        )),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests;
