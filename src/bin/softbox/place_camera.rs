//! From what was said about the camera to the camera.

use softbox::camera::{Camera, Framing};
use softbox::io::camera_file::{CameraFile, CameraFileError, read_camera_file};
use softbox::scene::{Scene, initial_camera};

use crate::job::{CameraChoice, FieldOfView};

/// The camera of `choice` in `scene` for a picture of `size` pixels. What nothing is said about
/// comes from the camera file, else from the scene by the camera rule.
///
/// # Errors
/// When the camera file cannot be read.
pub(crate) fn place_camera(
    choice: &CameraChoice,
    scene: &Scene,
    size: [u32; 2],
) -> Result<Camera, CameraFileError> {
    let mut camera = initial_camera(scene, choice.rule, choice.crops);
    if let Some(path) = &choice.file {
        let file = read_camera_file(path)?;
        camera = from_file(&file, choice.crops);
    }
    camera.eye = choice.eye.unwrap_or(camera.eye);
    camera.target = choice.target.unwrap_or(camera.target);
    camera.up = choice.up.unwrap_or(camera.up);
    camera.lens_radius = choice.lens_radius.unwrap_or(camera.lens_radius);
    camera.focal_distance = choice.focal_distance.unwrap_or(camera.focal_distance);
    if let Some(fov) = choice.fov {
        camera.framing = Framing::Horizontal(horizontal(fov, size));
    }
    Ok(camera)
}

fn from_file(file: &CameraFile, crops: bool) -> Camera {
    Camera {
        eye: file.position,
        target: file.target,
        framing: if crops {
            Framing::ScreenDistance(file.screen_distance)
        } else {
            Framing::Horizontal(file.hfov.to_radians())
        },
        lens_radius: file.lens_radius,
        focal_distance: file.focal_distance,
        ..Camera::default()
    }
}

fn horizontal(fov: FieldOfView, [width, height]: [u32; 2]) -> f64 {
    match fov {
        FieldOfView::X(degrees) => degrees.to_radians(),
        FieldOfView::Y(degrees) => {
            let aspect = f64::from(width.max(1)) / f64::from(height.max(1));
            2.0 * ((degrees.to_radians() * 0.5).tan() * aspect).atan()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn what_is_said_wins_over_the_scene() {
        let scene = Scene::default();
        let plain = place_camera(&CameraChoice::default(), &scene, [800, 600]).unwrap();
        assert_eq!(plain, initial_camera(&scene, <_>::default(), false));
        let choice = CameraChoice {
            eye: Some(DVec3::new(1.0, 2.0, 3.0)),
            fov: Some(FieldOfView::Y(60.0)),
            focal_distance: Some(0.7),
            ..CameraChoice::default()
        };
        let camera = place_camera(&choice, &scene, [200, 100]).unwrap();
        assert_eq!(camera.eye, DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(camera.target, plain.target);
        assert_eq!(camera.focal_distance, 0.7);
        let (_, half_height) = camera.half_extent(200, 100);
        assert!((half_height - 30_f64.to_radians().tan()).abs() < 1e-12);
    }
}
