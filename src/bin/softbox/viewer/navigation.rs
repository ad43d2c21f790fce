//! From mouse, wheel and held keys over the picture to gestures of the camera.

use eframe::egui::{self, Key, PointerButton, Pos2, Ui};
use glam::{DVec2, DVec3};
use softbox::camera::Camera;

use super::command::Command;
use super::document::Document;
use super::inspector::Picker;
use super::orbit::{self, Gesture};
use super::viewport::Shown;

/// Wheel points for which the distance changes by a factor e.
const WHEEL_PER_E: f64 = 400.0;
/// Scene sizes per second of flight.
const FLIGHT_SPEED: f64 = 0.35;

/// What the hand asked for besides moving the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Click {
    /// Focus on the surface under this point of the screen.
    Focus(Pos2),
    /// Look at the surface under this point and turn about it.
    Pivot(Pos2),
}

/// The state of a movement.
#[derive(Debug, Default)]
pub(super) struct Navigation {
    is_looking: bool,
    menu_at: Option<Pos2>,
}

impl Navigation {
    /// True while the right button turns the head and letters fly.
    pub(super) fn is_flying(&self) -> bool {
        self.is_looking
    }

    /// Moves the document's camera by what happened in this frame.
    pub(super) fn update(
        &mut self,
        ui: &Ui,
        shown: &Shown,
        document: &mut Document,
        picker: &Picker,
    ) -> Option<Click> {
        let response = &shown.response;
        let mut click = None;
        for gesture in self.drags(ui, shown, document.camera.target) {
            move_camera(document, gesture);
        }
        if let Some(pointer) = response.hover_pos() {
            if let Some(gesture) = wheel(ui, shown, document, picker, pointer) {
                move_camera(document, gesture);
            }
            if response.double_clicked_by(PointerButton::Primary) {
                click = Some(Click::Pivot(pointer));
            }
            if response.clicked_by(PointerButton::Secondary) && ui.input(|i| i.modifiers.command) {
                click = Some(Click::Focus(pointer));
            }
        }
        if self.is_looking {
            self.fly(ui, document);
        }
        click
    }

    /// The menu of a right click.
    pub(super) fn menu(&mut self, shown: &Shown, commands: &mut Vec<Command>) -> Option<Click> {
        let response = &shown.response;
        let is_focusing = response.ctx.input(|i| i.modifiers.command);
        if is_focusing {
            return None;
        }
        if response.secondary_clicked() {
            self.menu_at = response.interact_pointer_pos();
        }
        let at = self.menu_at?;
        let mut click = None;
        response.context_menu(|ui| {
            if ui.button("Focus here").clicked() {
                click = Some(Click::Focus(at));
            }
            if ui.button("Orbit about this point").clicked() {
                click = Some(Click::Pivot(at));
            }
            ui.separator();
            for (text, command) in [
                ("Reset camera", Command::ResetCamera),
                ("Frame the scene", Command::FrameScene),
                ("Save picture", Command::SaveSnapshot),
                ("Copy picture", Command::CopyImage),
            ] {
                if ui.button(text).clicked() {
                    commands.push(command);
                }
            }
        });
        click
    }

    /// Carries out a click; returns the news for the user.
    pub(super) fn carry_out(
        click: Click,
        shown: &Shown,
        document: &mut Document,
        picker: &Picker,
    ) -> Option<String> {
        let (Click::Focus(at) | Click::Pivot(at)) = click;
        let hit = picker.pick(&document.camera, &shown.letterbox, at)?;
        match click {
            Click::Focus(_) => {
                document.camera.focal_distance = hit.depth;
                Some(format!("Focus at {:.4}", hit.depth))
            }
            Click::Pivot(_) => {
                move_camera(document, Gesture::Pivot(hit.point));
                None
            }
        }
    }

    fn drags(&mut self, ui: &Ui, shown: &Shown, target: DVec3) -> Vec<Gesture> {
        let response = &shown.response;
        let height = f64::from(shown.letterbox.rect.height().max(1.0));
        let moved = response.drag_delta();
        let delta = DVec2::new(f64::from(moved.x), f64::from(moved.y)) / height;
        let modifiers = ui.input(|i| i.modifiers);
        let dragged = |button| response.dragged_by(button);
        self.is_looking = dragged(PointerButton::Secondary) && !modifiers.alt && !modifiers.command
            || (response.is_pointer_button_down_on()
                && ui.input(|i| i.pointer.secondary_down())
                && !modifiers.command
                && !modifiers.alt);
        if delta == DVec2::ZERO {
            return Vec::new();
        }
        if dragged(PointerButton::Middle) || dragged(PointerButton::Primary) && modifiers.shift {
            vec![Gesture::Pan(delta)]
        } else if dragged(PointerButton::Primary) {
            vec![Gesture::Orbit(delta)]
        } else if dragged(PointerButton::Secondary) && modifiers.alt {
            let factor = (delta.y - delta.x).exp();
            let towards = target;
            vec![Gesture::Dolly { towards, factor }]
        } else if dragged(PointerButton::Secondary) && self.is_looking {
            vec![Gesture::Look(delta)]
        } else {
            Vec::new()
        }
    }

    fn fly(&self, ui: &Ui, document: &mut Document) {
        let axis = |i: &egui::InputState, plus: Key, minus: Key| {
            f64::from(i8::from(i.key_down(plus)) - i8::from(i.key_down(minus)))
        };
        let (motion, seconds, is_fast) = ui.input(|i| {
            let motion = DVec3::new(
                axis(i, Key::D, Key::A),
                axis(i, Key::E, Key::Q),
                axis(i, Key::W, Key::S),
            );
            (motion, f64::from(i.stable_dt.min(0.1)), i.modifiers.shift)
        });
        if motion == DVec3::ZERO {
            return;
        }
        let speed = document.scene_size() * FLIGHT_SPEED * if is_fast { 4.0 } else { 1.0 };
        move_camera(document, Gesture::Fly(motion * speed * seconds));
        ui.ctx().request_repaint();
    }
}

fn move_camera(document: &mut Document, gesture: Gesture) {
    document.camera = orbit::apply(
        &document.camera,
        gesture,
        document.scene_size(),
        document.image_size(),
    );
}

fn wheel(
    ui: &Ui,
    shown: &Shown,
    document: &Document,
    picker: &Picker,
    pointer: Pos2,
) -> Option<Gesture> {
    let (scroll, zoom) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
    let factor = (-f64::from(scroll) / WHEEL_PER_E).exp() / f64::from(zoom);
    if factor == 1.0 {
        return None;
    }
    let towards = picker
        .pick(&document.camera, &shown.letterbox, pointer)
        .map_or_else(
            || target_plane_point(&document.camera, shown, pointer),
            |hit| hit.point,
        );
    Some(Gesture::Dolly { towards, factor })
}

/// The point under the pointer in the plane of the target.
fn target_plane_point(camera: &Camera, shown: &Shown, pointer: Pos2) -> DVec3 {
    let rect = shown.letterbox.rect;
    let unit = (pointer - rect.center()) / rect.size() * 2.0;
    let (right, up, _) = camera.basis();
    let [width, height] = shown.letterbox.image;
    let (half_width, half_height) = camera.half_extent(width, height);
    let distance = camera.eye.distance(camera.target);
    camera.target
        + (right * (f64::from(unit.x) * half_width) - up * (f64::from(unit.y) * half_height))
            * distance
}
