use std::io::Write;
use std::ops::ControlFlow;

use anyhow::{Context, anyhow};
use serde::Serialize;
use softbox::bvh::BvhStats;
use softbox::geometry::InstanceStats;
use softbox::io::{ImportReport, Loaded};
use softbox::scene::{PrepareSettings, prepare};

use crate::args::InfoArgs;
use crate::exit::{Failure, Status};
use crate::open::open_path;

/// What `info --json` prints.
#[derive(Serialize)]
struct Description {
    scene: String,
    bounds_min: Option<[f64; 3]>,
    bounds_max: Option<[f64; 3]>,
    primitives: usize,
    lights: usize,
    added_light: bool,
    report: ImportReport,
    decisions: Vec<String>,
    bvh: BvhStats,
    /// End-point overlap.
    epo: f64,
    instancing: InstanceStats,
}

/// Points at which the end-point overlap is taken.
const OVERLAP_SAMPLES: usize = 10_000;

/// Prints what a scene file holds, what was guessed and dropped, and what its hierarchy is like.
pub(crate) fn run(args: &InfoArgs) -> Result<(), Failure> {
    let Loaded { mut scene, report } = open_path(&args.scene)?;
    let added_light = scene.light_if_dark();
    let prepared = prepare(&scene, &PrepareSettings::default(), &|_, _| {
        ControlFlow::Continue(())
    })
    .ok_or_else(|| Status::Failed.because()(anyhow!("Preparing the scene broke off.")))?;
    let bounds = scene.bounds();
    let description = Description {
        scene: scene.name.clone(),
        bounds_min: bounds.map(|(min, _)| min.to_array()),
        bounds_max: bounds.map(|(_, max)| max.to_array()),
        primitives: prepared.aggregate().primitive_count(),
        lights: prepared.light_count(),
        added_light,
        report,
        decisions: prepared.notes().to_vec(),
        bvh: prepared.aggregate().stats(),
        epo: prepared.aggregate().end_point_overlap(OVERLAP_SAMPLES),
        instancing: prepared.instance_stats(),
    };
    print(&description, args.json)
        .context("Cannot write to standard output")
        .map_err(Status::Failed.because())
}

fn print(description: &Description, as_json: bool) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    if as_json {
        serde_json::to_writer_pretty(&mut out, description)?;
        return writeln!(out);
    }
    writeln!(out, "{}", description.scene)?;
    write!(out, "{}", description.report)?;
    for decision in &description.decisions {
        writeln!(out, "decided {decision}")?;
    }
    if description.added_light {
        writeln!(
            out,
            "decided The scene has no light: a soft sky is added when it is rendered."
        )?;
    }
    if let (Some(min), Some(max)) = (description.bounds_min, description.bounds_max) {
        writeln!(out, "bounds: {min:?} to {max:?}")?;
    }
    writeln!(
        out,
        "at run time: {} primitives, {} lights",
        description.primitives, description.lights
    )?;
    let shared = &description.instancing;
    if shared.instances > 0 {
        writeln!(
            out,
            "instances: {} of {} shared meshes, {} triangles that rays meet as {}, {} bytes",
            shared.instances,
            shared.meshes,
            shared.unique_triangles,
            shared.virtual_triangles,
            shared.bytes
        )?;
    }
    let bvh = &description.bvh;
    writeln!(
        out,
        "BVH: {} primitives ({} quads), {} nodes, {} leaves, depth {} (leaves at {:.1} on average), SAH cost {:.2}, largest leaf {}, {} bytes, built in {:.3} s",
        bvh.primitives,
        bvh.quads,
        bvh.nodes,
        bvh.leaves,
        bvh.max_depth,
        bvh.mean_leaf_depth,
        bvh.sah_cost,
        bvh.largest_leaf,
        bvh.bytes,
        bvh.build_seconds
    )?;
    writeln!(
        out,
        "rays: {:.2} nodes and {:.2} blocks expected, end-point overlap {:.2}; {:.1} bytes per shape",
        bvh.expected_nodes, bvh.expected_blocks, description.epo, bvh.bytes_per_shape
    )
}
