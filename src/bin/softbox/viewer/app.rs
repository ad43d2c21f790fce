//! The application: composes the parts and runs one frame.

use std::sync::Arc;
use std::time::Instant;

use eframe::egui::style::ScrollStyle;
use eframe::egui::{
    CentralPanel, Context, Frame as UiFrame, Panel, ScrollArea, Ui, ViewportCommand,
};
use softbox::scene::Scene;

use super::bvh_view::BvhView;
use super::command::{Binding, Command};
use super::document::{Document, Resolution};
use super::engine::Engine;
use super::error_curve::ErrorCurve;
use super::event_log::EventLog;
use super::files::Files;
use super::inspector::{PickInfo, Picker, PixelValues, pixel_values};
use super::keys;
use super::latency::Latency;
use super::navigation::Navigation;
use super::options::ViewerOptions;
use super::panels::{self, menu::Menu, status_bar::StatusBar};
use super::preferences::Preferences;
use super::probe::Probe;
use super::ray_log::RayLog;
use super::viewport::Viewport;
use super::windows::Windows;

/// The viewer.
#[derive(Debug)]
pub(super) struct App {
    pub(super) document: Document,
    pub(super) engine: Engine,
    pub(super) view: ViewState,
    pub(super) files: Files,
    pub(super) windows: Windows,
    pub(super) preferences: Preferences,
    pub(super) log: EventLog,
    probe: Option<Probe>,
    /// True until the file of the command line is open: its camera belongs to that file.
    pub(super) is_first_scene: bool,
}

/// The picture and what happens over it.
#[derive(Debug, Default)]
pub(super) struct ViewState {
    pub(super) viewport: Viewport,
    pub(super) navigation: Navigation,
    pub(super) bvh: BvhView,
    pub(super) rays: RayLog,
    pub(super) error: ErrorCurve,
    pixel: Option<PixelValues>,
    surface: Option<PickInfo>,
    title: String,
    latency: Latency,
}

impl ViewState {
    /// Names the scene in the window's title.
    fn follow_title(&mut self, ctx: &Context, name: &str) {
        if self.title != name {
            name.clone_into(&mut self.title);
            let title = format!("{name} - softbox");
            ctx.send_viewport_cmd(ViewportCommand::Title(title));
        }
    }
}

impl App {
    /// The viewer of `scene` with the stored preferences and the command line's `options`; begins
    /// to read the options' file.
    ///
    /// # Errors
    /// When the system cannot start a thread.
    pub(super) fn new(
        cc: &eframe::CreationContext<'_>,
        scene: Arc<Scene>,
        options: ViewerOptions,
    ) -> std::io::Result<Self> {
        let ctx = &cc.egui_ctx;
        // Ctrl and wheel, plus and minus belong to the picture.
        ctx.options_mut(|o| o.zoom_with_keyboard = false);
        // The scroll bar has its own place beside the widgets.
        ctx.all_styles_mut(|style| style.spacing.scroll = ScrollStyle::solid());
        let mut preferences = Preferences::load(cc.storage);
        preferences.keys = options.keys.unwrap_or(preferences.keys);
        let mut settings = options
            .settings
            .unwrap_or_else(|| preferences.settings.clone());
        settings.isa = options.isa;
        let display = options.display.unwrap_or(preferences.display);
        let mut document = Document::new(scene, settings, display, options.camera);
        document.resolution = if options.has_fixed_size {
            Resolution::Fixed
        } else {
            preferences.resolution
        };
        let wake = ctx.clone();
        let mut app = Self {
            document,
            engine: Engine::start(move || wake.request_repaint())?,
            view: ViewState::default(),
            files: Files::new(ctx, options.environment),
            windows: Windows::default(),
            preferences,
            log: EventLog::new(options.logs_events, options.exit_after),
            probe: options.measures_fluency.then(Probe::new),
            is_first_scene: options.scene.is_some(),
        };
        if let Some(path) = options.scene {
            app.open(&path, false);
        }
        Ok(app)
    }

    fn menu_bar(&mut self, ui: &mut Ui, bindings: &[Binding], commands: &mut Vec<Command>) {
        let mut menu = Menu {
            bindings,
            recent: &self.preferences.recent,
            keys: &mut self.preferences.keys,
            watches_files: &mut self.preferences.watches_files,
            is_paused: self.engine.is_paused(),
        };
        menu.show(ui, commands);
    }

    fn side_panel(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        let document = &mut self.document;
        let legend = self.view.viewport.frame().and_then(|frame| frame.legend);
        let view = &mut document.settings.view;
        panels::display::show(ui, view, &mut document.display, legend.as_ref());
        panels::render::show(ui, &mut document.settings);
        panels::stop::show(ui, &mut document.settings.stop);
        panels::camera::show(ui, document, commands);
        let size = (&mut document.settings, &mut document.resolution);
        panels::render::size(ui, size.0, size.1);
        panels::render::machine(ui, &mut document.settings);
        panels::pixel::show(ui, self.view.pixel.as_ref(), self.view.surface.as_ref());
        let facts = self.view.bvh.facts();
        panels::bvh::show(ui, &mut self.view.bvh, facts.as_ref());
        panels::error::show(ui, &mut self.view.error, commands);
        let latency = self.view.latency.summary();
        panels::statistics::show(
            ui,
            &self.engine.status(),
            self.document.settings.instruction_set(),
            latency.as_ref(),
            self.view.bvh.stats(),
        );
    }

    fn status_bar(&self, ui: &mut Ui, commands: &mut Vec<Command>) {
        let settings = &self.document.settings;
        let loading = self.files.loading();
        StatusBar {
            status: &self.engine.status(),
            loading: loading.as_ref(),
            size: self.document.image_size(),
            has_added_light: self.document.scene.environment.is_added,
            badge: settings.course_compatible.then_some("course-compatible"),
            report: self.files.report.as_ref(),
        }
        .show(ui, commands);
    }

    fn picture(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        let document = &mut self.document;
        if document.resolution == Resolution::FollowWindow {
            let pixels = ui.available_size() * ui.ctx().pixels_per_point();
            document.follow(pixels, ui.input(|i| i.max_texture_side));
        }
        let prepared = self.engine.prepared();
        self.view.bvh.set_scene(prepared.as_ref());
        let picker = Picker::new(prepared);
        let view = &mut self.view;
        let region = document.settings.region;
        let shown = view.viewport.show(ui, document.image_size(), region);
        if let Some(region) = shown.region {
            document.settings.region = Some(region);
        }
        if view.viewport.allows_navigation() {
            let click = view.navigation.update(ui, &shown, document, &picker);
            let click = click.or_else(|| view.navigation.menu(&shown, commands));
            let news = click.and_then(|c| Navigation::carry_out(c, &shown, document, &picker));
            if let Some(news) = news {
                self.windows.messages.tell(news, ui.ctx().time());
            }
        }
        let painter = ui.painter_at(shown.response.rect);
        view.bvh.paint(&painter, &document.camera, shown.letterbox);
        if let Some(scene) = picker.scene() {
            view.rays
                .paint(&painter, scene, &document.camera, shown.letterbox);
        }
        let pointer = shown.response.hover_pos();
        view.surface = pointer.and_then(|p| picker.pick(&document.camera, &shown.letterbox, p));
        view.pixel = pointer.and_then(|p| {
            let pixel = shown.letterbox.pixel(p)?;
            let snapshot = &view.viewport.frame()?.snapshot;
            pixel_values(snapshot, &document.display, pixel)
        });
        let is_moving = ui.input(|i| i.pointer.any_down()) || view.navigation.is_flying();
        document.settle_camera(ui.ctx().time(), is_moving);
    }

    fn small_windows(&mut self, ctx: &Context, bindings: &[Binding], commands: &mut Vec<Command>) {
        panels::key_sheet::show(ctx, bindings, &mut self.windows.shows_keys);
        let prepared = self.engine.prepared();
        let notes = prepared.as_ref().map_or(&[][..], |scene| scene.notes());
        let report = self.files.report.as_ref();
        panels::report::show(ctx, report, notes, &mut self.windows.shows_report);
        self.windows.show_path(ctx, commands);
        self.windows.messages.show(ctx);
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        let ctx = ui.ctx().clone();
        self.take_file_events(&ctx);
        self.view.follow_title(&ctx, self.document.name());
        if let Some(frame) = self.engine.take_frame() {
            self.view
                .latency
                .arrive(&frame.snapshot.camera, Instant::now());
            self.view.viewport.upload(&ctx, frame);
        }
        if let Some(probe) = &mut self.probe {
            let shown = self
                .view
                .viewport
                .frame()
                .map(|frame| frame.snapshot.camera);
            probe.frame(&ctx, &mut self.document, &self.engine, shown);
        }
        let bindings = keys::bindings(self.preferences.keys);
        let is_flying = self.view.navigation.is_flying();
        let mut commands = keys::pressed(&ctx, &bindings, is_flying);
        if self.preferences.shows_panels {
            Panel::top("menu").show(ui, |ui| self.menu_bar(ui, &bindings, &mut commands));
            Panel::bottom("status").show(ui, |ui| self.status_bar(ui, &mut commands));
            Panel::right("settings")
                .default_size(380.0)
                .size_range(300.0..=560.0)
                .show(ui, |ui| {
                    ScrollArea::vertical()
                        .auto_shrink(false)
                        .show(ui, |ui| self.side_panel(ui, &mut commands));
                });
        }
        CentralPanel::default()
            .frame(UiFrame::NONE)
            .show(ui, |ui| self.picture(ui, &mut commands));
        self.small_windows(&ctx, &bindings, &mut commands);
        let shown = self.view.viewport.frame().map(|frame| &frame.snapshot);
        let is_held = self.engine.status().is_held();
        if let Err(sentence) = self.view.error.follow(&ctx, shown, is_held) {
            self.windows.messages.fail(sentence);
        }
        for command in commands {
            self.execute(&ctx, command);
        }
        self.view.latency.ask(&self.document.camera, Instant::now());
        self.engine
            .request(self.document.render_job(), self.document.display);
        let status = self.engine.status();
        self.windows.messages.relay(status.message.as_deref());
        self.log
            .note(&self.document, &status, self.view.latency.summary());
        self.log.exit_when_due(&ctx);
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        self.preferences.resolution = self.document.resolution;
        self.preferences
            .remember(&self.document.settings, self.document.display);
        self.preferences.save(storage);
    }
}
