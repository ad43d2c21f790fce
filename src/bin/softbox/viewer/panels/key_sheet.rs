//! The sheet of all keys and of what the mouse does.

use eframe::egui::{self, Context, Grid, Ui, Window};

use crate::viewer::command::{Binding, Group};
use crate::viewer::keys::chord_text;

const MOUSE: [(&str, &str); 10] = [
    ("Left drag", "orbit"),
    ("Middle drag, Shift + left drag", "pan"),
    ("Wheel, pinch", "move towards the point under the pointer"),
    ("Right drag", "look around"),
    ("Right button + W A S D Q E", "fly (Shift: faster)"),
    ("Alt + right drag", "move towards the target"),
    ("Double click", "look at this point and orbit about it"),
    ("Ctrl + right click", "focus on this point"),
    ("C, then left drag", "render only this region"),
    ("Drop a file", "open it"),
];

/// Shows the sheet while `is_open`.
pub(in crate::viewer) fn show(ctx: &Context, bindings: &[Binding], is_open: &mut bool) {
    let height = (ctx.content_rect().height() - 120.0).max(120.0);
    Window::new("Keys and mouse")
        .open(is_open)
        .collapsible(false)
        .default_size([700.0, height])
        .show(ctx, |ui| {
            egui::ScrollArea::vertical()
                .max_height(height)
                .show(ui, |ui| {
                    ui.columns(2, |columns| {
                        mouse(&mut columns[1]);
                        for group in Group::ALL {
                            let side = usize::from(matches!(group, Group::View | Group::Bvh));
                            keys(&mut columns[side], group, bindings);
                        }
                    });
                });
        });
}

fn mouse(ui: &mut Ui) {
    ui.strong("Mouse");
    Grid::new("mouse")
        .num_columns(2)
        .striped(true)
        .show(ui, |ui| {
            for (what, effect) in MOUSE {
                ui.label(what);
                ui.label(effect);
                ui.end_row();
            }
        });
    ui.add_space(8.0);
}

fn keys(ui: &mut Ui, group: Group, bindings: &[Binding]) {
    ui.strong(group.name());
    Grid::new(group.name())
        .num_columns(2)
        .striped(true)
        .show(ui, |ui| {
            for binding in bindings.iter().filter(|b| b.group == group) {
                let chords: Vec<String> = binding
                    .chords
                    .iter()
                    .map(|chord| chord_text(ui.ctx(), *chord))
                    .collect();
                ui.monospace(chords.join("  "));
                ui.label(binding.text);
                ui.end_row();
            }
        });
    ui.add_space(8.0);
}
