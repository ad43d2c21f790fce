//! What lies under the pointer: the surface in the scene and the numbers of the pixel.

use std::sync::Arc;

use eframe::egui::Pos2;
use glam::{DVec3, Vec2, Vec3};
use softbox::camera::{Camera, RayCamera};
use softbox::color::{Rgb, luminance};
use softbox::display::{DisplaySettings, tone_map_pixel};
use softbox::scene::PreparedScene;
use softbox::session::Snapshot;

use super::letterbox::Letterbox;
use crate::shown::display_of;

/// A surface under a point of the screen.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PickInfo {
    /// Where, in file coordinates.
    pub(super) point: DVec3,
    /// File units from the eye.
    pub(super) distance: f64,
    /// File units from the eye along the view direction.
    pub(super) depth: f64,
    /// Unit shading normal.
    pub(super) normal: Vec3,
    /// Name of the object.
    pub(super) object: String,
    /// Name of the material.
    pub(super) material: String,
    /// Index of the primitive.
    pub(super) primitive: u32,
}

/// Finds surfaces in the scene that is shown.
#[derive(Debug, Default)]
pub(super) struct Picker {
    prepared: Option<Arc<PreparedScene>>,
}

impl Picker {
    /// A picker for the prepared scene of the shown job; finds nothing without one.
    pub(super) fn new(prepared: Option<Arc<PreparedScene>>) -> Self {
        Self { prepared }
    }

    /// The scene that is searched.
    pub(super) fn scene(&self) -> Option<&PreparedScene> {
        self.prepared.as_deref()
    }

    /// The first surface under a point of the screen, seen through the middle of the lens.
    pub(super) fn pick(
        &self,
        camera: &Camera,
        letterbox: &Letterbox,
        point: Pos2,
    ) -> Option<PickInfo> {
        let prepared = self.prepared.as_ref()?;
        letterbox.pixel(point)?;
        let position = letterbox.pixel_position(point);
        let [width, height] = letterbox.image;
        let normalization = prepared.normalization();
        let ray = RayCamera::new(camera, width, height, normalization)
            .generate_ray(Vec2::new(position.x, position.y), || Vec2::ZERO);
        let hit = prepared.aggregate().closest(&ray);
        if hit.is_miss() {
            return None;
        }
        let surface = prepared.interaction(&ray, &hit);
        let point = normalization.point_to_file(surface.point);
        let (.., back) = camera.basis();
        Some(PickInfo {
            point,
            distance: point.distance(camera.eye),
            depth: (camera.eye - point).dot(back),
            normal: surface.shading_normal,
            object: prepared.object_name(hit.primitive).to_owned(),
            material: prepared.material_name(hit.primitive).to_owned(),
            primitive: hit.primitive,
        })
    }
}

/// The numbers of one pixel of the shown picture.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PixelValues {
    /// Column and row from the top left of the full picture.
    pub(super) pixel: [u32; 2],
    /// Linear value.
    pub(super) linear: Rgb,
    /// Relative luminance of it.
    pub(super) luminance: f32,
    /// As displayed.
    pub(super) displayed: [u8; 3],
    /// Samples taken in it.
    pub(super) samples: u32,
    /// Estimated relative error, where it is known.
    pub(super) relative_error: Option<f32>,
}

/// The values at a pixel of the full picture; `None` outside of the snapshot.
pub(super) fn pixel_values(
    snapshot: &Snapshot,
    display: &DisplaySettings,
    pixel: [u32; 2],
) -> Option<PixelValues> {
    let scaled = |at: u32, full: u32, stored: usize| {
        (u64::from(at) * stored as u64 / u64::from(full.max(1))) as usize
    };
    let x = scaled(pixel[0], snapshot.image_size[0], snapshot.width);
    let y = scaled(pixel[1], snapshot.image_size[1], snapshot.height);
    if x >= snapshot.width || y >= snapshot.height {
        return None;
    }
    let index = y * snapshot.width + x;
    let linear = *snapshot.pixels.get(index)?;
    Some(PixelValues {
        pixel,
        linear,
        luminance: luminance(linear),
        displayed: tone_map_pixel(linear, &display_of(snapshot.view, display)),
        samples: snapshot.samples.get(index),
        relative_error: snapshot
            .noise
            .as_ref()
            .and_then(|noise| noise.get(index).copied()),
    })
}
