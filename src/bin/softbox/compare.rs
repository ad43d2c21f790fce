use std::io::Write;

use anyhow::Context;
use serde::Serialize;
use softbox::image::{Comparison, compare};
use softbox::io::picture::read_picture;

use crate::args::CompareArgs;
use crate::exit::{Failure, Status};

/// What `compare --json` prints.
#[derive(Serialize)]
struct Report {
    image: String,
    reference: String,
    width: usize,
    height: usize,
    #[serde(flatten)]
    comparison: Comparison,
}

/// Compares two pictures and prints the figures on standard output.
pub(crate) fn run(args: &CompareArgs) -> Result<(), Failure> {
    let read = |path| read_picture(path).map_err(Status::Failed.because());
    let image = read(&args.image)?.image;
    let reference = read(&args.reference)?.image;
    let comparison = compare(&image, &reference).map_err(Status::Failed.because())?;
    let report = Report {
        image: args.image.display().to_string(),
        reference: args.reference.display().to_string(),
        width: image.width(),
        height: image.height(),
        comparison,
    };
    print(&report, args.json)
        .context("Cannot write to standard output")
        .map_err(Status::Failed.because())
}

fn print(report: &Report, as_json: bool) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    if as_json {
        serde_json::to_writer_pretty(&mut out, report)?;
        return writeln!(out);
    }
    let c = &report.comparison;
    writeln!(out, "{} against {}", report.image, report.reference)?;
    writeln!(
        out,
        "  size              {} x {}",
        report.width, report.height
    )?;
    writeln!(out, "  relMSE            {:.6e}", c.rel_mse)?;
    writeln!(
        out,
        "  relMSE, trimmed   {:.6e} (without the worst 0.1 % of the pixels)",
        c.rel_mse_trimmed
    )?;
    writeln!(out, "  MSE               {:.6e}", c.mse)?;
    writeln!(out, "  FLIP              {:.5}", c.flip)?;
    let [r, g, b] = c.mean_difference;
    writeln!(out, "  mean difference   {r:+.6} {g:+.6} {b:+.6}")?;
    let [r, g, b] = c.reference_mean;
    writeln!(out, "  reference mean    {r:.6} {g:.6} {b:.6}")?;
    let percent = 100.0 * c.max_block_difference;
    writeln!(out, "  worst 8x8 block   {percent:.3} %")?;
    if c.invalid_pixels > 0 {
        let count = c.invalid_pixels;
        writeln!(
            out,
            "  left out          {count} pixels that are not finite"
        )?;
    }
    Ok(())
}
