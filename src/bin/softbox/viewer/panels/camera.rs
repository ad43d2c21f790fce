//! The camera in numbers, in the file's coordinates.

use eframe::egui::{DragValue, Slider, Ui};
use glam::DVec3;
use softbox::camera::{Camera, Framing};
use softbox::settings::CameraRule;

use super::{choice, row, section};
use crate::viewer::command::Command;
use crate::viewer::document::Document;

const RULES: [CameraRule; 4] = [
    CameraRule::Auto,
    CameraRule::Course,
    CameraRule::File,
    CameraRule::Fit,
];

/// All of the camera.
pub(in crate::viewer) fn show(ui: &mut Ui, document: &mut Document, commands: &mut Vec<Command>) {
    let scene_size = document.scene_size();
    let size = document.image_size();
    let before = document.camera;
    section(ui, "Camera", false, |ui| {
        let camera = &mut document.camera;
        let speed = scene_size * 0.002;
        point(ui, "Eye", "Where the lens is.", &mut camera.eye, speed);
        point(
            ui,
            "Target",
            "The middle of the picture; orbiting turns about it.",
            &mut camera.target,
            speed,
        );
        angle(ui, camera, size);
        row(
            ui,
            "Lens radius",
            "In file units; 0 keeps everything in focus.",
            DragValue::new(&mut camera.lens_radius)
                .range(0.0..=scene_size)
                .speed(scene_size * 0.0005)
                .max_decimals(5),
        );
        row(
            ui,
            "Focal distance",
            "File units from the eye to the plane in focus. Ctrl + right click focuses on a surface.",
            DragValue::new(&mut camera.focal_distance)
                .range(scene_size * 1e-6..=scene_size * 1e4)
                .speed(speed)
                .max_decimals(5),
        );
        let help = "Where the camera of the scene comes from.";
        if choice(
            ui,
            ("Comes from", help),
            &mut document.camera_choice.rule,
            &RULES,
            rule_name,
        ) {
            commands.push(Command::ResetCamera);
        }
        ui.label("");
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 3.0;
            for (text, command) in [
                ("Reset", Command::ResetCamera),
                ("Frame", Command::FrameScene),
                ("Undo", Command::UndoCamera),
                ("Redo", Command::RedoCamera),
            ] {
                if ui.button(text).clicked() {
                    commands.push(command);
                }
            }
        });
        ui.end_row();
    });
    if !document.camera.is_valid() {
        document.camera = before;
    }
}

fn point(ui: &mut Ui, label: &str, help: &str, value: &mut DVec3, speed: f64) {
    ui.label(label).on_hover_text(help);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 3.0;
        for (axis, number) in
            ["x", "y", "z"]
                .into_iter()
                .zip([&mut value.x, &mut value.y, &mut value.z])
        {
            ui.add(DragValue::new(number).speed(speed).max_decimals(3))
                .on_hover_text(axis)
                .accessible_name(format!("{label} {axis}"));
        }
    });
    ui.end_row();
}

/// The horizontal angle; a camera that crops like the course's keeps cropping.
fn angle(ui: &mut Ui, camera: &mut Camera, [width, height]: [u32; 2]) {
    let (half_width, _) = camera.half_extent(width, height);
    let before = (2.0 * half_width.atan()).to_degrees();
    let mut degrees = before;
    row(
        ui,
        "Angle of view",
        "Horizontal, in degrees.",
        Slider::new(&mut degrees, 1.0..=170.0)
            .suffix("°")
            .max_decimals(2),
    );
    if degrees == before {
        return;
    }
    let half = (degrees.to_radians() * 0.5).tan();
    camera.framing = match camera.framing {
        Framing::Horizontal(_) => Framing::Horizontal(degrees.to_radians()),
        Framing::ScreenDistance(_) => Framing::ScreenDistance(f64::from(width.max(1)) * 0.5 / half),
    };
}

fn rule_name(rule: CameraRule) -> &'static str {
    match rule {
        CameraRule::Auto => "auto",
        CameraRule::Course => "course",
        CameraRule::File => "file",
        CameraRule::Fit => "fit",
    }
}
