//! Rays per second and build time, ours and others side by side.
//!
//! ```text
//! cargo bench --bench rays                                   everything: half an hour
//! cargo bench --bench rays -- --scenes ico1m,city --rounds 3 --threads 1
//! cargo bench --bench rays -- --only ours,embree --kinds bounce1,shadow1
//! cargo bench --bench rays -- --scenes a/scene.dae --json figures.json
//! cargo bench --bench rays -- --leak                         watertight or not
//! ```
//! How it measures: `ray_bench`, which `softbox bench --rays` uses too. The profile is that of a
//! release with line tables for profilers.
//!
//! Embree 4 is the anchor. It is found under its usual names, in `SOFTBOX_EMBREE` or by `--embree`;
//! without it the others run alone. Apart from packages of the system, the Python wheel `embreex` holds
//! it: `pip download --no-deps embreex==4.4.0.post1`, then `python3 -m zipfile -e` the file into a
//! folder under `target/`; the library is in `embreex.libs/`.

mod bvh_crate;
#[expect(
    unsafe_code,
    reason = "a C library is called, and its rounding mode set"
)]
mod embree;
mod embree_query;
mod leak;
mod obvhs_crate;
#[path = "../../src/bin/softbox/ray_bench/mod.rs"]
mod ray_bench;
mod summary;

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::PathBuf;

use anyhow::Context;
use clap::Parser;
use softbox::math::Isa;

use ray_bench::{Protocol, SCENES, SceneResult, System, contest, ours, subject, write_table};

/// Rays per second and build time, ours and others side by side
#[derive(Parser, Debug)]
struct Options {
    /// Generated scenes or scene files
    #[arg(long, value_name = "SCENE,SCENE", value_delimiter = ',', default_values = SCENES)]
    scenes: Vec<String>,
    /// Systems, also `embree-denormals` (Embree without flushing denormal numbers to zero)
    #[arg(
        long,
        value_name = "NAME,NAME",
        value_delimiter = ',',
        default_value = "embree,ours,ours-high,embree-packets,embree-robust,obvhs-bvh2,obvhs-cwbvh,bvh"
    )]
    only: Vec<String>,
    #[command(flatten)]
    protocol: Protocol,
    /// The library to use as Embree 4; else that of `SOFTBOX_EMBREE`, else one of the usual names
    #[arg(long, value_name = "FILE")]
    embree: Option<String>,
    /// Also write all figures to this file
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Count what slips through a closed mesh, instead of measuring time
    #[arg(long)]
    leak: bool,
    /// Given by cargo
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> anyhow::Result<()> {
    // `cargo test --all-targets` runs this program without the flag.
    if !std::env::args().any(|word| word == "--bench") {
        return Ok(());
    }
    let options = Options::parse();
    let mut out = std::io::stdout().lock();
    let systems = systems(&options, &mut out)?;
    if options.leak {
        return Ok(leak::report(&mut out, &systems)?);
    }
    let mut results: Vec<SceneResult> = Vec::new();
    for name in &options.scenes {
        let result = contest(&subject(name)?, &systems, &options.protocol);
        write_table(&mut out, &result)?;
        results.push(result);
    }
    summary::write_summary(&mut out, &results)?;
    if let Some(path) = &options.json {
        let describe = || format!("{} cannot be written", path.display());
        let mut file = BufWriter::new(File::create(path).with_context(describe)?);
        serde_json::to_writer_pretty(&mut file, &results)?;
        file.flush().with_context(describe)?;
    }
    Ok(())
}

/// The wanted systems, in the order in which they were asked for.
fn systems(options: &Options, out: &mut impl Write) -> anyhow::Result<Vec<System>> {
    let isa = options.protocol.isa.unwrap_or_else(Isa::best);
    let mut all = ours(isa);
    all.push(bvh_crate::system());
    all.extend(obvhs_crate::systems());
    let of_environment = std::env::var("SOFTBOX_EMBREE").ok();
    let path = options.embree.as_ref().or(of_environment.as_ref());
    match embree::Embree::open(path.map(String::as_str)) {
        Ok(embree) => all.extend(embree.systems()),
        Err(reason) => writeln!(out, "without Embree: {reason}")?,
    }
    let mut wanted = Vec::new();
    for name in &options.only {
        match all.iter().position(|system| system.name == *name) {
            Some(place) => wanted.push(all.swap_remove(place)),
            None if name.starts_with(ray_bench::ANCHOR) => {}
            None => anyhow::bail!("no system '{name}'"),
        }
    }
    Ok(wanted)
}
