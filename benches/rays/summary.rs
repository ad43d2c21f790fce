//! Ratios over all scenes.

use std::collections::BTreeMap;
use std::fmt;
use std::io::{Result, Write};

use crate::embree::PACKETS;
use crate::ray_bench::{ANCHOR, Kind, SceneResult};

/// Ratios of one system in all scenes, by column.
type Ratios = BTreeMap<Column, Vec<f64>>;

/// What is compared.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Column {
    Build,
    Rays(Kind),
    /// To the better of the anchor's ways to trace primary rays.
    BestPrimary,
}

impl fmt::Display for Column {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Build => f.pad("build"),
            Self::Rays(kind) => kind.fmt(f),
            Self::BestPrimary => f.pad("best primary"),
        }
    }
}

/// Writes for every system, kind of rays and number of threads the geometric mean over the scenes of
/// the ratios to the anchor, and the least of them.
pub(crate) fn write_summary(out: &mut impl Write, results: &[SceneResult]) -> Result<()> {
    let mut lines: BTreeMap<(usize, &str), Ratios> = BTreeMap::new();
    for (threads, system, column, ratio) in results.iter().flat_map(ratios) {
        let line = lines.entry((threads, system)).or_default();
        line.entry(column).or_default().push(ratio);
    }
    let mut columns: Vec<_> = lines
        .values()
        .flat_map(|line| line.keys().copied())
        .collect();
    columns.sort_unstable();
    columns.dedup();
    if columns.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "times {ANCHOR}: geometric mean over {} scenes (least); best primary: times the better of \
         {ANCHOR} and {PACKETS}",
        results.len()
    )?;
    write!(out, "  system           threads")?;
    for column in &columns {
        write!(out, " {column:>14}")?;
    }
    writeln!(out)?;
    for ((threads, system), ratios) in &lines {
        write!(out, "  {system:<16} {threads:>7}")?;
        for column in &columns {
            let cell = ratios.get(column).map(|ratios| cell(ratios));
            write!(out, " {:>14}", cell.unwrap_or_default())?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// All ratios of one scene but the anchor's own: threads, system, column, ratio.
fn ratios(scene: &SceneResult) -> Vec<(usize, &str, Column, f64)> {
    let mut all = Vec::new();
    for row in scene.builds.iter().filter(|row| row.system != ANCHOR) {
        all.extend(
            row.ratio
                .map(|ratio| (row.threads, &*row.system, Column::Build, ratio)),
        );
    }
    for row in scene.traced.iter().filter(|row| row.system != ANCHOR) {
        let Some(ratio) = row.ratio else { continue };
        all.push((row.threads, &row.system, Column::Rays(row.kind), ratio));
        let packets = scene.traced.iter().find(|packets| {
            packets.system == PACKETS && (packets.kind, packets.threads) == (row.kind, row.threads)
        });
        if let Some(packets) = packets.and_then(|packets| packets.ratio) {
            let best = ratio / packets.max(1.0);
            all.push((row.threads, &row.system, Column::BestPrimary, best));
        }
    }
    all
}

fn cell(ratios: &[f64]) -> String {
    let logarithms: f64 = ratios.iter().map(|ratio| ratio.ln()).sum();
    let mean = (logarithms / ratios.len() as f64).exp();
    let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
    format!("x{mean:.2} ({least:.2})")
}
