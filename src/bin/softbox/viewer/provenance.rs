//! What tells how a picture came about: metadata of its files and the camera file.

use std::path::PathBuf;

use glam::{DMat3, DVec3};
use softbox::camera::Camera;
use softbox::io::camera_file::{CameraFile, write_camera_file};
use softbox::io::picture::{Metadata, append_extension, numbered_path};
use softbox::session::Snapshot;
use softbox::settings::{RenderSettings, StopRule};

use super::document::Document;
use super::snapshot_file::folder;
use crate::job::{CameraChoice, FieldOfView, Job};

/// The command line that renders the picture of `camera` and `settings` again without a window,
/// with as many `samples` per pixel where the settings set no end.
pub(super) fn command_line(
    document: &Document,
    camera: &Camera,
    mut settings: RenderSettings,
    samples: u32,
) -> String {
    let stop = &mut settings.stop;
    if *stop == StopRule::default() {
        stop.samples_per_pixel = Some(samples.max(1));
    }
    let (half_width, _) = camera.half_extent(settings.width, settings.height);
    let path = document.scene.path.clone();
    let environment = &document.scene.environment.map;
    let job = Job {
        // A built-in scene is opened by its name.
        scene: Some(path.unwrap_or_else(|| document.name().into())),
        environment: environment.as_ref().map(|map| map.path.clone()),
        outputs: vec![format!("{}.png", document.name()).into()],
        settings,
        camera: CameraChoice {
            eye: Some(camera.eye),
            target: Some(camera.target),
            up: (camera.up != DVec3::Y).then_some(camera.up),
            fov: Some(FieldOfView::X((2.0 * half_width.atan()).to_degrees())),
            lens_radius: (camera.lens_radius > 0.0).then_some(camera.lens_radius),
            focal_distance: (camera.lens_radius > 0.0).then_some(camera.focal_distance),
            ..CameraChoice::default()
        },
        display: document.display,
        ..Job::default()
    };
    crate::command_line::command_line(&job)
}

/// The words that go into the files of a picture.
pub(super) fn metadata(document: &Document, snapshot: &Snapshot) -> Metadata {
    let settings = snapshot.settings.clone();
    let command = command_line(document, &snapshot.camera, settings, snapshot.samples_max);
    let scene = (document.name(), document.scene.path.as_deref());
    crate::provenance::metadata(snapshot, &document.display, scene, &command)
}

/// Writes the camera beside the scene in the course's format and returns the file's path. Never
/// overwrites.
///
/// # Errors
/// One sentence, when the file cannot be written.
pub(super) fn write_camera(document: &Document) -> Result<PathBuf, String> {
    let folder = folder(document.scene.path.as_deref());
    let stem = format!("{}_cam_settings", document.name());
    let path = append_extension(&numbered_path(&folder, &stem, &["txt"]), "txt");
    let camera = camera_file(
        &document.camera,
        document.image_size(),
        document.scene_size(),
    );
    write_camera_file(&path, &camera).map_err(|error| error.to_string())?;
    Ok(path)
}

/// The camera as the course's program writes it for a window of `size` pixels.
fn camera_file(camera: &Camera, size: [u32; 2], scene_size: f64) -> CameraFile {
    let [width, height] = size.map(f64::from);
    let (half_width, half_height) = camera.half_extent(size[0], size[1]);
    let (right, up, back) = camera.basis();
    let offset = camera.eye - camera.target;
    let distance = offset.length();
    let unit: DVec3 = offset / distance;
    CameraFile {
        hfov: 2.0 * half_width.atan().to_degrees(),
        vfov: 2.0 * half_height.atan().to_degrees(),
        aspect: width / height,
        near: 0.001,
        far: 1000.0,
        position: camera.eye,
        target: camera.target,
        phi: unit.y.clamp(-1.0, 1.0).acos(),
        theta: unit.x.atan2(unit.z),
        distance,
        // The course lets its window move between these multiples of the diagonal.
        min_distance: 0.075 * scene_size,
        max_distance: 15.0 * scene_size,
        world_from_camera: DMat3::from_cols(right, up, back),
        width,
        height,
        screen_distance: 0.5 * height / half_height,
        focal_distance: camera.focal_distance,
        lens_radius: camera.lens_radius,
    }
}
