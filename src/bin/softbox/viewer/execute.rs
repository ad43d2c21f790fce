//! The one place where commands are carried out.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::{Context, ViewportCommand};
use softbox::color::Rgb;
use softbox::io::picture::PictureFormat;
use softbox::scene::Scene;
use softbox::session::SessionState;
use softbox::settings::View;

use super::app::App;
use super::command::Command;
use super::files::FileEvent;
use super::loader::{LoadEvent, file_name};
use super::orbit;
use super::provenance;
use super::snapshot_file::SnapshotRequest;
use super::viewport::RegionTool;

/// Half a stop for each press.
const EXPOSURE_STEP: f32 = 0.5;

/// True for files that can be a reference, by their name.
fn is_linear_picture(path: &Path) -> bool {
    PictureFormat::from_path(path).is_some_and(PictureFormat::is_linear)
}

impl App {
    /// Carries out one command.
    pub(super) fn execute(&mut self, ctx: &Context, command: Command) {
        if let Some(news) = self.document.change(&command) {
            self.windows.messages.tell(news, ctx.time());
            return;
        }
        match command {
            Command::Open => {
                let folder = self.document.scene.path.as_deref().and_then(Path::parent);
                self.files.ask_for_file(folder);
            }
            Command::OpenPath(path) => self.open(&path, false),
            Command::ChooseReference => self.files.ask_for_reference(),
            Command::ReadReference(path) => self.read_reference(ctx, path),
            Command::ForgetReference => self.view.error.forget_reference(),
            Command::AskPath => self.windows.ask_path(),
            Command::Reload => self.reload(),
            Command::CancelLoading => {
                if !self.files.cancel_loading() {
                    self.cancel_build();
                }
            }
            Command::SaveSnapshot => self.save_snapshot(),
            Command::CopyImage => self.copy_image(ctx),
            Command::CopyCommandLine => self.copy_command_line(ctx),
            Command::DumpCamera => self.dump_camera(ctx),
            Command::Quit => ctx.send_viewport_cmd(ViewportCommand::Close),
            Command::Restart => {
                self.document.settings.view = View::Render;
                self.engine.restart();
            }
            Command::TogglePause => {
                self.engine.toggle_pause();
            }
            _ => self.change_view(ctx, &command),
        }
    }

    fn change_view(&mut self, ctx: &Context, command: &Command) {
        match command {
            Command::FrameScene => {
                if let Some(bounds) = self.document.scene.bounds() {
                    let size = self.document.image_size();
                    self.document.camera = orbit::frame(&self.document.camera, bounds, size);
                }
            }
            Command::Brighter => self.document.display.exposure += EXPOSURE_STEP,
            Command::Darker => self.document.display.exposure -= EXPOSURE_STEP,
            Command::ToggleRegion => self.toggle_region(ctx),
            Command::Cancel => self.cancel(ctx),
            Command::ToggleBvh => self.view.bvh.is_on = !self.view.bvh.is_on,
            Command::ToggleRayLog => self.toggle_ray_log(ctx),
            Command::BvhParent => self.view.bvh.select_parent(),
            Command::BvhLeft => self.view.bvh.select_child(0),
            Command::BvhRight => self.view.bvh.select_child(1),
            Command::RemoveAddedLight => self.remove_added_light(),
            Command::ToggleKeys => self.windows.shows_keys ^= true,
            Command::ToggleReport => self.windows.shows_report ^= true,
            Command::TogglePanels => self.preferences.shows_panels ^= true,
            Command::ToggleFullScreen => {
                let is_full = ctx.input(|i| i.viewport().fullscreen.unwrap_or(false));
                ctx.send_viewport_cmd(ViewportCommand::Fullscreen(!is_full));
            }
            _ => {}
        }
    }

    fn toggle_ray_log(&mut self, ctx: &Context) {
        if self.view.rays.is_on() {
            self.view.rays.clear();
        } else if let Some(scene) = self.engine.prepared() {
            let size = self.document.image_size();
            self.view.rays.log(&scene, &self.document.camera, size);
            let news = "Camera rays logged; move the camera to see them";
            self.windows.messages.tell(news, ctx.time());
        }
    }

    fn toggle_region(&mut self, ctx: &Context) {
        let tool = &mut self.view.viewport.region_tool;
        if *tool != RegionTool::Off {
            *tool = RegionTool::Off;
        } else if self.document.settings.region.take().is_none() {
            *tool = RegionTool::Armed;
            let news = "Drag over the picture to render only that region";
            self.windows.messages.tell(news, ctx.time());
        }
    }

    /// Ends the innermost thing that is going on, never the program.
    fn cancel(&mut self, ctx: &Context) {
        let tool = &mut self.view.viewport.region_tool;
        if *tool != RegionTool::Off {
            *tool = RegionTool::Off;
            return;
        }
        if self.windows.close_one()
            || self.files.cancel_loading()
            || self.cancel_build()
            || self.document.settings.region.take().is_some()
            || std::mem::take(&mut self.view.bvh.is_on)
        {
            return;
        }
        self.preferences.shows_panels = true;
        if ctx.input(|i| i.viewport().fullscreen.unwrap_or(false)) {
            ctx.send_viewport_cmd(ViewportCommand::Fullscreen(false));
        }
    }

    /// Begins to read `path`.
    pub(super) fn open(&mut self, path: &Path, is_reload: bool) {
        if let Err(sentence) = self.files.open(path, is_reload) {
            self.windows.messages.fail(sentence);
        }
    }

    /// Begins to read a picture that the running one is held against.
    fn read_reference(&mut self, ctx: &Context, path: PathBuf) {
        self.view.error.path = path.display().to_string();
        if let Err(sentence) = self.view.error.read(ctx, path) {
            self.windows.messages.fail(sentence);
        }
    }

    fn reload(&mut self) {
        if let Some(path) = self.document.scene.path.clone() {
            self.open(&path, true);
        } else {
            self.engine.restart();
        }
    }

    /// Takes note of what the threads that work with files have done.
    pub(super) fn take_file_events(&mut self, ctx: &Context) {
        let dropped = ctx.input(|i| i.raw.dropped_files.first().map(|f| f.path().to_owned()));
        match dropped {
            Some(path) if is_linear_picture(&path) => self.read_reference(ctx, path),
            Some(path) => self.open(&path, false),
            None => {}
        }
        let path = self.document.scene.path.clone();
        if self.preferences.watches_files != self.files.is_watching() {
            let watched = path.as_deref().filter(|_| self.preferences.watches_files);
            if watched.is_some() || self.files.is_watching() {
                self.files.watch(watched);
            }
        }
        for event in self.files.poll() {
            match event {
                FileEvent::Load(LoadEvent::Loaded { loaded, is_reload }) => {
                    self.files.report = Some(loaded.report);
                    self.show_scene(loaded.scene, is_reload);
                }
                FileEvent::Load(LoadEvent::Failed(sentence)) => {
                    self.windows.messages.fail(sentence);
                }
                FileEvent::Chosen(path) if path.as_os_str().is_empty() => {
                    self.windows.ask_path();
                }
                FileEvent::Chosen(path) => self.open(&path, false),
                FileEvent::ReferenceChosen(path) => {
                    if !path.as_os_str().is_empty() {
                        self.read_reference(ctx, path);
                    }
                }
                FileEvent::Changed => self.reload(),
                FileEvent::Written(Ok(path)) => {
                    self.log.say(&format!("written {}", path.display()));
                    let news = format!("Saved {}.png and .exr", file_name(&path));
                    self.windows.messages.tell(news, ctx.time());
                }
                FileEvent::Written(Err(sentence)) => self.windows.messages.fail(sentence),
            }
        }
    }

    fn show_scene(&mut self, scene: Scene, is_reload: bool) {
        let path: Option<PathBuf> = scene.path.clone();
        let is_first = std::mem::take(&mut self.is_first_scene);
        if !is_reload && !is_first {
            self.document.forget_camera_choice();
        }
        self.document.replace_scene(Arc::new(scene), is_reload);
        self.view.viewport.region_tool = RegionTool::Off;
        self.windows.messages.close();
        if let Some(path) = &path {
            self.preferences.note_file(path);
        }
        let watched = path.as_deref().filter(|_| self.preferences.watches_files);
        self.files.watch(watched);
    }

    /// Goes back to the scene before while the new one is being made ready; false when nothing is.
    fn cancel_build(&mut self) -> bool {
        let is_building = matches!(self.engine.status().state, SessionState::Preparing { .. });
        if !is_building || !self.document.return_to_scene_before() {
            return false;
        }
        let path = self.document.scene.path.clone();
        let watched = path.as_deref().filter(|_| self.preferences.watches_files);
        self.files.watch(watched);
        true
    }

    fn remove_added_light(&mut self) {
        let scene = Arc::make_mut(&mut self.document.scene);
        scene.environment.sky = Rgb::ZERO;
        scene.environment.is_added = false;
    }

    fn save_snapshot(&mut self) {
        let Some(frame) = self.view.viewport.frame() else {
            return;
        };
        if frame.snapshot.is_preview {
            let sentence = "The picture is only a first look yet; save again in a moment.";
            self.windows.messages.fail(sentence);
            return;
        }
        let request = SnapshotRequest {
            snapshot: Arc::clone(&frame.snapshot),
            display: self.document.display,
            scene_name: self.document.name().to_owned(),
            scene_path: self.document.scene.path.clone(),
            metadata: provenance::metadata(&self.document, &frame.snapshot),
        };
        self.files.write(request);
    }

    fn copy_image(&mut self, ctx: &Context) {
        if let Some(frame) = self.view.viewport.frame() {
            ctx.copy_image((*frame.image).clone());
            self.windows.messages.tell("Picture copied", ctx.time());
        }
    }

    fn copy_command_line(&mut self, ctx: &Context) {
        let document = &self.document;
        let samples = self.engine.status().samples_mean.ceil() as u32;
        let settings = document.settings.clone();
        ctx.copy_text(provenance::command_line(
            document,
            &document.camera,
            settings,
            samples,
        ));
        self.windows
            .messages
            .tell("Command line copied", ctx.time());
    }

    fn dump_camera(&mut self, ctx: &Context) {
        match provenance::write_camera(&self.document) {
            Ok(path) => {
                let news = format!("Camera written to {}", file_name(&path));
                self.windows.messages.tell(news, ctx.time());
            }
            Err(sentence) => self.windows.messages.fail(sentence),
        }
    }
}
