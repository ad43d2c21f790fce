use std::io::Write;

use anyhow::Context;
use softbox::math::Isa;

use crate::args::RaysArgs;
use crate::exit::{Failure, Status};
use crate::ray_bench::{SCENES, SceneResult, contest, ours, subject, write_table};

/// Measures the tracer and prints the figures on standard output.
pub(crate) fn run(args: &RaysArgs) -> Result<(), Failure> {
    let mut scenes: Vec<&str> = args.scenes.iter().map(String::as_str).collect();
    if scenes.is_empty() {
        scenes.extend(SCENES);
    }
    let isa = args.protocol.isa.unwrap_or_else(Isa::best);
    let systems = ours(isa);
    let mut results: Vec<SceneResult> = Vec::new();
    for name in scenes {
        let subject = subject(name).map_err(Status::Scene.because())?;
        let result = contest(&subject, &systems, &args.protocol);
        if !args.json {
            write_table(&mut std::io::stdout().lock(), &result)
                .context("Cannot write to standard output")
                .map_err(Status::Failed.because())?;
        }
        results.push(result);
    }
    if args.json {
        print_json(&results)
            .context("Cannot write to standard output")
            .map_err(Status::Failed.because())?;
    }
    Ok(())
}

fn print_json(results: &[SceneResult]) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    serde_json::to_writer_pretty(&mut out, results)?;
    writeln!(out)
}

#[cfg(test)]
mod tests;
