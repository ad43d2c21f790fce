//! Facts about the render, the scene and its hierarchy.

use eframe::egui::{self, Grid, Ui};
use softbox::bvh::BvhStats;
use softbox::math::Isa;
use softbox::session::{SessionStatus, TreeState};

use crate::viewer::latency::LatencySummary;

/// The facts of the render and of the hierarchy of the shown scene.
pub(in crate::viewer) fn show(
    ui: &mut Ui,
    status: &SessionStatus,
    isa: Isa,
    latency: Option<&LatencySummary>,
    bvh: Option<&BvhStats>,
) {
    egui::CollapsingHeader::new("Statistics").show(ui, |ui| {
        let mut lines = render_facts(status);
        lines.push(("Instruction set", isa.to_string()));
        if let TreeState::Refined { seconds } = status.tree {
            lines.push(("Tree refined in", format!("{seconds:.3} s")));
        }
        lines.extend(latency.map(|latency| ("Hand to picture", latency.to_string())));
        facts(ui, "render facts", &lines);
        if let Some(bvh) = bvh {
            ui.add_space(4.0);
            ui.strong("BVH");
            facts(ui, "BVH facts", &bvh_facts(bvh));
            leaf_histogram(ui, bvh);
        }
    });
}

fn facts(ui: &mut Ui, id: &str, lines: &[(&str, String)]) {
    Grid::new(id)
        .num_columns(2)
        .min_col_width(super::LABELS)
        .show(ui, |ui| {
            for (name, value) in lines {
                ui.label(*name);
                ui.monospace(value);
                ui.end_row();
            }
        });
}

fn render_facts(status: &SessionStatus) -> Vec<(&'static str, String)> {
    let counts = &status.counts;
    let rays = counts.closest_rays + counts.shadow_rays;
    let per_ray = |tests: u64| {
        if rays == 0 {
            String::new()
        } else {
            format!("{:.1}", tests as f64 / rays as f64)
        }
    };
    vec![
        ("Samples/s", count(status.samples_per_second)),
        ("Paths", count(counts.camera_rays as f64)),
        ("Closest rays", count(counts.closest_rays as f64)),
        ("Shadow rays", count(counts.shadow_rays as f64)),
        ("Box tests/ray", per_ray(counts.trace.box_tests)),
        ("Shape tests/ray", per_ray(counts.trace.primitive_tests)),
        ("Invalid samples", counts.invalid_samples.to_string()),
        ("Scene made in", format!("{:.3} s", status.build_seconds)),
    ]
}

fn bvh_facts(bvh: &BvhStats) -> Vec<(&'static str, String)> {
    vec![
        ("Primitives", bvh.primitives.to_string()),
        ("Quads of these", bvh.quads.to_string()),
        ("Left out", bvh.excluded.to_string()),
        ("Nodes", bvh.nodes.to_string()),
        ("Leaves", bvh.leaves.to_string()),
        ("Deepest leaf", bvh.max_depth.to_string()),
        ("Mean leaf depth", format!("{:.1}", bvh.mean_leaf_depth)),
        ("Largest leaf", bvh.largest_leaf.to_string()),
        ("SAH cost", format!("{:.2}", bvh.sah_cost)),
        ("Memory", format!("{:.2} MB", bvh.bytes as f64 / 1e6)),
        ("Build time", format!("{:.3} s", bvh.build_seconds)),
    ]
}

/// Bars: how many leaves hold how many primitives.
fn leaf_histogram(ui: &mut Ui, bvh: &BvhStats) {
    let most = bvh.leaf_histogram.values().copied().max().unwrap_or(0);
    if most == 0 {
        return;
    }
    ui.label("Leaves by primitives");
    for (size, leaves) in bvh.leaf_histogram.iter().take(16) {
        ui.horizontal(|ui| {
            ui.monospace(format!("{size:>3}"));
            let width = 140.0 * *leaves as f32 / most as f32;
            let (rect, _) = ui.allocate_exact_size(egui::vec2(140.0, 10.0), egui::Sense::hover());
            let bar = egui::Rect::from_min_size(rect.min, egui::vec2(width.max(1.0), 10.0));
            let color = ui.visuals().selection.bg_fill;
            ui.painter().rect_filled(bar, 1.0, color);
            ui.monospace(leaves.to_string());
        });
    }
}

/// A number with a thousands prefix: 12.3 k, 4.56 M.
pub(super) fn count(value: f64) -> String {
    for (unit, suffix) in [(1e9, " G"), (1e6, " M"), (1e3, " k")] {
        if value >= unit {
            return format!("{:.2}{suffix}", value / unit);
        }
    }
    format!("{value:.0}")
}
