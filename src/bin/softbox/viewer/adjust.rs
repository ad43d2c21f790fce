//! Commands that change the document's numbers, as the course's keys do, and the words for it.

use softbox::scene::Dialect;
use softbox::settings::{MaxDepth, Mode, View};

use super::command::Command;
use super::document::Document;

/// The most samples per pixel that doubling reaches.
const MOST_SAMPLES: u32 = 1 << 24;
/// The most light samples that doubling reaches.
const MOST_LIGHT_SAMPLES: u32 = 1024;
/// Steps of the course's keys for lens and focus, in file units.
const COURSE_STEPS: (f64, f64) = (0.05, 0.1);
/// The same for other files, as parts of the scene's size.
const STEPS: (f64, f64) = (0.002, 0.02);

impl Document {
    /// Carries out a command that changes settings or camera. Returns the news for the user, or
    /// `None` when the command is about something else.
    pub(super) fn change(&mut self, command: &Command) -> Option<String> {
        self.change_settings(command)
            .or_else(|| self.change_camera(command))
    }

    fn change_settings(&mut self, command: &Command) -> Option<String> {
        let settings = &mut self.settings;
        Some(match command {
            Command::DoubleSamples | Command::HalveSamples => {
                let now = settings.stop.samples_per_pixel.unwrap_or(1);
                let samples = if *command == Command::DoubleSamples {
                    now.saturating_mul(2).min(MOST_SAMPLES)
                } else {
                    (now / 2).max(1)
                };
                settings.stop.samples_per_pixel = Some(samples);
                format!("{samples} samples per pixel")
            }
            Command::DoubleLightSamples => {
                settings.light_samples = (settings.light_samples * 2).min(MOST_LIGHT_SAMPLES);
                format!("Light samples: {}", settings.light_samples)
            }
            Command::HalveLightSamples => {
                settings.light_samples = (settings.light_samples / 2).max(1);
                format!("Light samples: {}", settings.light_samples)
            }
            Command::DeeperPaths => {
                // Beyond the last number there is no limit already.
                settings.max_depth = MaxDepth(settings.max_depth.0.saturating_add(1));
                format!("Bounces: {}", settings.max_depth)
            }
            Command::ShallowerPaths => {
                if settings.max_depth != MaxDepth::INFINITE {
                    settings.max_depth = MaxDepth(settings.max_depth.0.saturating_sub(1));
                }
                format!("Bounces: {}", settings.max_depth)
            }
            Command::ToggleHemisphere => {
                settings.mode = if settings.mode == Mode::Hemisphere {
                    self.light_mode
                } else {
                    self.light_mode = settings.mode;
                    Mode::Hemisphere
                };
                format!("Mode: {}", settings.mode.name())
            }
            Command::Show(view) => {
                settings.view = *view;
                format!("View: {}", view.name())
            }
            Command::ToggleSurfaces => {
                settings.view = if settings.view == View::Normals {
                    View::Render
                } else {
                    View::Normals
                };
                format!("View: {}", settings.view.name())
            }
            _ => return None,
        })
    }

    fn change_camera(&mut self, command: &Command) -> Option<String> {
        let (lens_step, focus_step) = match self.scene.dialect {
            Dialect::Course => COURSE_STEPS,
            Dialect::Plain => (STEPS.0 * self.scene_size(), STEPS.1 * self.scene_size()),
        };
        let camera = &mut self.camera;
        Some(match command {
            Command::WidenLens | Command::NarrowLens => {
                let sign = if *command == Command::WidenLens {
                    1.0
                } else {
                    -1.0
                };
                // Rounded, so that going back meets zero exactly.
                let steps = (camera.lens_radius / lens_step + sign).round().max(0.0);
                camera.lens_radius = steps * lens_step;
                format!("Lens radius: {:.4}", camera.lens_radius)
            }
            Command::FocusFarther | Command::FocusNearer => {
                let sign = if *command == Command::FocusFarther {
                    1.0
                } else {
                    -1.0
                };
                camera.focal_distance = (camera.focal_distance + sign * focus_step).max(focus_step);
                format!("Focal distance: {:.4}", camera.focal_distance)
            }
            Command::ResetCamera => {
                self.reset_camera();
                "Camera reset".to_owned()
            }
            Command::UndoCamera => {
                self.undo_camera();
                "Camera undone".to_owned()
            }
            Command::RedoCamera => {
                self.redo_camera();
                "Camera redone".to_owned()
            }
            _ => return None,
        })
    }
}
