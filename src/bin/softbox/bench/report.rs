use serde::Serialize;
use softbox::math::Isa;
use softbox::study::{Curve, LevelFigures, PowerLaw, Reach, Verdict};

use super::reference::ReferenceFacts;
use crate::bench_args::BenchArgs;
use crate::command_line::command_line;
use crate::contender::Contender;
use crate::job::Job;

/// Errors that the seconds are told for.
pub(super) const TARGETS: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// What is known beside the curves.
pub(super) struct Facts<'a> {
    pub(super) job: &'a Job,
    pub(super) scene_name: &'a str,
    pub(super) load_seconds: f64,
    pub(super) build_seconds: f64,
    pub(super) first_pass_seconds: f64,
    pub(super) refine_seconds: f64,
    pub(super) reference: ReferenceFacts,
    pub(super) is_complete: bool,
}

/// The object that `bench --json` prints for each scene; scripts rely on the names.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct SceneReport {
    pub(super) scene: String,
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) max_depth: String,
    pub(super) threads: usize,
    pub(super) isa: Isa,
    pub(super) load_seconds: f64,
    pub(super) build_seconds: f64,
    /// One sample in each pixel by the first mode, on the wall, the very first one.
    pub(super) first_pass_seconds: f64,
    /// Making the hierarchy better after that, which is what the methods are measured with; 0 where it
    /// was as good at once, or no better one was asked for.
    pub(super) refine_seconds: f64,
    pub(super) reference: ReferenceFacts,
    pub(super) methods: Vec<Method>,
    /// The first method against each of the others.
    pub(super) comparisons: Vec<Comparison>,
    /// False after Ctrl+C.
    pub(super) is_complete: bool,
    /// The command that measures the same again.
    pub(super) command: String,
}

/// The curve of one mode.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Method {
    pub(super) mode: String,
    pub(super) levels: Vec<LevelFigures>,
    /// relMSE against processor seconds.
    pub(super) power_law: Option<PowerLaw>,
    /// Processor seconds to an error, on that line.
    pub(super) seconds_to: Vec<Reach>,
}

/// Two modes side by side.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Comparison {
    pub(super) mode: String,
    pub(super) against: String,
    #[serde(flatten)]
    pub(super) verdict: Verdict,
}

impl SceneReport {
    /// `None` when nothing was measured.
    pub(super) fn new(
        args: &BenchArgs,
        facts: Facts<'_>,
        contenders: &[Contender],
        curves: &[Curve],
    ) -> Option<Self> {
        if curves.iter().all(|curve| curve.levels.is_empty()) {
            return None;
        }
        let settings = &facts.job.settings;
        let named = || contenders.iter().map(Contender::to_string).zip(curves);
        let methods = named().map(|(mode, curve)| Method::new(mode, curve));
        let against = named().skip(1).filter_map(|(name, other)| {
            let verdict = Verdict::between(&curves[0], other)?;
            Some(Comparison {
                mode: contenders[0].to_string(),
                against: name,
                verdict,
            })
        });
        Some(Self {
            scene: facts.scene_name.to_owned(),
            width: settings.width,
            height: settings.height,
            max_depth: settings.max_depth.to_string(),
            threads: settings.thread_count(),
            isa: settings.instruction_set(),
            load_seconds: facts.load_seconds,
            build_seconds: facts.build_seconds,
            first_pass_seconds: facts.first_pass_seconds,
            refine_seconds: facts.refine_seconds,
            methods: methods.collect(),
            comparisons: against.collect(),
            is_complete: facts.is_complete,
            command: command(args, facts.job),
            reference: facts.reference,
        })
    }

    /// What people must know before they believe the figures.
    pub(super) fn warning(&self) -> Option<String> {
        let p = self.reference.agreement.unwrap_or(1.0);
        (!self.reference.agrees()).then(|| {
            format!(
                "{}: the halves of the reference differ more than chance allows (p = {p:.1e}); do not trust these figures.",
                self.scene
            )
        })
    }
}

impl Method {
    fn new(mode: String, curve: &Curve) -> Self {
        let power_law = curve.power_law();
        let measured = curve.measured_errors();
        let reach = |target| power_law?.reach(target, measured?);
        Self {
            mode,
            levels: curve.levels.iter().map(|level| level.figures()).collect(),
            power_law,
            seconds_to: TARGETS.into_iter().filter_map(reach).collect(),
        }
    }
}

/// The command line of one scene's measurement.
fn command(args: &BenchArgs, job: &Job) -> String {
    let render = command_line(job);
    let rest = render.strip_prefix("softbox ").unwrap_or(&render);
    let mut line = format!("softbox bench {rest}");
    if !args.compare.is_empty() {
        let modes: Vec<String> = args.compare.iter().map(Contender::to_string).collect();
        // The two options exclude each other.
        line = line.replacen(&format!(" --mode {}", job.settings.mode.name()), "", 1);
        line += &format!(" --compare {}", modes.join(","));
    }
    line += &format!(" --spp {} --seeds {}", args.spp, args.seeds);
    if let Some(file) = &args.reference {
        line += &format!(" --reference {}", crate::command_line::word(file));
        if let Some(noise) = args.reference_noise {
            line += &format!(" --reference-noise {noise}");
        }
    } else {
        let mode = args.chosen_reference_mode().name();
        let samples = args.chosen_reference_spp();
        line += &format!(" --reference-mode {mode} --reference-spp {samples}");
    }
    if let Some(seconds) = args.time_limit {
        line += &format!(" --time-limit {seconds}");
    }
    line
}
