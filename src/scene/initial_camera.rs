use glam::DVec3;

use super::{Dialect, FieldOfView, FileCamera, Scene};
use crate::camera::{Camera, Framing};
use crate::settings::CameraRule;

/// Opening angles of the course when the file has no camera, degrees.
const COURSE_FOV: (f64, f64) = (50.0, 35.0);
/// The picture size for which the course sets up its camera.
const COURSE_SIZE: (f64, f64) = (800.0, 600.0);

/// The camera with which `scene` is first shown.
///
/// `crops` keeps the course's image plane distance, so that the size of the picture cuts out of
/// the 800×600 view; otherwise the horizontal angle of that view stays.
pub fn initial_camera(scene: &Scene, rule: CameraRule, crops: bool) -> Camera {
    let file_camera = scene.cameras.last();
    let rule = match (rule, file_camera, scene.dialect) {
        (CameraRule::Auto, _, Dialect::Course) => CameraRule::Course,
        (CameraRule::Auto | CameraRule::File, None, _) => CameraRule::Fit,
        (CameraRule::Auto, Some(_), Dialect::Plain) => CameraRule::File,
        (rule, _, _) => rule,
    };
    let (min, max) = scene
        .bounds()
        .unwrap_or((DVec3::splat(-1.0), DVec3::splat(1.0)));
    let center = min * 0.5 + max * 0.5;
    let diagonal = match (max - min).length() {
        d if d > 0.0 && d.is_finite() => d,
        _ => 1.0,
    };
    let mut camera = match (rule, file_camera) {
        (CameraRule::File, Some(file)) => as_it_stands(file, center),
        (CameraRule::Course, file) => course(file, center, diagonal, crops),
        _ => fitted(center, diagonal),
    };
    if rule != CameraRule::Course {
        camera.focal_distance = (camera.eye - camera.target).length();
    }
    camera
}

fn fitted(center: DVec3, diagonal: f64) -> Camera {
    let half_angle = 20_f64.to_radians();
    let distance = 0.5 * diagonal / half_angle.sin();
    Camera {
        eye: center + DVec3::new(0.45, 0.3, 1.0).normalize() * distance,
        target: center,
        framing: Framing::Horizontal(2.0 * half_angle),
        ..Camera::default()
    }
}

fn as_it_stands(file: &FileCamera, center: DVec3) -> Camera {
    let m = file.world_from_camera;
    let eye = m.transform_point3(DVec3::ZERO);
    let forward = m
        .transform_vector3(DVec3::NEG_Z)
        .try_normalize()
        .unwrap_or(DVec3::NEG_Z);
    // The pivot: as far along the view as the middle of the scene lies.
    let distance = (center - eye).dot(forward);
    let distance = if distance > 1e-6 {
        distance
    } else {
        (center - eye).length().max(1.0)
    };
    let up = m
        .transform_vector3(DVec3::Y)
        .try_normalize()
        .unwrap_or(DVec3::Y);
    Camera {
        eye,
        target: eye + forward * distance,
        up,
        framing: Framing::Horizontal(horizontal_angle(&file.fov)),
        ..Camera::default()
    }
}

fn horizontal_angle(fov: &FieldOfView) -> f64 {
    let aspect = fov.aspect.unwrap_or(COURSE_SIZE.0 / COURSE_SIZE.1);
    match (fov.x, fov.y) {
        (Some(x), _) => x,
        (None, Some(y)) => 2.0 * ((y * 0.5).tan() * aspect).atan(),
        (None, None) => COURSE_FOV.0.to_radians(),
    }
}

/// The course's rule: only the direction of the file's camera counts.
fn course(file: Option<&FileCamera>, center: DVec3, diagonal: f64, crops: bool) -> Camera {
    let direction = file
        .map(|file| file.world_from_camera.transform_point3(DVec3::NEG_Z))
        .and_then(DVec3::try_normalize)
        .unwrap_or(DVec3::Z);
    let (x, y) = match file.map(|file| file.fov) {
        Some(fov) => course_angles(&fov),
        None => (COURSE_FOV.0.to_radians(), COURSE_FOV.1.to_radians()),
    };
    // The angle on the axis that is too narrow for 4:3 is widened.
    let half_height = (y * 0.5)
        .tan()
        .max((x * 0.5).tan() * COURSE_SIZE.1 / COURSE_SIZE.0);
    let framing = if crops {
        Framing::ScreenDistance(COURSE_SIZE.1 * 0.5 / half_height)
    } else {
        Framing::Horizontal(2.0 * (half_height * COURSE_SIZE.0 / COURSE_SIZE.1).atan())
    };
    Camera {
        eye: center + direction * 1.5 * diagonal,
        target: center,
        framing,
        ..Camera::default()
    }
}

fn course_angles(fov: &FieldOfView) -> (f64, f64) {
    let x = fov.x.unwrap_or(COURSE_FOV.0.to_radians());
    let y = match (fov.y, fov.aspect) {
        (Some(y), _) => y,
        (None, Some(aspect)) if aspect > 0.0 => 2.0 * ((x * 0.5).tan() / aspect).atan(),
        _ => COURSE_FOV.1.to_radians(),
    };
    (x, y)
}
