//! The picture on the screen: textures, letterbox, dimming outside of the region, and what the
//! hand does over it.

use eframe::egui::{
    self, Color32, CornerRadius, CursorIcon, Pos2, Rect, Response, Sense, Stroke, StrokeKind,
    TextureFilter, TextureHandle, TextureOptions, Ui,
};
use softbox::image::Region;

use super::letterbox::{Letterbox, surrounding};
use super::presenter::Frame;

const BACKDROP: Color32 = Color32::from_gray(24);
const FULL: TextureOptions = TextureOptions {
    magnification: TextureFilter::Nearest,
    ..TextureOptions::LINEAR
};

/// The render region being made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum RegionTool {
    /// Dragging moves the camera.
    #[default]
    Off,
    /// The next drag makes a region.
    Armed,
    /// A drag began here.
    Dragging(Pos2),
}

/// The picture's textures and the state of the tools over it.
#[derive(Default)]
pub(super) struct Viewport {
    full: Option<TextureHandle>,
    preview: Option<TextureHandle>,
    frame: Option<Frame>,
    /// The region tool.
    pub(super) region_tool: RegionTool,
}

impl std::fmt::Debug for Viewport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Viewport")
            .field("region_tool", &self.region_tool)
            .finish_non_exhaustive()
    }
}

/// What was drawn and where, for tools and overlays.
#[derive(Debug)]
pub(super) struct Shown {
    /// The picture's place.
    pub(super) letterbox: Letterbox,
    /// The whole view's response to the pointer.
    pub(super) response: Response,
    /// A region that was just finished.
    pub(super) region: Option<Region>,
}

impl Viewport {
    /// Takes a new frame and uploads it.
    pub(super) fn upload(&mut self, ctx: &egui::Context, frame: Frame) {
        let (slot, name, options) = if frame.snapshot.is_preview {
            (&mut self.preview, "preview", TextureOptions::LINEAR)
        } else {
            (&mut self.full, "picture", FULL)
        };
        let image = std::sync::Arc::clone(&frame.image);
        match slot {
            Some(texture) if texture.size() == image.size => {
                texture.set_partial([0, 0], image, options);
            }
            Some(texture) => texture.set(image, options),
            None => *slot = Some(ctx.load_texture(name, image, options)),
        }
        self.frame = Some(frame);
    }

    /// False while dragging belongs to the region tool.
    pub(super) fn allows_navigation(&self) -> bool {
        self.region_tool == RegionTool::Off
    }

    /// The frame on the screen.
    pub(super) fn frame(&self) -> Option<&Frame> {
        self.frame.as_ref()
    }

    /// Draws the picture into the rest of `ui` for an image of `size` pixels.
    pub(super) fn show(&mut self, ui: &mut Ui, size: [u32; 2], region: Option<Region>) -> Shown {
        let (view, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| {
            egui::WidgetInfo::labeled(egui::accesskit::Role::Image, true, "Render view")
        });
        let letterbox = Letterbox::fit(view, size, ui.ctx().pixels_per_point());
        let painter = ui.painter_at(view);
        painter.rect_filled(view, CornerRadius::ZERO, BACKDROP);
        self.paint_picture(&painter, view, ui.ctx().pixels_per_point());
        let finished = self.use_region_tool(ui, &response, &letterbox);
        if let Some(region) = region {
            paint_region(&painter, letterbox.rect, letterbox.region_rect(region));
        }
        if let (RegionTool::Dragging(from), Some(to)) =
            (self.region_tool, response.interact_pointer_pos())
        {
            let dragged = Rect::from_two_pos(from, to);
            paint_region(&painter, letterbox.rect, dragged.intersect(letterbox.rect));
        }
        Shown {
            letterbox,
            response,
            region: finished,
        }
    }

    fn paint_picture(&self, painter: &egui::Painter, view: Rect, pixels_per_point: f32) {
        let Some(frame) = &self.frame else { return };
        let texture = if frame.snapshot.is_preview {
            &self.preview
        } else {
            &self.full
        };
        let Some(texture) = texture else { return };
        // The shape of the shown picture, not of the wanted one: while the window is resized the
        // last picture keeps its own shape.
        let place = Letterbox::fit(view, frame.snapshot.image_size, pixels_per_point).rect;
        let uv = Rect::from_min_max(Pos2::ZERO, egui::pos2(1.0, 1.0));
        painter.image(texture.id(), place, uv, Color32::WHITE);
    }

    fn use_region_tool(
        &mut self,
        ui: &Ui,
        response: &Response,
        letterbox: &Letterbox,
    ) -> Option<Region> {
        if self.region_tool == RegionTool::Off {
            return None;
        }
        if response.hovered() {
            ui.set_cursor_icon(CursorIcon::Crosshair);
        }
        if response.drag_started_by(egui::PointerButton::Primary) {
            let origin = ui.input(|i| i.pointer.press_origin());
            self.region_tool = origin.map_or(self.region_tool, RegionTool::Dragging);
        }
        let RegionTool::Dragging(from) = self.region_tool else {
            return None;
        };
        if !response.drag_stopped_by(egui::PointerButton::Primary) {
            return None;
        }
        self.region_tool = RegionTool::Off;
        let to = response.interact_pointer_pos()?;
        letterbox.region_between(from, to)
    }
}

fn paint_region(painter: &egui::Painter, picture: Rect, region: Rect) {
    for part in surrounding(picture, region) {
        painter.rect_filled(part, CornerRadius::ZERO, Color32::from_black_alpha(120));
    }
    let red = Stroke::new(1.0, Color32::from_rgb(230, 60, 50));
    painter.rect_stroke(region, CornerRadius::ZERO, red, StrokeKind::Outside);
}
