use std::io::{Result, Write};

use super::result::{BuildResult, RaysResult};
use super::{Kind, SceneResult};

/// Writes the figures of one scene for people.
pub(crate) fn write_table(out: &mut impl Write, result: &SceneResult) -> Result<()> {
    write!(
        out,
        "{}: {} triangles; {}; rays:",
        result.scene, result.triangles, result.isa
    )?;
    for (kind, rays) in &result.rays {
        write!(out, " {kind} {rays}")?;
    }
    writeln!(out)?;
    write_builds(out, result)?;
    let mut threads: Vec<usize> = result.traced.iter().map(|row| row.threads).collect();
    threads.sort_unstable();
    threads.dedup();
    for threads in threads {
        write_rays(out, result, threads)?;
    }
    write_mismatches(out, result)?;
    writeln!(out)
}

fn write_builds(out: &mut impl Write, result: &SceneResult) -> Result<()> {
    writeln!(
        out,
        "  build            threads    cpu s   wall s  Mtri/cpu s          Mtri/wall s  bytes/tri      SAH"
    )?;
    let triangles = result.triangles as f64;
    for build in &result.builds {
        let BuildResult {
            system,
            threads,
            processor_seconds: cpu,
            wall_seconds: wall,
            ratio,
            bytes,
            sah_cost,
        } = build;
        let ratio = ratio.map_or(String::new(), |ratio| format!("x{ratio:.2}"));
        let sah = sah_cost.map_or("-".to_owned(), |cost| format!("{cost:.2}"));
        writeln!(
            out,
            "  {system:<16} {threads:>7} {cpu:>8.4} {wall:>8.4} {:>11.2} {ratio:<7} {:>12.2} {:>10.1} {sah:>8}",
            triangles / cpu / 1e6,
            triangles / wall / 1e6,
            *bytes as f64 / triangles,
        )?;
    }
    Ok(())
}

fn write_rays(out: &mut impl Write, result: &SceneResult, threads: usize) -> Result<()> {
    let plural = if threads == 1 { "" } else { "s" };
    write!(out, "  {:<16}", format!("{threads} thread{plural}"))?;
    for (kind, _) in &result.rays {
        write!(out, " {kind:>14}")?;
    }
    writeln!(out, "   Mray/s of processor time")?;
    for_each_system(out, result, |out, system, kind| {
        let cell = find(result, system, kind, threads).map(|row| {
            let rate = row.rays_per_second / 1e6;
            let ratio = row.ratio.map(|ratio| format!(" x{ratio:.2}"));
            format!("{rate:.2}{}", ratio.unwrap_or_default())
        });
        write!(out, " {:>14}", cell.unwrap_or_default())
    })
}

fn write_mismatches(out: &mut impl Write, result: &SceneResult) -> Result<()> {
    writeln!(
        out,
        "  other than in double precision, per million rays: hit or miss / distance"
    )?;
    for_each_system(out, result, |out, system, kind| {
        let count = result.rays.iter().find(|(k, _)| *k == kind);
        let rays = count.map_or(f64::NAN, |(_, rays)| *rays as f64);
        let row = result
            .traced
            .iter()
            .find(|row| row.system == system && row.kind == kind);
        let cell = row.map(|RaysResult { mismatches, .. }| {
            let per_million = |n: usize| format!("{:.0}", n as f64 * 1e6 / rays);
            let other = per_million(mismatches.hit_or_miss);
            format!("{other} / {}", per_million(mismatches.distance))
        });
        write!(out, " {:>14}", cell.unwrap_or_default())
    })
}

/// A line for each system with a cell for each kind of rays.
fn for_each_system<W: Write>(
    out: &mut W,
    result: &SceneResult,
    cell: impl Fn(&mut W, &str, Kind) -> Result<()>,
) -> Result<()> {
    let mut systems: Vec<&str> = Vec::new();
    for row in &result.builds {
        if !systems.contains(&row.system.as_str()) {
            systems.push(&row.system);
        }
    }
    for system in systems {
        write!(out, "  {system:<16}")?;
        for (kind, _) in &result.rays {
            cell(out, system, *kind)?;
        }
        writeln!(out)?;
    }
    Ok(())
}

fn find<'a>(
    result: &'a SceneResult,
    system: &str,
    kind: Kind,
    threads: usize,
) -> Option<&'a RaysResult> {
    let is_it =
        |row: &&RaysResult| row.system == system && row.kind == kind && row.threads == threads;
    result.traced.iter().find(is_it)
}
