use std::io::{Result, Write};

use softbox::study::{FEWEST_RUNS, LevelFigures, Outcome, PowerLaw, Reach};

use super::report::{Comparison, Method, SceneReport};

/// Writes the figures of one scene for people.
pub(super) fn write(out: &mut impl Write, report: &SceneReport) -> Result<()> {
    let plural = if report.threads == 1 { "" } else { "s" };
    write!(
        out,
        "{}: {}x{}, depth {}, {} thread{plural}, {}; loaded in {:.3} s, built in {:.3} s, first pass {:.3} s",
        report.scene,
        report.width,
        report.height,
        report.max_depth,
        report.threads,
        report.isa,
        report.load_seconds,
        report.build_seconds,
        report.first_pass_seconds,
    )?;
    if report.refine_seconds > 0.0 {
        write!(out, ", refined in {:.3} s", report.refine_seconds)?;
    }
    writeln!(out)?;
    write_reference(out, report)?;
    for method in &report.methods {
        write_method(out, method)?;
    }
    for comparison in &report.comparisons {
        writeln!(out, "  {}", sentence(comparison))?;
    }
    if !report.is_complete {
        writeln!(out, "  interrupted: not all runs were made")?;
    }
    writeln!(out)
}

fn write_reference(out: &mut impl Write, report: &SceneReport) -> Result<()> {
    let r = &report.reference;
    write!(out, "  reference: ")?;
    match (&r.file, r.mode, r.samples_per_pixel) {
        (Some(file), ..) => write!(out, "{file}")?,
        (None, mode, samples) => {
            let (mode, samples) = (mode.unwrap_or_default(), samples.unwrap_or(0));
            write!(out, "{mode}, {samples} samples, {:.1} s", r.cpu_seconds)?;
        }
    }
    write!(out, "; relMSE of its noise {:.2e}, subtracted", r.rel_mse)?;
    match r.agreement {
        Some(p) if r.agrees() => writeln!(out, "; its halves agree (p = {p:.2})"),
        Some(p) => writeln!(out, "; ITS HALVES DO NOT AGREE (p = {p:.1e})"),
        None => writeln!(out),
    }
}

fn write_method(out: &mut impl Write, method: &Method) -> Result<()> {
    writeln!(
        out,
        "  {:<16} {:>5} {:>5} {:>9} {:>7} {:>10} {:>10} {:>10}  {:<23}  efficiency",
        method.mode, "spp", "seeds", "cpu s", "Mray/s", "relMSE", "trimmed", "MSE", "mean ratio"
    )?;
    for level in &method.levels {
        write_level(out, level)?;
    }
    let Some(law) = method.power_law else {
        return Ok(());
    };
    write!(out, "  {:<16} slope {}; relMSE", "", slope(&law))?;
    let reaches: Vec<String> = method.seconds_to.iter().map(reach).collect();
    writeln!(out, "{}", reaches.join(","))?;
    if method.seconds_to.iter().any(|r| r.is_extrapolated) {
        writeln!(out, "  {:<16} (~: outside of what was measured)", "")?;
    }
    Ok(())
}

/// A slope with its error, where that is known.
pub(super) fn slope(law: &PowerLaw) -> String {
    let error = law.slope_error.map(|error| format!(" ± {error:.3}"));
    format!("{:.3}{}", law.slope, error.unwrap_or_default())
}

fn reach(reach: &Reach) -> String {
    let mark = if reach.is_extrapolated { "~" } else { "" };
    format!(
        " {:.0e} in {mark}{:.3} cpu s",
        reach.rel_mse, reach.cpu_seconds
    )
}

fn write_level(out: &mut impl Write, level: &LevelFigures) -> Result<()> {
    let interval = |interval: Option<[f64; 2]>, digits: usize| {
        interval.map_or(String::new(), |[low, high]| {
            format!(" [{low:.digits$}, {high:.digits$}]")
        })
    };
    let ratio = format!(
        "{:.4}{}",
        level.mean_ratio,
        interval(level.mean_ratio_interval, 4)
    );
    let efficiency = match level.efficiency {
        Some(value) => format!("{value:.1}{}", interval(level.efficiency_interval, 1)),
        None => "below the reference's noise".to_owned(),
    };
    writeln!(
        out,
        "  {:<16} {:>5} {:>5} {:>9.4} {:>7.2} {:>10.3e} {:>10.3e} {:>10.3e}  {ratio:<23}  {efficiency}",
        "",
        level.samples_per_pixel,
        level.seeds,
        level.cpu_seconds,
        level.rays / level.cpu_seconds.max(1e-9) * 1e-6,
        level.rel_mse,
        level.rel_mse_trimmed,
        level.mse,
    )
}

fn sentence(comparison: &Comparison) -> String {
    let verdict = &comparison.verdict;
    let (mode, against) = (&comparison.mode, &comparison.against);
    let interval = verdict.interval.map_or_else(
        || format!("no interval below {FEWEST_RUNS} seeds"),
        |[low, high]| format!("95 %: {low:.3} to {high:.3}"),
    );
    let conclusion = match verdict.outcome {
        Outcome::Better | Outcome::Worse => "",
        Outcome::NoDifferenceShown => ": no difference shown",
    };
    format!(
        "{mode} is {:.3} times as efficient as {against} at {} samples ({interval}){conclusion}",
        verdict.ratio, verdict.samples_per_pixel
    )
}
