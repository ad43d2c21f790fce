//! The walk through the hierarchy of boxes.

use eframe::egui::{self, Slider, Ui};

use super::row;
use crate::viewer::bvh_view::{Boxes, BvhView, NodeFacts};

/// Level, selection and the facts of the selected box.
pub(in crate::viewer) fn show(ui: &mut Ui, view: &mut BvhView, facts: Option<&NodeFacts>) {
    egui::CollapsingHeader::new("BVH view")
        .default_open(true)
        .show(ui, |ui| {
            egui::Grid::new("BVH view")
                .num_columns(2)
                .min_col_width(super::LABELS)
                .show(ui, |ui| {
                    row(
                        ui,
                        "Show boxes",
                        "V shows and hides them.",
                        egui::Checkbox::without_text(&mut view.is_on),
                    );
                    if !view.is_on {
                        return;
                    }
                    ui.label("Which");
                    ui.horizontal(|ui| {
                        ui.selectable_value(&mut view.boxes, Boxes::Walk, "one and its children");
                        ui.selectable_value(&mut view.boxes, Boxes::Level, "a level");
                    });
                    ui.end_row();
                    let deepest = view.deepest();
                    if view.boxes == Boxes::Level {
                        row(
                            ui,
                            "Level",
                            "Number of boxes above; 0 is the whole scene.",
                            Slider::new(&mut view.level, 0..=deepest),
                        );
                    }
                });
            if let (true, Some(facts)) = (view.is_on, facts) {
                ui.monospace(facts.to_string());
                ui.weak("Up: parent. Left, Right: children.");
            }
        });
}
