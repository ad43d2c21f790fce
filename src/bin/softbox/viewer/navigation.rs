//! From mouse, wheel and held keys over the picture to gestures of the camera.

use eframe::egui::{self, Key, PointerButton, Pos2, Ui};
use glam::{DVec2, DVec3};
use softbox::camera::Camera;

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
}

/// The state of a movement.
#[derive(Debug, Default)]
pub(super) struct Navigation {
    is_looking: bool,
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
        for gesture in self.drags(ui, shown) {
            move_camera(document, gesture);
        }
        if let Some(pointer) = response.hover_pos() {
            if let Some(gesture) = wheel(ui, shown, document, picker, pointer) {
                move_camera(document, gesture);
            }
            if response.double_clicked_by(PointerButton::Primary)
                && let Some(hit) = picker.pick(&document.camera, &shown.letterbox, pointer)
            {
                move_camera(document, Gesture::Pivot(hit.point));
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

    fn drags(&mut self, ui: &Ui, shown: &Shown) -> Vec<Gesture> {
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
