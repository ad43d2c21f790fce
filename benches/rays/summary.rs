//! Ratios over all scenes.

use std::collections::BTreeMap;
use std::io::{Result, Write};

use crate::ray_bench::{ANCHOR, Kind, SceneResult};

/// Ratios of one system in all scenes, by kind of rays.
type Ratios = BTreeMap<Kind, Vec<f64>>;

/// Writes for every system, kind of rays and number of threads the geometric mean over the scenes of
/// the ratios to the anchor, and the least of them.
pub(crate) fn write_summary(out: &mut impl Write, results: &[SceneResult]) -> Result<()> {
    let rows = results.iter().flat_map(|scene| &scene.traced);
    let mut lines: BTreeMap<(usize, &str), Ratios> = BTreeMap::new();
    for row in rows.filter(|row| row.system != ANCHOR) {
        let Some(ratio) = row.ratio else { continue };
        let line = lines.entry((row.threads, &row.system)).or_default();
        line.entry(row.kind).or_default().push(ratio);
    }
    let mut kinds: Vec<Kind> = lines
        .values()
        .flat_map(|line| line.keys().copied())
        .collect();
    kinds.sort_unstable();
    kinds.dedup();
    if kinds.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "times {ANCHOR}: geometric mean over {} scenes (least)",
        results.len()
    )?;
    write!(out, "  system           threads")?;
    for kind in &kinds {
        write!(out, " {kind:>14}")?;
    }
    writeln!(out)?;
    for ((threads, system), ratios) in &lines {
        write!(out, "  {system:<16} {threads:>7}")?;
        for kind in &kinds {
            let cell = ratios.get(kind).map(|ratios| cell(ratios));
            write!(out, " {:>14}", cell.unwrap_or_default())?;
        }
        writeln!(out)?;
    }
    Ok(())
}

fn cell(ratios: &[f64]) -> String {
    let logarithms: f64 = ratios.iter().map(|ratio| ratio.ln()).sum();
    let mean = (logarithms / ratios.len() as f64).exp();
    let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
    format!("x{mean:.2} ({least:.2})")
}
